"""An arm from a robot description: the branch from one link to another, and a pen at its end.

A joint of URDF is `T(origin)`, then a turn about or a slide along an axis of any direction. With W a turn that takes z
to the axis, the chain is `... W_before^-1 T(origin) W Rz(q) ...`: the fixed part is the joint's origin here, and no row
of a table has anything to add. Joints that do not move are folded into the origin of the next. All lengths become
millimetres.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from planner.arms.arm import Arm, Coupling, Joint, JointKind, Pen, PenHold, Workspace
from planner.arms.rigid_transform import IDENTITY, RigidTransform
from planner.arms.urdf.branch import chosen_branch
from planner.arms.urdf.import_options import ImportOptions
from planner.arms.urdf.limits import position_limits, velocity_limit
from planner.arms.urdf.mimics import led, standing
from planner.arms.urdf.robot import Robot, UrdfJoint
from planner.arrays import FloatArray

_MM = 1000.0
_ALIGNED = float(np.cos(np.radians(20.0)))
_NEAR_MM = 1.0
_NOTHING = 1e-11
"""mm or rad that arithmetic leaves of what is zero."""
_INNER_SHARE, _SPEED_SHARE, _USUAL_SPEED_MM_S = 0.15, 0.05, 80.0
_LONGEST_NAME = 64


@dataclass(frozen=True, eq=False, slots=True)
class Imported:
    """base, tip: the links that the arm reaches from and to. remarks: what was made up, and what somebody should
    know before the arm moves."""

    arm: Arm
    base: str
    tip: str
    remarks: tuple[str, ...]


def imported(robot: Robot, options: ImportOptions) -> Imported:
    """The arm, its pen held as its tool axis points. Errors: ArmFileError."""
    base, tip, branch = chosen_branch(robot, options.base, options.tip)
    remarks: list[str] = []
    moving, origins, behind = _chain(robot, branch, remarks)
    names = _names([joint.name for joint in moving])
    joints = _with_plain_first(
        tuple(
            _joint(robot, joint, name, RigidTransform.of(origin), options, remarks)
            for joint, name, origin in zip(moving, names, origins, strict=True)
        )
    )
    axis = options.tool_axis or _usual_axis(behind @ options.tool.matrix, remarks)
    tool = behind @ options.tool.matrix
    tool[:3, 3] += tool[:3, :3] @ (options.pen_length_mm * np.array(axis))
    if options.pen_length_mm == 0 and options.tool.is_identity:
        remarks.append(f"the pen's tip is at the origin of link {tip}; --pen-length and --tool put it elsewhere")
    place = {joint.name: index for index, joint in enumerate(moving)}
    couplings = tuple(
        _coupling(place[name], place[found.leader.name], found.multiplier, found.offset, joints)
        for name, found in led(robot, moving).items()
    )
    length_mm = sum(joint.length_mm for joint in joints) + float(np.linalg.norm(tool[:3, 3]))
    inner_mm = options.inner_radius_mm
    if inner_mm is None:
        inner_mm = _rounded(_INNER_SHARE * length_mm)
        remarks.append(f"workspace.inner_radius_mm is {_INNER_SHARE:g} of the arm's length")
    remarks.append(
        "accelerations and jerks are no part of a robot description: each joint gets to full speed in"
        f" {options.speeding_up_s:g} s, and to full acceleration in {options.jerking_s:g} s"
    )
    arm = Arm(
        _name(options.name or robot.name or "robot"),
        f"robot description '{robot.name}', link {base} to link {tip}",
        joints,
        couplings,
        Pen(PenHold.TOOL_AXIS, axis, options.lift_mm, min(1.0, options.lift_mm)),
        Workspace(inner_mm, _tip_speed_mm_s(joints, length_mm)),
        tool=RigidTransform.of(tool),
    )
    return Imported(arm, base, tip, tuple(remarks))


def _chain(
    robot: Robot, branch: Sequence[UrdfJoint], remarks: list[str]
) -> tuple[list[UrdfJoint], list[FloatArray], FloatArray]:
    """The joints that move, the fixed transform (4, 4) before each, and that behind the last, mm."""
    moving, origins = [], []
    pending = np.eye(4)
    for joint in branch:
        pending = pending @ _origin(robot, joint).matrix
        if joint.kind == "fixed":
            continue
        stands = standing(robot, joint)
        axis = _axis(robot, joint)
        if stands is not None:
            remarks.append(f"joint {joint.name} cannot move, and stands at {stands:g}")
            pending = pending @ _moved(joint, axis, stands)
            continue
        turn = _onto(axis)
        moving.append(joint)
        origins.append(pending @ turn)
        pending = turn.T
    if not moving:
        robot.refuse("none of the joints between the base and the tip can move")
    return moving, origins, pending


def _origin(robot: Robot, joint: UrdfJoint) -> RigidTransform:
    x, y, z = (_MM * value for value in robot.numbers(joint, "origin", "xyz", (0.0, 0.0, 0.0)))
    roll, pitch, yaw = robot.numbers(joint, "origin", "rpy", (0.0, 0.0, 0.0))
    return RigidTransform(x, y, z, roll, pitch, yaw)


def _axis(robot: Robot, joint: UrdfJoint) -> FloatArray:
    axis = np.array(robot.numbers(joint, "axis", "xyz", (1.0, 0.0, 0.0)))
    length = float(np.linalg.norm(axis))
    if length < 1e-9:
        robot.refuse(f"joint {joint.name} in line {joint.line}: its axis has no direction")
    unit: FloatArray = axis / length
    return unit


def _onto(axis: FloatArray) -> FloatArray:
    """(4, 4) a turn that takes z to a unit vector (3,)."""
    x, y, z = axis.tolist()
    if z < 0:  # half a turn about x first: near -z the formula below has no digits left
        flip = np.diag([1.0, -1.0, -1.0, 1.0])
        flipped: FloatArray = flip @ _onto(flip[:3, :3] @ axis)
        return flipped
    turn = np.eye(4)
    turn[:3, :3] += np.array(
        [[-x * x / (1 + z), -x * y / (1 + z), x], [-x * y / (1 + z), -y * y / (1 + z), y], [-x, -y, z - 1]]
    )
    return turn


def _moved(joint: UrdfJoint, axis: FloatArray, position: float) -> FloatArray:
    """(4, 4) what a joint's position, rad or m, amounts to."""
    along = RigidTransform(z_mm=_MM * position) if joint.kind == "prismatic" else RigidTransform(yaw_rad=position)
    turn = _onto(axis)
    return turn @ along.matrix @ turn.T


def _joint(
    robot: Robot, joint: UrdfJoint, name: str, origin: RigidTransform, options: ImportOptions, remarks: list[str]
) -> Joint:
    slides = joint.kind == "prismatic"
    scale = _MM if slides else 1.0
    lower, upper = position_limits(robot, joint, options, remarks)
    velocity = scale * velocity_limit(robot, joint, options, remarks)
    acceleration = velocity / options.speeding_up_s
    return Joint(
        name,
        JointKind.PRISMATIC if slides else JointKind.REVOLUTE,
        0.0,
        0.0,
        0.0,
        0.0,
        scale * lower,
        scale * upper,
        velocity,
        acceleration,
        acceleration / options.jerking_s,
        origin=origin,
        urdf_name=None if joint.name == name else joint.name,
    )


def _with_plain_first(joints: tuple[Joint, ...]) -> tuple[Joint, ...]:
    """Where the first joint's axis is the base's own z, its origin is a turn and a shift that a row has: so it is seen
    that the arm turns about the vertical."""
    first = joints[0]
    origin = first.origin
    if max(map(abs, (origin.x_mm, origin.y_mm, origin.roll_rad, origin.pitch_rad))) > _NOTHING:
        return joints
    return (replace(first, theta_rad=origin.yaw_rad, d_mm=origin.z_mm, origin=IDENTITY), *joints[1:])


def _coupling(driven: int, leader: int, multiplier: float, offset: float, joints: Sequence[Joint]) -> Coupling:
    """In rad and mm, of what is in rad and m."""
    of_driven, of_leader = (_MM if joints[index].kind is JointKind.PRISMATIC else 1.0 for index in (driven, leader))
    return Coupling(driven, offset * of_driven, ((leader, multiplier * of_driven / of_leader),))


def _usual_axis(behind: FloatArray, remarks: list[str]) -> tuple[float, float, float]:
    """The axis of the tip's frame that the pen lies along: the one by which the tip is beyond the last joint, else the
    last joint's own, else z."""
    offset, last_axis = behind[:3, :3].T @ behind[:3, 3], behind[2, :3]
    axis = np.array([0.0, 0.0, 1.0])
    for direction in (offset / max(float(np.linalg.norm(offset)), _NEAR_MM), last_axis):
        largest = int(np.abs(direction).argmax())
        if abs(direction[largest]) > _ALIGNED:
            axis = np.eye(3)[largest] * np.sign(direction[largest]) + 0.0
            break
    told = ("-" if axis.min() < 0 else "") + "xyz"[int(np.abs(axis).argmax())]
    remarks.append(f"the nib points along {told} of the tip's frame; --tool-axis says otherwise")
    x, y, z = axis.tolist()
    return x, y, z


def _tip_speed_mm_s(joints: Sequence[Joint], length_mm: float) -> float:
    """A share of what the slowest joint moves the tip at, where that is less than the usual."""
    speeds = [joint.max_velocity * (1.0 if joint.kind is JointKind.PRISMATIC else length_mm / 2) for joint in joints]
    return _rounded(min(_USUAL_SPEED_MM_S, _SPEED_SHARE * min(speeds)))


def _rounded(value: float) -> float:
    return max(float(f"{value:.2g}"), 0.01)


def _name(text: str) -> str:
    """As a column or an arm may be called."""
    name = re.sub(r"[^A-Za-z0-9_]", "_", text)[:_LONGEST_NAME]
    return name if name and not name[0].isdigit() else f"_{name}"[:_LONGEST_NAME]


def _names(names: Sequence[str]) -> list[str]:
    """Each once."""
    given: list[str] = []
    for text in names:
        name, number = _name(text), 2
        while name in given:
            name = f"{_name(text)[: _LONGEST_NAME - 4]}_{number}"
            number += 1
        given.append(name)
    return given
