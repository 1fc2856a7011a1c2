"""What a configuration has to pass before anything is drawn with it, test by test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from planner.arms.arm import PenHold
from planner.arrays import BoolArray, FloatArray
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import joint_scale
from planner.kinematics.quickest_lift import quickest_lifts

LIMIT_MARGIN = 0.02
"""Share of a joint's range that configurations keep from each end, so that lifts and blends have clearance."""

LINK_CLEARANCE_MM = 1.0
"""Clearance that configurations leave between links that have a thickness, for the same."""

_ROUNDING_MM = 1e-6

_STILL_MM_S = 1e-6
"""A tip that is slower cannot move that way at all."""

_NEAR_LIMIT = 3.0
"""A limit is near where so many lifts would pass it."""
_CURVED = 1.1
"""Allowance for the curvature of a lift."""


@dataclass(frozen=True, slots=True)
class ConfigurationTest:
    """kept: (n,) which of configurations (n, n_independent) with the pen on the paper pass. rejects: what the others
    do, and remedy: what to change in an arm file where none passes."""

    kept: Callable[[Kinematics, FloatArray], BoolArray]
    rejects: str
    remedy: str


def usable_configurations(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    """(n,) whether configurations on the ray pass all tests."""
    usable: BoolArray = np.ones(len(independent), dtype=np.bool_)
    for test in TESTS:
        usable[usable] = test.kept(kinematics, independent[usable])
    return usable


def within_margins(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    """(n, n_joints) which joints of configurations (n, n_independent) keep their limits with a margin."""
    arm = kinematics.arm
    joints = arm.complete(independent)
    margin = LIMIT_MARGIN * (arm.maximum - arm.minimum)
    inside: BoolArray = (joints >= arm.minimum + margin) & (joints <= arm.maximum - margin)
    return inside


def slowest_direction_mm_s(kinematics: Kinematics, independent: FloatArray) -> FloatArray:
    """(n,) tip speed that is possible in every direction, with the pen held as it is held and joint speeds of unit
    norm in units of their limits: the smallest singular value of the tip's J diag(speed), restricted to motions
    that do not turn the tool axis. Zero at a singular configuration."""
    _, jacobian = kinematics.task_and_jacobian(independent)
    jacobian = jacobian * joint_scale(kinematics)
    tip, pointing = jacobian[:, :3], jacobian[:, 3:]
    if pointing.shape[1]:
        tip = tip - tip @ np.linalg.pinv(pointing) @ pointing
    singular: FloatArray = np.asarray(np.linalg.svd(tip, compute_uv=False))
    return singular[:, 2]


def _keeps_limits(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    kept: BoolArray = np.all(within_margins(kinematics, independent), axis=1)
    return kept


def _links_above_paper(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    above: BoolArray = kinematics.clearance.lowest_mm(independent) >= -_ROUNDING_MM
    return above


def _pen_points_down(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    """The task alone would let it point straight up."""
    if kinematics.arm.pen.hold is not PenHold.TOOL_AXIS:
        return np.ones(len(independent), dtype=np.bool_)
    down: BoolArray = kinematics.tool_axis(independent)[:, 2] < -0.5
    return down


def _is_free(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    free: BoolArray = slowest_direction_mm_s(kinematics, independent) >= _STILL_MM_S
    return free


def _is_quick(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    quick: BoolArray = slowest_direction_mm_s(kinematics, independent) >= kinematics.arm.workspace.min_tip_speed_mm_s
    return quick


def _links_apart(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    apart: BoolArray = kinematics.clearance.least_mm(independent)[0] >= LINK_CLEARANCE_MM
    return apart


def _links_apart_when_raised(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    if not kinematics.clearance.names:
        return np.ones(len(independent), dtype=np.bool_)
    lifts = quickest_lifts(kinematics, kinematics.arm.max_jerk, independent)
    return _links_apart(kinematics, independent + kinematics.arm.pen.lift_mm * lifts)


def _may_be_raised(kinematics: Kinematics, independent: FloatArray) -> BoolArray:
    """(n,) whether joint limits leave room for the arm's quickest lift, to first order. Only configurations near a
    limit, for the cheaper lift in the least joint time, are looked at closely."""
    arm = kinematics.arm
    matrix, _ = arm.coupling_matrix
    joints = arm.complete(independent)

    def has_room(lifts: FloatArray, rows: BoolArray, times: float) -> BoolArray:
        raised = joints[rows] + times * arm.pen.lift_mm * (lifts @ matrix.T)
        kept: BoolArray = np.all((raised >= arm.minimum) & (raised <= arm.maximum), axis=1)
        return kept

    _, jacobian = kinematics.task_and_jacobian(independent)
    lifts = np.linalg.pinv(jacobian * joint_scale(kinematics))[:, :, 2] * joint_scale(kinematics)
    room = has_room(lifts, np.ones(len(independent), dtype=np.bool_), _NEAR_LIMIT)
    close = ~room
    if close.any():
        room[close] = has_room(quickest_lifts(kinematics, arm.max_jerk, independent[close]), close, _CURVED)
    return room


QUICK = ConfigurationTest(
    _is_quick,
    "cannot move the tip fast enough in every direction",
    "lower workspace.min_tip_speed_mm_s, or raise the joints' max_velocity",
)
FREE = ConfigurationTest(
    _is_free,
    "have a direction that no joint moves the tip in",
    "give the arm joints that move it along and across the paper and off it: check theta_deg, alpha_deg and [paper]",
)
"""What is not free is not quick either: this tells it apart where an arm is refused."""

LINKS_ABOVE = ConfigurationTest(
    _links_above_paper, "have a joint below the paper", "raise the base (d_mm of the first joint)"
)

TESTS = (
    ConfigurationTest(
        _keeps_limits, "have a joint beyond its limits or nearly so", "widen these limits, or change theta_deg"
    ),
    LINKS_ABOVE,
    ConfigurationTest(_pen_points_down, "have the pen pointing away from the paper", "turn pen.tool_axis around"),
    QUICK,
    ConfigurationTest(
        _links_apart, "bring links too close to each other or to the paper", "check thickness_mm of the links"
    ),
    ConfigurationTest(
        _may_be_raised, "have no room within the limits to lift the pen", "lower pen.lift_mm, or widen limits"
    ),
    ConfigurationTest(
        _links_apart_when_raised,
        "bring links too close when the pen is lifted",
        "check thickness_mm of the links, or lower pen.lift_mm",
    ),
)
"""The cheap ones first."""
