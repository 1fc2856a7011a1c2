"""A slow transfer from one configuration at rest to another with the pen in the air: to the drawing and away."""

from __future__ import annotations

import math
from contextlib import suppress

import numpy as np

from hardware.motion.minimum_jerk import least_duration_s, minimum_jerk
from hardware.motion.stopping import lift, slow_down
from hardware.motion.tip import link_nodes_mm
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import PlanError

_SHARE = 0.2
"""Of every limit of speed, acceleration and jerk: where the arm really is may not be known."""
_LIFTS = (1.0, 2.0, 4.0, 8.0)
"""How far up both ends are taken, in lift heights, where the straight line would come too near the paper."""
_SAME = 1e-7
_BEYOND = 0.01
"""In rad or mm: servos round their position."""
_GRAZE_MM = 0.01
"""So much below the clearance, or below the paper, is rounding."""


def slow_transfer(arm: Arm, start: FloatArray, goal: FloatArray, rate_hz: float) -> FloatArray:
    """Set points (n, n_joints) at `rate_hz` from rest at `start`, itself left out, to rest at `goal`; none if they
    are the same.

    All joints go straight to their goals, with the progress of `minimum_jerk`, and keep to a fifth of every limit;
    couplings, being affine, hold all along. The tip stays at or above the clearance and no link dips below the paper.
    The arm leaves or reaches an end vertically if it is lower, or if the straight line from there would be.
    Errors: PlanError where no such path is found.
    """
    if np.allclose(start, goal, rtol=0.0, atol=_SAME):
        return np.empty((0, arm.n_joints))
    ends = np.stack((start, goal))
    low = link_nodes_mm(arm, ends)[:, -1, 2] < arm.pen.clearance_mm - _GRAZE_MM
    slowed_hz = rate_hz / _SHARE
    for heights_mm in (np.where(low, arm.pen.lift_mm, -np.inf), *(arm.pen.lift_mm * n * np.ones(2) for n in _LIFTS)):
        up, down = (lift(arm, end, slowed_hz, height_mm) for end, height_mm in zip(ends, heights_mm, strict=True))
        line = straight(arm, np.concatenate((start[None], up))[-1], np.concatenate((goal[None], down))[-1], rate_hz)
        points = np.concatenate((up, line, np.concatenate((goal[None], down))[-2::-1]))
        heights = link_nodes_mm(arm, line)[:, :, 2]
        clear_of_paper = heights.min() >= min(-_GRAZE_MM, link_nodes_mm(arm, ends)[:, :, 2].min())
        if (
            heights[:, -1].min() >= arm.pen.clearance_mm - _GRAZE_MM
            and clear_of_paper
            and slow_down(arm, np.concatenate((start[None], points)), 1 / rate_hz) <= 1
        ):
            return points
    raise PlanError(
        f"no path was found for arm '{arm.name}' from ({in_words(arm, start)}) to ({in_words(arm, goal)}) "
        "with its pen in the air (another [park] pose in its file may help)"
    )


def come_from(arm: Arm, start: FloatArray, goal: FloatArray, rate_hz: float) -> FloatArray:
    """As `slow_transfer`, from wherever the arm happens to be: straight where no path through the air is found, or a
    joint was moved by hand beyond its limits."""
    if np.all((start >= arm.minimum - _BEYOND) & (start <= arm.maximum + _BEYOND)):
        with suppress(PlanError):
            return slow_transfer(arm, start, goal, rate_hz)
    return straight(arm, start, goal, rate_hz)


def straight(arm: Arm, start: FloatArray, goal: FloatArray, rate_hz: float) -> FloatArray:
    """Set points (n, n_joints) from rest at `start`, itself left out, to rest at `goal`, at a fifth of every limit,
    wherever that leads."""
    n = max(math.ceil(least_duration_s(arm, np.abs(goal - start) / _SHARE) * rate_hz), 1)
    points: FloatArray = start + minimum_jerk(n) * (goal - start)
    points[-1] = goal
    return points


def in_words(arm: Arm, positions: FloatArray) -> str:
    """A configuration (n_joints,), joint by joint."""
    values = zip(arm.joints, arm.to_file_units(positions), strict=True)
    return ", ".join(f"{joint.name} {value:.1f} {joint.file_unit}" for joint, value in values)
