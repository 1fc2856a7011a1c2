"""Configurations that take the pen straight up from any configuration, where the trajectory has no lift."""

from __future__ import annotations

import numpy as np

from hardware.motion.tip import Tip, tip_at
from planner.arms.arm import Arm, PenHold
from planner.arrays import FloatArray

_STEP_MM = 0.25
_CORRECTIONS = 2
"""Steps are short, so that the first correction leaves micrometres and the second nothing."""
_DAMPING = 1e-6
"""Relative to the largest singular value squared: enough to pass a singularity, too little to bend the line."""
_AXIS_WEIGHT_MM = 50.0
"""One radian of tilt counts as much as this many millimetres beside the line."""
_DRIFT_MM = 0.5
"""Where the tip would leave the vertical by more than this, the lift ends."""


def vertical_lift(arm: Arm, start: FloatArray, height_mm: float) -> FloatArray:
    """(n, n_joints) configurations, evenly spaced in height, from `start` to `height_mm` above it.

    Each step is the smallest motion of the independent joints that keeps the tip on its vertical (and the pen's
    axis where it was, for an arm that has to point it): damped least squares, with joints that reach a
    limit held there and the rest solved again. Couplings hold throughout. The result is shorter where the
    arm cannot rise that far, and holds at least `start` itself.
    """
    here = tip = tip_at(arm, start)
    steps = max(round(height_mm / _STEP_MM), 1)
    independent = list(arm.independent_joints)
    configurations = [start]
    # What file rounding or an uncoupled configuration leaves of the coupling.
    offset = start - arm.complete(start[independent])
    for step in range(1, steps + 1):
        goal_mm = here.position_mm + np.array([0.0, 0.0, height_mm * step / steps])
        configuration = configurations[-1]
        for _ in range(_CORRECTIONS):
            configuration = _towards(arm, configuration, tip, goal_mm, here.axis, offset)
            tip = tip_at(arm, configuration)
        if np.linalg.norm(tip.position_mm - goal_mm) > _DRIFT_MM:
            break
        configurations.append(configuration)
    return np.array(configurations)


def _towards(
    arm: Arm, configuration: FloatArray, tip: Tip, goal_mm: FloatArray, axis: FloatArray, offset: FloatArray
) -> FloatArray:
    """One damped Gauss-Newton step from `configuration`, where the tip is at `tip`, within the limits of every joint,
    mimic ones included."""
    miss, jacobian = goal_mm - tip.position_mm, tip.position_jacobian
    if arm.pen.hold is PenHold.TOOL_AXIS:
        miss = np.concatenate((miss, _AXIS_WEIGHT_MM * (axis - tip.axis)))
        jacobian = np.vstack((jacobian, _AXIS_WEIGHT_MM * tip.axis_jacobian))
    matrix = arm.coupling_matrix[0]
    independent = np.array(arm.independent_joints)
    active = list(range(len(independent)))
    moved = configuration
    while active:
        reduced = jacobian @ matrix[:, active]
        square = reduced @ reduced.T
        square += _DAMPING * np.trace(square) * np.eye(len(square)) + 1e-12 * np.eye(len(square))
        change = reduced.T @ np.linalg.solve(square, miss)
        moved = configuration.copy()
        moved[independent[active]] += change
        moved = arm.complete(moved[independent]) + offset
        over = np.maximum(arm.minimum - moved, moved - arm.maximum)
        before = np.maximum(arm.minimum - configuration, configuration - arm.maximum)
        over[before >= over] = 0.0  # beyond it already, and no further now
        if not (over > 0).any():
            return moved
        # Take out the independent joint that does most towards the worst excess, directly or through a coupling.
        pushes = np.abs(matrix[int(np.argmax(over))][active] * change)
        active.pop(int(np.argmax(pushes)))
    return configuration
