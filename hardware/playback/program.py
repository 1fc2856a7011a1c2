"""The program of a run: from the park pose to the drawing, the drawing or the rest of it, and back."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from hardware.motion.slow_transfer import slow_transfer
from hardware.motion.stopping import interpolate, lift, lower, set_off
from hardware.motion.tip import link_nodes_mm
from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.errors import UsageError
from planner.trajectory import TRAVELLING

_LEAST_RATE_HZ = 50.0
"""Played slowly, samples are interpolated: hobby servos look for a new pulse 50 times a second."""


@dataclass(frozen=True, eq=False, slots=True)
class Program:
    """Set points at a fixed rate, the arm at rest at the first and at the last, which are both the park pose.

    positions: (n, n_joints) rad or mm. stroke: (n,) index of the stroke being drawn, or TRAVELLING. sample: (n,) where
    in the trajectory that is, a fractional index; on the way to the drawing where it begins, on the way back its end.
    approach, retreat: how many set points come before and after those of the drawing. uncompensated: (n, n_joints)
    where the joints are meant to be, if servos are sent elsewhere for that.
    """

    positions: FloatArray
    stroke: IntArray
    sample: FloatArray
    rate_hz: float
    approach: int
    retreat: int
    uncompensated: FloatArray | None = None

    @property
    def meant(self) -> FloatArray:
        """(n, n_joints) where the joints are meant to be."""
        return self.positions if self.uncompensated is None else self.uncompensated

    @property
    def duration_s(self) -> float:
        return (len(self.positions) - 1) / self.rate_hz

    @property
    def park(self) -> FloatArray:
        """(n_joints,) where the arm comes from and goes back to."""
        park: FloatArray = self.positions[0]
        return park


def make_program(
    arm: Arm,
    set_points: FloatArray,
    stroke: IntArray,
    rate_hz: float,
    *,
    from_stroke: int = 0,
    from_sample: int | None = None,
    park: Sequence[float] | FloatArray | None = None,
) -> Program:
    """The program of `set_points` (n_samples, n_joints; rad or mm) and their `stroke` (n_samples,) labels.

    from_stroke: the first to be drawn; the drawing is joined at the highest sample of the travel move before it, from
    rest.
    from_sample: if not None the drawing is joined there, in the middle of that stroke: the pen comes straight down.
    park: where the arm comes from and goes to; if None it is where the file begins, lifted if the pen is down there.
    Errors: UsageError (no such stroke), PlanError (no way from or to the park pose).
    """
    refine = math.ceil(_LEAST_RATE_HZ / rate_hz)
    body, labels, rate_hz = *_refined(set_points, stroke, refine), rate_hz * refine
    first = (_start_of(arm, set_points, stroke, from_stroke) if from_sample is None else from_sample) * refine
    rest, sample = body[first], np.arange(len(body)) / refine
    descent = rest[None] if from_sample is None else lower(arm, rest, rate_hz)
    if first:
        joining = set_off(arm, body, first, rate_hz)
        labels = np.concatenate((labels[[first, *np.floor(joining.at).astype(np.int64)]], labels[joining.end + 1 :]))
        body = np.concatenate((rest[None], joining.points, body[joining.end + 1 :]))
        sample = np.concatenate(([first / refine], joining.at / refine, sample[joining.end + 1 :]))
    rest_pose = _park(arm, set_points, rate_hz) if park is None else np.asarray(park)
    out = slow_transfer(arm, rest_pose, descent[0], rate_hz)
    back = slow_transfer(arm, body[-1], rest_pose, rate_hz)
    out = np.concatenate((rest_pose[None], out, descent[1:]))[:-1]  # it ends where the body begins
    ends = len(out), len(back)
    return Program(
        np.concatenate((out, body, back)),
        np.pad(labels, ends, constant_values=TRAVELLING),
        np.pad(sample, ends, mode="edge"),
        rate_hz,
        *ends,
    )


def parking(
    arm: Arm, set_points: FloatArray, rate_hz: float, park: Sequence[float] | FloatArray | None = None
) -> Program:
    """A program that draws nothing any more: where `make_program` would park, and that is all."""
    where = _park(arm, set_points, rate_hz) if park is None else np.asarray(park)
    return Program(where[None], np.array([TRAVELLING]), np.array([len(set_points) - 1.0]), rate_hz, 0, 0)


def visiting(
    arm: Arm, stations: FloatArray, rate_hz: float, park: Sequence[float] | FloatArray | None = None
) -> Program:
    """A program that draws nothing: from the park pose, or else the first of the stations (n, n_joints), to each of
    them, and back. Errors: PlanError where no way with the pen in the air is found."""
    where = stations[0] if park is None else np.asarray(park)
    stops = [where, *stations, where]
    legs = [slow_transfer(arm, start, end, rate_hz) for start, end in pairwise(stops)]
    positions = np.concatenate((where[None], *legs))
    n = len(positions)
    return Program(positions, np.full(n, TRAVELLING), np.zeros(n), rate_hz, 0, 0)


def _refined(set_points: FloatArray, stroke: IntArray, refine: int) -> tuple[FloatArray, IntArray]:
    """`refine` set points for each sample; one between two samples is of a stroke if both are."""
    at = np.arange((len(set_points) - 1) * refine + 1)
    before, after = stroke[at // refine], stroke[-(-at // refine)]
    return interpolate(set_points, at / refine), np.where(before == after, before, TRAVELLING)


def _start_of(arm: Arm, set_points: FloatArray, stroke: IntArray, index: int) -> int:
    """The sample from which stroke `index` and all after it are drawn, and nothing before."""
    if index == 0:
        return 0
    of_stroke = np.flatnonzero(stroke >= index)
    if index < 0 or not len(of_stroke):
        raise UsageError(f"there is no stroke {index}; the drawing has 0 to {stroke.max(initial=-1)}")
    begins = int(of_stroke[0])
    earlier = np.flatnonzero(stroke[:begins] != TRAVELLING)
    move = np.arange(int(earlier[-1]) + 1 if len(earlier) else 0, begins + 1)
    heights_mm = link_nodes_mm(arm, set_points[move])[:, -1, 2]
    return int(move[np.argmax(heights_mm)])


def _park(arm: Arm, set_points: FloatArray, rate_hz: float) -> FloatArray:
    """(n_joints,) where the file begins, lifted if the pen is down there."""
    lifted = lift(arm, set_points[0], rate_hz) if _is_low(arm, set_points[0]) else set_points[:1]
    park: FloatArray = np.concatenate((set_points[:1], lifted))[-1]
    return park


def _is_low(arm: Arm, configuration: FloatArray) -> bool:
    return bool(link_nodes_mm(arm, configuration[None])[0, -1, 2] < arm.pen.clearance_mm)
