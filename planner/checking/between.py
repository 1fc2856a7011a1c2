"""What the joints do between samples: straight lines, as most controllers have it, and smooth curves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.checking.chain import chain_poses
from planner.checking.held import held_along
from planner.checking.links import Capsules, Clearances
from planner.trajectory import Trajectory

POINTS_PER_STEP = 10
_FEWEST_PER_STEP, _POINTS_PER_SECOND = 2, 1000
_STEPS_AT_ONCE = 4096


class Interpolation(StrEnum):
    """How the joints get from one sample to the next."""

    LINEAR = "linear"
    """Each joint at constant speed: what a controller does that only knows set points."""
    CUBIC = "cubic"
    """The cubic through the four samples around: within J h^3 / 9 of any motion with jerk below J that
    passes through the samples (h is the time between them)."""


def cubic_error(max_jerk: FloatArray, step_s: float) -> FloatArray:
    """How far the cubic can be from a motion that keeps its jerk limit, same units as the positions.

    The error of the interpolation is f[x0, x1, x2, x3, x] (x - x0)(x - x1)(x - x2)(x - x3). A third divided
    difference is J / 6 at most, hence the fourth (J / 6 + J / 6) / 3 h, and the product h^4 at most.
    """
    error: FloatArray = max_jerk * step_s**3 / 9
    return error


def points_per_step(rate_hz: float) -> int:
    """As many as give a thousand points a second, at most POINTS_PER_STEP, and the middle of each step at least:
    nothing happens in the steps of a high rate, and of a million samples every point counts."""
    return int(np.clip(np.ceil(_POINTS_PER_SECOND / rate_hz), _FEWEST_PER_STEP, POINTS_PER_STEP))


def positions_between(
    positions: FloatArray, interpolation: Interpolation, per_step: int = POINTS_PER_STEP
) -> Iterator[FloatArray]:
    """Blocks (n_points, n_joints) that together are all positions at so many points a step: point k belongs to sample
    k // per_step and the last is the last sample."""
    n = len(positions)
    fraction = np.arange(per_step) / per_step
    degree = min(3, n - 1) if interpolation is Interpolation.CUBIC else min(1, n - 1)
    # Weights of the samples around for each place that a step can have among them.
    weights = np.stack([_lagrange(place + fraction, degree) for place in range(max(degree, 1))])
    for start in range(0, n - 1, _STEPS_AT_ONCE):
        step = np.arange(start, min(start + _STEPS_AT_ONCE, n - 1))
        first = np.clip(step - degree // 2, 0, n - 1 - degree)
        around = positions[first[:, np.newaxis] + np.arange(degree + 1)]
        yield (weights[step - first] @ around).reshape(-1, positions.shape[1])
    yield positions[n - 1 :]


def _lagrange(at: FloatArray, degree: int) -> FloatArray:
    """(len(at), degree + 1) weights of nodes 0 .. degree in the polynomial through them."""
    nodes = np.arange(degree + 1)
    columns = [np.prod([(at - other) / (node - other) for other in nodes if other != node], axis=0) for node in nodes]
    weights: FloatArray = np.stack(np.broadcast_arrays(*columns, at)[:-1], axis=1)
    return weights


@dataclass(frozen=True, eq=False, slots=True)
class Sweep:
    """The arm at and between the samples under one interpolation, p points, a number of them for each step.

    sample: (p,) the sample at or before the point. tip_mm: (p, 3). lowest_mm: (p,) lowest node of the
    links. tilt_rad: (p,) angle of the tool axis to how it has to be held. down: (p,) the pen is on the paper, which
    between samples means on it at both. clearances: between links, where they have a thickness.
    """

    interpolation: Interpolation
    points_per_step: int
    sample: IntArray
    tip_mm: FloatArray
    lowest_mm: FloatArray
    tilt_rad: FloatArray
    down: BoolArray
    clearances: Clearances | None


def sweep(trajectory: Trajectory, arm: Arm, interpolation: Interpolation, per_step: int = POINTS_PER_STEP) -> Sweep:
    """The arm's poses at and, with more than one point a step, between all samples."""
    positions = arm.from_file_units(trajectory.positions)
    heights_mm = trajectory.pen_heights_mm
    n_points = (trajectory.n_samples - 1) * per_step + 1
    tip, lowest, tilt = np.empty((n_points, 3)), np.empty(n_points), np.empty(n_points)
    capsules = Capsules(arm, chain_poses(arm, positions[:1]).rows)
    held = held_along(arm)[:, np.newaxis]
    clearances: list[tuple[FloatArray, IntArray]] = []
    start = 0
    for block in positions_between(positions, interpolation, per_step):
        samples = np.arange(start, start + len(block)) // per_step
        poses = chain_poses(arm, block, heights_mm[samples])
        if capsules.pair_names:
            clearances.append(capsules.clearances(poses))
        part = slice(start, start + len(block))
        tip[part] = poses.tip_mm.T
        lowest[part] = np.minimum(poses.lowest_mm, capsules.lowest_mm(poses))
        tilt[part] = np.arctan2(
            np.linalg.norm(np.cross(poses.tool, held, axis=0), axis=0), (poses.tool * held).sum(axis=0)
        )
        start += len(block)
    point = np.arange(n_points)
    sample, between = point // per_step, point % per_step > 0
    down = trajectory.pen[sample] & (~between | trajectory.pen[np.minimum(sample + 1, trajectory.n_samples - 1)])
    apart = None
    if clearances:
        clearance, pair = (np.concatenate(part) for part in zip(*clearances, strict=True))
        apart = Clearances(clearance, pair, capsules.pair_names)
    return Sweep(interpolation, per_step, sample, tip, lowest, tilt, down, apart)
