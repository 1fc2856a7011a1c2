"""Arms whose first joint does not turn about the normal of their paper, and arms that face elsewhere than ahead."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi, radians

from planner.arms.arm import Arm, Joint, JointKind, Pen, PenHold, Workspace
from planner.arms.paper_pose import PaperPose
from tests.arms.chains import load_once


def turning(
    name: str, theta_deg: float, d_mm: float, a_mm: float, alpha_deg: float, low_deg: float, high_deg: float
) -> Joint:
    speed = radians(150.0)
    return Joint(
        name,
        JointKind.REVOLUTE,
        radians(theta_deg),
        d_mm,
        a_mm,
        radians(alpha_deg),
        radians(low_deg),
        radians(high_deg),
        speed,
        5 * speed,
        100 * speed,
    )


def sliding(name: str, d_mm: float, alpha_deg: float, low_mm: float, high_mm: float, theta_deg: float = 0.0) -> Joint:
    return Joint(
        name,
        JointKind.PRISMATIC,
        radians(theta_deg),
        d_mm,
        0.0,
        radians(alpha_deg),
        low_mm,
        high_mm,
        200.0,
        1000.0,
        20000.0,
    )


def made(
    name: str,
    joints: Sequence[Joint],
    hold: PenHold,
    tool_axis: tuple[float, float, float] = (1.0, 0.0, 0.0),
    paper: PaperPose | None = None,
) -> Arm:
    pen = Pen(hold, tool_axis, 5.0, 1.0)
    return Arm(name, "made for tests", tuple(joints), (), pen, Workspace(0.0, 40.0), paper=paper or PaperPose())


BOARD = PaperPose(180.0, 0.0, 150.0, tilt_y_rad=-pi / 2)
"""Upright before the arm, its normal towards the base."""
BESIDE = PaperPose(tilt_x_rad=-pi / 2)
"""The plane of the base frame's z and x axes, its normal along y: level, where the first joint lies."""

_SHORT = [turning("b", 0, 0, 120, 0, -20, 150), turning("c", 0, 0, 150, 0, -150, 20)]

LIFT_SCARA = made(
    "lift_scara",
    [sliding("lift", 0, 0, 60, 240), turning("s", 0, 0, 200, 0, -130, 130), turning("e", 0, -80, 160, 0, -150, 150)],
    PenHold.CONSTRUCTION,
    (0.0, 0.0, -1.0),
)
RAIL_SCARA = made(
    "rail_scara",
    [
        sliding("rail", 0, -90, 0, 600),
        turning("s", 0, 150, 150, 0, -120, 120),
        turning("e", 0, 0, 150, 0, -150, 150),
        sliding("z", 0, 0, -160, -100),
    ],
    PenHold.CONSTRUCTION,
    (0.0, 0.0, -1.0),
    BESIDE,
)
GANTRY = made(
    "gantry",
    [sliding("x", 0, 90, 0, 300), sliding("y", 0, 90, 0, 300, 90.0), sliding("z", 0, 0, -30, 30)],
    PenHold.CONSTRUCTION,
    (0.0, 0.0, 1.0),
    PaperPose(yaw_rad=pi / 2, tilt_x_rad=-pi / 2),
)
LIFT_DRAWING_ARM = made(
    "lift_drawing_arm", [sliding("lift", 0, 0, -20, 60), *load_once("drawing_arm").joints], PenHold.TOOL_AXIS
)
ROLLING = made(
    "rolling",
    [turning("roll", 0, 100, 0, 90, -100, 100), *(replace(joint, a_mm=200.0) for joint in _SHORT)],
    PenHold.FREE,
    paper=PaperPose(z_mm=-150.0, x_mm=-60.0, tilt_y_rad=pi / 2),
)
BOARD_SIX = replace(
    load_once("six_joint"), name="board_six", paper=BOARD, workspace=Workspace(0.0, 60.0), closed_form=None
)

PLANE_ARMS = {arm.name: arm for arm in (LIFT_SCARA, RAIL_SCARA, GANTRY, LIFT_DRAWING_ARM, ROLLING, BOARD_SIX)}


def facing(theta_deg: float, low_deg: float, high_deg: float) -> Arm:
    """Three joints, the first of which turns about the vertical between these limits, zero at theta."""
    first = turning("a", theta_deg, 60, 0, 90, low_deg, high_deg)
    return replace(made(f"facing_{theta_deg:g}_{low_deg:g}".replace("-", "m"), [first, *_SHORT], PenHold.FREE))
