"""The same trajectory with samples at another rate, within the limits of the joints.

Where the arm rests it rests; between two rests runs the quintic spline through the samples that begins and ends at
rest. It may have up to 1.4 times the jerk that the samples have, for part of a step; a motion that exceeds a limit so
is run as much slower as keeps it. Each motion and each rest takes a whole number of the new steps.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.trajectory import TRAVELLING, Trajectory

_DEGREE = 5
_PLACES = 8
"""A step is looked at in so many for its greatest velocity, acceleration and jerk."""
_ROOM = 1.002
"""For what lies between these."""


def resampled(trajectory: Trajectory, arm: Arm, rate_hz: float) -> Trajectory:
    """The trajectory at that rate, a little longer where a motion had to be slowed down. At its own rate it is what it
    was."""
    if trajectory.rate_hz == rate_hz or trajectory.n_samples < 2:
        return trajectory
    times, positions = [np.zeros(1)], [trajectory.positions[:1]]
    for start, end, moves in _parts(trajectory):
        duration_s = (end - start) / trajectory.rate_hz
        spline = _through(trajectory, start, end) if moves else None
        slower = 1.0 if spline is None else _slower(spline, (end - start) * _PLACES, arm)
        n_steps = int(np.ceil(duration_s * slower * rate_hz - 1e-6))
        shares = np.arange(1, n_steps + 1) / n_steps
        times.append((start + (end - start) * shares) / trajectory.rate_hz)
        held = np.broadcast_to(trajectory.positions[end], (n_steps, len(arm.joints)))
        positions.append(held if spline is None else spline(duration_s * shares))
    at = np.concatenate(times)
    pen, stroke = _flags(trajectory, at)
    return replace(
        trajectory,
        rate_hz=rate_hz,
        positions=np.clip(
            np.concatenate(positions), *(arm.to_file_units(limit) for limit in (arm.minimum, arm.maximum))
        ),
        pen=pen,
        stroke=stroke,
        first_line=None,
        decimals=None,
        pen_changes=tuple(np.searchsorted(at, np.array(trajectory.pen_changes) / trajectory.rate_hz - 1e-9).tolist()),
    )


def _parts(trajectory: Trajectory) -> Iterator[tuple[int, int, bool]]:
    """First and last sample of each part, and whether the arm moves in it or rests: samples repeat where it rests for a
    while, and where the tip comes to the paper or leaves it it rests for a moment."""
    still = np.abs(np.diff(trajectory.positions, axis=0)) <= trajectory.rounding[1:]
    rests: BoolArray = np.all(still, axis=1)
    pen = trajectory.pen
    touches = np.flatnonzero(pen & ~np.concatenate((pen[:1], pen[:-1])))
    leaves = np.flatnonzero(pen & ~np.concatenate((pen[1:], pen[-1:])))
    cuts = np.unique(np.concatenate(([0, len(rests)], np.flatnonzero(np.diff(rests)) + 1, touches, leaves)))
    for start, end in pairwise(cuts.tolist()):
        yield start, end, not rests[start]


def _through(trajectory: Trajectory, start: int, end: int) -> BSpline:
    """From time 0 on, at rest at both ends."""
    positions = trajectory.positions[start : end + 1]
    rest = [(order, np.zeros(positions.shape[1])) for order in (1, 2)]
    times = np.arange(len(positions)) / trajectory.rate_hz
    return make_interp_spline(times, positions, k=_DEGREE, bc_type=(rest, rest))  # type: ignore[arg-type]


def _slower(spline: BSpline, places: int, arm: Arm) -> float:
    """How many times longer the motion has to take: s divides velocity by s, acceleration by s^2, jerk by s^3."""
    times = np.linspace(spline.t[0], spline.t[-1], places + 1)
    slower = 1.0
    for order, limit in enumerate((arm.max_velocity, arm.max_acceleration, arm.max_jerk), start=1):
        share = float((np.abs(spline(times, nu=order)).max(axis=0) / arm.to_file_units(limit)).max())
        slower = max(slower, (share * _ROOM) ** (1.0 / order))
    return slower


def _flags(trajectory: Trajectory, times: FloatArray) -> tuple[BoolArray, IntArray]:
    """Pen and stroke at times (n,) of the trajectory: down, where it is so at the sample before and at the one
    after."""
    at = times * trajectory.rate_hz
    before, after = (
        np.clip(samples.astype(np.int64), 0, trajectory.n_samples - 1)
        for samples in (np.floor(at + 1e-6), np.ceil(at - 1e-6))
    )
    pen = trajectory.pen[before] & trajectory.pen[after] & (trajectory.stroke[before] == trajectory.stroke[after])
    return pen, np.where(pen, trajectory.stroke[before], TRAVELLING)
