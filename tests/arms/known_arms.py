"""Arms that many people have, of 0.5 to 1 m, from the Denavit-Hartenberg tables that their makers publish.

The figures are for testing: limits are rounded, accelerations and jerks are guesses, and the pen is 150 mm long.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import degrees, radians

from planner.arms.arm import Arm, Joint, JointKind, Pen, PenHold, Workspace

_PEN_MM = 150.0


@dataclass(frozen=True, slots=True)
class Row:
    """Degrees and millimetres."""

    theta_deg: float
    d_mm: float
    a_mm: float
    alpha_deg: float
    min_deg: float
    max_deg: float


def _arm(name: str, inner_radius_mm: float, rows: list[Row], speed_deg_s: float = 180.0) -> Arm:
    """Turning joints that reach full speed in 0.2 s and full acceleration in 0.05 s; the last row carries the pen."""
    rows = [*rows[:-1], replace(rows[-1], d_mm=rows[-1].d_mm + _PEN_MM)]
    speed = radians(speed_deg_s)
    joints = tuple(
        Joint(
            f"j{number}",
            JointKind.REVOLUTE,
            radians(row.theta_deg),
            row.d_mm,
            row.a_mm,
            radians(row.alpha_deg),
            radians(row.min_deg),
            radians(row.max_deg),
            speed,
            5 * speed,
            100 * speed,
        )
        for number, row in enumerate(rows, 1)
    )
    return Arm(
        name,
        "the maker's table; for testing",
        joints,
        (),
        Pen(PenHold.TOOL_AXIS, (0.0, 0.0, 1.0), 5.0, 1.0),
        Workspace(inner_radius_mm, 60.0),
    )


UR3E = _arm(
    "ur3e",
    150.0,
    [
        Row(0, 151.85, 0, 90, -360, 360),
        Row(0, 0, -243.55, 0, -360, 360),
        Row(0, 0, -213.2, 0, -360, 360),
        Row(0, 131.05, 0, 90, -360, 360),
        Row(0, 85.35, 0, -90, -360, 360),
        Row(0, 92.1, 0, 0, -360, 360),
    ],
)
UR5E = _arm(
    "ur5e",
    200.0,
    [
        Row(0, 162.5, 0, 90, -360, 360),
        Row(0, 0, -425, 0, -360, 360),
        Row(0, 0, -392.2, 0, -180, 180),
        Row(0, 133.3, 0, 90, -360, 360),
        Row(0, 99.7, 0, -90, -360, 360),
        Row(0, 99.6, 0, 0, -360, 360),
    ],
)
XARM6 = _arm(
    "xarm6",
    200.0,
    [
        Row(0, 267, 0, -90, -360, 360),
        Row(-79.35, 0, 289.49, 0, -118, 120),
        Row(79.35, 0, 77.5, -90, -225, 11),
        Row(0, 342.5, 0, 90, -360, 360),
        Row(0, 0, 76, -90, -97, 180),
        Row(0, 97, 0, 0, -360, 360),
    ],
)
LITE6 = _arm(
    "lite6",
    150.0,
    [
        Row(0, 243.3, 0, -90, -360, 360),
        Row(-90, 0, 200, 180, -150, 150),
        Row(-90, 0, 87, 90, -3.5, 300),
        Row(0, 227.6, 0, 90, -360, 360),
        Row(0, 0, 0, -90, -124, 124),
        Row(0, 61.5, 0, 0, -360, 360),
    ],
)
PANDA = _arm(
    "panda",
    300.0,
    [
        Row(0, 333, 0, -90, -166, 166),
        Row(0, 0, 0, 90, -101, 101),
        Row(0, 316, 82.5, 90, -166, 166),
        Row(0, 0, -82.5, -90, -176, -4),
        Row(0, 384, 0, 90, -166, 166),
        Row(0, 0, 88, 90, -1, 215),
        Row(0, 107, 0, 0, -166, 166),
    ],
    150.0,
)

KNOWN_ARMS = {arm.name: arm for arm in (UR3E, UR5E, XARM6, LITE6, PANDA)}


def scaled(arm: Arm, factor: float) -> Arm:
    """The arm with all its lengths, those of slides too, so many times as long."""

    def longer(joint: Joint) -> Joint:
        thickness = None if joint.thickness_mm is None else factor * joint.thickness_mm
        grown = replace(joint, d_mm=factor * joint.d_mm, a_mm=factor * joint.a_mm, thickness_mm=thickness)
        if joint.kind is JointKind.REVOLUTE:
            return grown
        return replace(
            grown,
            **{
                key: factor * getattr(joint, key)
                for key in ("minimum", "maximum", "max_velocity", "max_acceleration", "max_jerk")
            },
        )

    workspace = replace(
        arm.workspace,
        inner_radius_mm=factor * arm.workspace.inner_radius_mm,
        min_tip_speed_mm_s=min(factor, 1.0) * arm.workspace.min_tip_speed_mm_s,
    )
    return replace(
        arm,
        name=f"{arm.name}_{factor:.2f}".replace(".", "_"),
        joints=tuple(map(longer, arm.joints)),
        workspace=workspace,
        park=None,
    )


def file_text(arm: Arm) -> str:
    """The arm as an arm file says it, without servos."""
    name = [joint.name for joint in arm.joints]
    lines = [f'name = "{arm.name}"', f'source = "{arm.source}"']
    if arm.closed_form is not None:
        lines.append(f'closed_form = "{arm.closed_form}"')
    lines += [
        "[pen]",
        f'hold = "{arm.pen.hold}"',
        f"tool_axis = {list(arm.pen.tool_axis)}",
        f"lift_mm = {arm.pen.lift_mm}",
        f"clearance_mm = {arm.pen.clearance_mm}",
        "[workspace]",
        f"inner_radius_mm = {arm.workspace.inner_radius_mm}",
        f"min_tip_speed_mm_s = {arm.workspace.min_tip_speed_mm_s}",
    ]
    for joint in arm.joints:
        unit, per = joint.file_unit, joint.per_file_unit
        lines += [
            "[[joints]]",
            f'name = "{joint.name}"',
            f'kind = "{joint.kind}"',
            f"theta_deg = {degrees(joint.theta_rad)}",
            f"d_mm = {joint.d_mm}",
            f"a_mm = {joint.a_mm}",
            f"alpha_deg = {degrees(joint.alpha_rad)}",
            f"min_{unit} = {joint.minimum / per}",
            f"max_{unit} = {joint.maximum / per}",
            f"max_velocity_{unit}_s = {joint.max_velocity / per}",
            f"max_acceleration_{unit}_s2 = {joint.max_acceleration / per}",
            f"max_jerk_{unit}_s3 = {joint.max_jerk / per}",
        ]
        if joint.thickness_mm is not None:
            lines.append(f"thickness_mm = {joint.thickness_mm}")
    for coupling in arm.couplings:
        terms = ", ".join(f"{name[other]} = {value}" for other, value in coupling.coefficients)
        lines += [
            "[[coupling]]",
            f'joint = "{name[coupling.joint]}"',
            f"constant_deg = {degrees(coupling.constant)}",
            f"coefficients = {{ {terms} }}",
        ]
    return "\n".join(lines) + "\n"
