"""What a posture has to pass before anything is drawn with it, test by test."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from planner.arms.arm import PenHold
from planner.arms.kinematics import Kinematics
from planner.arms.link_clearance import link_clearance
from planner.arms.projection import joint_scale
from planner.arms.quickest_lift import quickest_lifts
from planner.arrays import BoolArray, FloatArray

LIMIT_MARGIN = 0.02
"""Share of a joint's range that postures keep from each end, so that lifts and blends have room."""

LINK_ROOM_MM = 1.0
"""Room that postures leave between links that have a thickness, for the same."""

_NEAR_LIMIT = 3.0
"""A limit is near where so many lifts would pass it."""
_CURVED = 1.1
"""Allowance for the curvature of a lift."""


@dataclass(frozen=True, slots=True)
class PostureTest:
    """kept: (n,) which of postures (n, n_free) with the pen on the paper pass. rejects: what the others do, and remedy:
    what to change in an arm file where none passes."""

    kept: Callable[[Kinematics, FloatArray], BoolArray]
    rejects: str
    remedy: str


def usable_postures(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    """(n,) whether postures on the ray pass all tests."""
    usable: BoolArray = np.ones(len(free), dtype=np.bool_)
    for test in TESTS:
        usable[usable] = test.kept(kinematics, free[usable])
    return usable


def within_margins(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    """(n, n_joints) which joints of postures (n, n_free) keep their limits with a margin."""
    arm = kinematics.arm
    joints = arm.complete(free)
    room = LIMIT_MARGIN * (arm.maximum - arm.minimum)
    inside: BoolArray = (joints >= arm.minimum + room) & (joints <= arm.maximum - room)
    return inside


def slowest_direction_mm_s(kinematics: Kinematics, free: FloatArray) -> FloatArray:
    """(n,) tip speed that is possible in every direction, with the pen held as it is held and joint speeds of unit
    norm in units of their limits: the smallest singular value of the tip's J diag(speed), restricted to motions
    that do not turn the tool axis. Zero at a singular posture."""
    _, jacobian = kinematics.task_and_jacobian(free)
    jacobian = jacobian * joint_scale(kinematics)
    tip, pointing = jacobian[:, :3], jacobian[:, 3:]
    if pointing.shape[1]:
        tip = tip - tip @ np.linalg.pinv(pointing) @ pointing
    singular: FloatArray = np.asarray(np.linalg.svd(tip, compute_uv=False))
    return singular[:, 2]


def _keeps_limits(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    kept: BoolArray = np.all(within_margins(kinematics, free), axis=1)
    return kept


def _links_above_paper(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    above: BoolArray = np.all(kinematics.nodes_mm(free)[:, :-1, 2] >= -1e-6, axis=1)
    return above


def _pen_points_down(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    """The task alone would let it point straight up."""
    if kinematics.arm.pen.hold is not PenHold.TOOL_AXIS:
        return np.ones(len(free), dtype=np.bool_)
    down: BoolArray = kinematics.tool_axis(free)[:, 2] < -0.5
    return down


def _is_quick(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    quick: BoolArray = slowest_direction_mm_s(kinematics, free) >= kinematics.arm.workspace.min_tip_speed_mm_s
    return quick


def _links_apart(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    apart: BoolArray = link_clearance(kinematics.arm).least_mm(free)[0] >= LINK_ROOM_MM
    return apart


def _links_apart_when_raised(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    if not link_clearance(kinematics.arm).names:
        return np.ones(len(free), dtype=np.bool_)
    lifts = quickest_lifts(kinematics, kinematics.arm.max_jerk, free)
    return _links_apart(kinematics, free + kinematics.arm.pen.lift_mm * lifts)


def _may_be_raised(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    """(n,) whether joint limits leave room for the arm's quickest lift, to first order. Only postures near a limit, for
    the cheaper lift in the least joint time, are looked at closely."""
    arm = kinematics.arm
    matrix, _ = arm.coupling_matrix
    joints = arm.complete(free)

    def has_room(lifts: FloatArray, rows: BoolArray, times: float) -> BoolArray:
        raised = joints[rows] + times * arm.pen.lift_mm * (lifts @ matrix.T)
        kept: BoolArray = np.all((raised >= arm.minimum) & (raised <= arm.maximum), axis=1)
        return kept

    _, jacobian = kinematics.task_and_jacobian(free)
    lifts = np.linalg.pinv(jacobian * joint_scale(kinematics))[:, :, 2] * joint_scale(kinematics)
    room = has_room(lifts, np.ones(len(free), dtype=np.bool_), _NEAR_LIMIT)
    close = ~room
    if close.any():
        room[close] = has_room(quickest_lifts(kinematics, arm.max_jerk, free[close]), close, _CURVED)
    return room


TESTS = (
    PostureTest(_keeps_limits, "have a joint beyond its limits or nearly so",
                "widen these limits, or change theta_deg"),
    PostureTest(_links_above_paper, "have a joint below the paper", "raise the base (d_mm of the first joint)"),
    PostureTest(_pen_points_down, "have the pen pointing up", "turn pen.tool_axis around"),
    PostureTest(_is_quick, "cannot move the tip fast enough in every direction",
                "lower workspace.min_tip_speed_mm_s, or raise the joints' max_velocity"),
    PostureTest(_links_apart, "bring links too close to each other or to the paper", "check thickness_mm of the links"),
    PostureTest(_may_be_raised, "have no room within the limits to lift the pen", "lower pen.lift_mm, or widen limits"),
    PostureTest(_links_apart_when_raised, "bring links too close when the pen is lifted",
                "check thickness_mm of the links, or lower pen.lift_mm"),
)
"""The cheap ones first."""
