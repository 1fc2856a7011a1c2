"""The sections of an arm file, in degrees, millimetres and seconds, checked whole; and the arm that they amount to."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections import Counter
from dataclasses import replace
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import AfterValidator, Field, ValidationError, model_validator

from planner.arms.accuracy import Accuracy
from planner.arms.arm import Arm, Joint, JointKind, Pen, PenHold, Workspace
from planner.arms.coupling_section import CouplingSection, coupling_faults
from planner.arms.file_section import LONGEST_MM, Length, Limit, NotNegative, Number, Section, Size, told
from planner.arms.frame_section import OriginSection, ToolSection
from planner.arms.paper_pose import PaperPose
from planner.arms.rigid_transform import IDENTITY, RigidTransform
from planner.arms.servo_section import (
    SlidingBusSection,
    SlidingServoSection,
    TurningBusSection,
    TurningServoSection,
)
from planner.arrays import FloatArray
from planner.errors import ArmFileError
from planner.settings import DEFAULT_WEIGHTS, ConfigurationWeights

_ROUNDING = 1e-9
"""Degrees that converting to radians and back may cost."""


def _is_column_name(name: str) -> str:
    if not (name.isidentifier() and name.isascii()):
        raise ValueError("must be letters, digits and underscores, and not begin with a digit")
    return name


Name = Annotated[str, Field(max_length=64), AfterValidator(_is_column_name)]
_MOST_JOINTS = 16
_MOST_FAULTS = 20
_Tilt = Annotated[float, Field(ge=-180, le=180)]


class _JointBase(Section):
    name: Name
    theta_deg: Number = 0.0
    d_mm: Length = 0.0
    a_mm: Length = 0.0
    alpha_deg: Number = 0.0
    origin: OriginSection | None = None
    thickness_mm: Size | None = None
    urdf_name: Annotated[str, Field(max_length=200)] | None = None

    @property
    @abstractmethod
    def limits(self) -> tuple[float, float]:
        """Lower and upper, in the unit of the file."""

    @model_validator(mode="after")
    def _limits_are_ordered(self) -> Self:
        minimum, maximum = self.limits
        if minimum >= maximum:
            raise ValueError(f"the lower limit {minimum:g} is not below the upper limit {maximum:g}")
        return self


class _RevoluteSection(_JointBase):
    kind: Literal["revolute"]
    min_deg: Number
    max_deg: Number
    max_velocity_deg_s: Limit
    max_acceleration_deg_s2: Limit
    max_jerk_deg_s3: Limit
    servo: TurningServoSection | None = None
    bus: TurningBusSection | None = None

    @property
    def limits(self) -> tuple[float, float]:
        return self.min_deg, self.max_deg


class _PrismaticSection(_JointBase):
    kind: Literal["prismatic"]
    min_mm: Length
    max_mm: Length
    max_velocity_mm_s: Limit
    max_acceleration_mm_s2: Limit
    max_jerk_mm_s3: Limit
    servo: SlidingServoSection | None = None
    bus: SlidingBusSection | None = None

    @property
    def limits(self) -> tuple[float, float]:
        return self.min_mm, self.max_mm


class _PenSection(Section):
    hold: Literal["coupling", "construction", "tool_axis", "free"]
    tool_axis: Annotated[list[Number], Field(min_length=3, max_length=3)] = Field(default=[1.0, 0.0, 0.0])
    lift_mm: Size
    clearance_mm: Size = 1.0
    speed_mm_s: Limit = 80.0

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if self.clearance_mm > self.lift_mm:
            raise ValueError(f"clearance_mm {self.clearance_mm:g} is above lift_mm {self.lift_mm:g}")
        if self.hold == "tool_axis" and math.hypot(*self.tool_axis) < 1e-9:
            raise ValueError("tool_axis has no direction")
        return self


class _WorkspaceSection(Section):
    inner_radius_mm: Annotated[Length, Field(ge=0)]
    min_tip_speed_mm_s: Limit = 80.0


class _PaperSection(Section):
    x_mm: Number = 0.0
    y_mm: Number = 0.0
    z_mm: Number = 0.0
    yaw_deg: Number = 0.0
    tilt_x_deg: _Tilt = 0.0
    tilt_y_deg: _Tilt = 0.0

    def pose(self) -> PaperPose:
        return PaperPose(
            self.x_mm,
            self.y_mm,
            self.z_mm,
            math.radians(self.yaw_deg),
            math.radians(self.tilt_x_deg),
            math.radians(self.tilt_y_deg),
        )


class _ServosSection(Section):
    set_point_period_ms: Annotated[float, Field(ge=0.1, le=100, allow_inf_nan=False)]


class _AccuracySection(Section):
    marks: Annotated[int, Field(ge=0)]
    tip_mm: NotNegative
    height_mm: NotNegative
    slack: dict[str, NotNegative]


_Weight = Annotated[float, Field(ge=0, le=1e6, allow_inf_nan=False)]


class _ConfigurationsSection(Section):
    time: _Weight = DEFAULT_WEIGHTS.time
    sensitivity: _Weight = DEFAULT_WEIGHTS.sensitivity
    reversals: _Weight = DEFAULT_WEIGHTS.reversals
    limits: _Weight = DEFAULT_WEIGHTS.limits

    @model_validator(mode="after")
    def _weighs_something(self) -> Self:
        if not any((self.time, self.sensitivity, self.reversals, self.limits)):
            raise ValueError("one of time, sensitivity, reversals and limits has to be more than 0")
        return self

    def weights(self) -> ConfigurationWeights:
        return ConfigurationWeights(self.time, self.sensitivity, self.reversals, self.limits)


class _ArmSection(Section):
    name: Name
    source: str
    closed_form: Literal["drawing_arm", "scara", "three_joint", "six_joint", "stanford"] | None = None
    dh: Literal["standard", "modified"] = "standard"
    pen: _PenSection
    workspace: _WorkspaceSection
    joints: Annotated[
        list[Annotated[_RevoluteSection | _PrismaticSection, Field(discriminator="kind")]],
        Field(min_length=1, max_length=_MOST_JOINTS),
    ]
    coupling: list[CouplingSection] = Field(default=[])
    park: dict[str, Number] | None = None
    paper: _PaperSection = _PaperSection()
    tool: ToolSection = ToolSection()
    servos: _ServosSection | None = None
    accuracy: _AccuracySection | None = None
    configurations: _ConfigurationsSection = _ConfigurationsSection()


def arm_of_content(content: dict[str, Any], source: str) -> Arm:
    """The arm of a file's keys and values; `source` is what messages call it. Errors: ArmFileError with all faults."""
    try:
        section = _ArmSection.model_validate(content)
    except ValidationError as error:
        raise ArmFileError(source, _faults(error, content)) from error
    faults = _contradictions(section)
    if faults:
        raise ArmFileError(source, faults)
    arm = _arm(section)
    if section.park is None:
        return arm
    parked = _parked(arm, section.park)
    faults = _beyond_limits(arm, parked)
    if faults:
        raise ArmFileError(source, faults)
    return replace(arm, park=tuple(parked.tolist()))


def _faults(error: ValidationError, content: dict[str, Any]) -> list[str]:
    """What is wrong, fault by fault; those of a joint say its name too, as nobody counts joints from zero."""
    faults = []
    for detail in error.errors(include_url=False)[:_MOST_FAULTS]:
        key, sentence = told(detail)
        place = detail["loc"][1] if detail["loc"][:1] == ("joints",) and len(detail["loc"]) > 1 else None
        section = content["joints"][place] if isinstance(place, int) else None
        name = section.get("name") if isinstance(section, dict) else None
        whose = f", joint {name:.64}" if isinstance(name, str) and name else ""
        faults.append(f"{key}: {sentence}{whose}")
    more = error.error_count() - len(faults)
    return faults + ([f"and {more} more"] if more > 0 else [])


def _contradictions(section: _ArmSection) -> list[str]:
    """Faults that only show when sections are seen together."""
    faults = []
    names = [joint.name for joint in section.joints]
    for index, joint in enumerate(section.joints):
        if names.index(joint.name) != index:
            faults.append(f"joints[{index}].name: '{joint.name}' is used twice")
        if section.dh == "modified" and joint.origin is not None:
            faults.append(f"joints[{index}].origin: not beside dh = 'modified', where a_mm and alpha_deg say it")
    if not faults:
        faults += _without_length(section)
    mimic = [coupling.joint for coupling in section.coupling]
    faults += coupling_faults(section.coupling, {joint.name: JointKind(joint.kind) for joint in section.joints})
    if section.pen.hold == "coupling" and not section.coupling:
        faults.append("pen.hold: 'coupling' needs at least one [[coupling]]")
    faults += _shared_lines(section)
    if section.accuracy is not None:
        faults += [f"accuracy.slack.{name}: missing" for name in names if name not in section.accuracy.slack]
        faults += [
            f"accuracy.slack: there is no joint '{name}' (joints: {', '.join(names)})"
            for name in section.accuracy.slack
            if name not in names
        ]
    if section.park is not None:
        faults += _misparked(section.park, [name for name in names if name not in mimic], names)
    return faults


def _without_length(section: _ArmSection) -> list[str]:
    """Thick links that have no length, and lengths that are no arm's."""
    joints, tool = _joints(section), _tool(section)
    faults = []
    for index, joint in enumerate(joints):
        onwards = joints[index + 1].origin if index + 1 < len(joints) else tool
        turns = joint.kind is JointKind.REVOLUTE
        if joint.thickness_mm is not None and turns and not (joint.d_mm or joint.a_mm or onwards.length_mm):
            faults.append(
                f"joints[{index}]: thickness_mm {joint.thickness_mm:g} is that of no link: d_mm and a_mm are 0,"
                f" joint {joint.name}"
            )
    together_mm = tool.length_mm + sum(joint.length_mm for joint in joints)
    if together_mm > LONGEST_MM:
        faults.append(
            f"joints: their lengths (d_mm, a_mm, origins, the tool and what slides) are {together_mm:g} mm together,"
            f" more than {LONGEST_MM:g} mm"
        )
    return faults


def _shared_lines(section: _ArmSection) -> list[str]:
    """Joints that would be moved by each other's pulses or packets."""
    channels = {
        index: index if joint.servo.channel is None else joint.servo.channel
        for index, joint in enumerate(section.joints)
        if joint.servo is not None
    }
    ids = {index: joint.bus.id for index, joint in enumerate(section.joints) if joint.bus is not None}
    return [
        f"joints[{index}].{key}: {value} is another joint's too"
        for key, values in (("servo.channel", channels), ("bus.id", ids))
        for index, value in values.items()
        if Counter(values.values())[value] > 1
    ]


def _misparked(park: dict[str, float], independent: list[str], names: list[str]) -> list[str]:
    faults = [f"park.{name}: missing" for name in independent if name not in park]
    for name in park:
        if name not in names:
            faults.append(f"park: there is no joint '{name}' (joints: {', '.join(names)})")
        elif name not in independent:
            faults.append(f"park.{name}: follows from its coupling; leave it out")
    return faults


def _joint(place: int, section: _RevoluteSection | _PrismaticSection) -> Joint:
    if isinstance(section, _RevoluteSection):
        unit = math.radians(1.0)
        limits = (
            section.min_deg,
            section.max_deg,
            section.max_velocity_deg_s,
            section.max_acceleration_deg_s2,
            section.max_jerk_deg_s3,
        )
        minimum, maximum, velocity, acceleration, jerk = (math.radians(value) for value in limits)
    else:
        unit = 1.0
        minimum, maximum, velocity, acceleration, jerk = (
            section.min_mm,
            section.max_mm,
            section.max_velocity_mm_s,
            section.max_acceleration_mm_s2,
            section.max_jerk_mm_s3,
        )
    return Joint(
        section.name,
        JointKind(section.kind),
        math.radians(section.theta_deg),
        section.d_mm,
        section.a_mm,
        math.radians(section.alpha_deg),
        minimum,
        maximum,
        velocity,
        acceleration,
        jerk,
        None if section.servo is None else section.servo.servo(place, unit),
        None if section.bus is None else section.bus.servo(unit),
        section.thickness_mm,
        IDENTITY if section.origin is None else section.origin.transform(),
        section.urdf_name,
    )


def _joints(section: _ArmSection) -> tuple[Joint, ...]:
    joints = tuple(_joint(place, joint) for place, joint in enumerate(section.joints))
    return joints if section.dh == "standard" else _standard(joints)


def _standard(joints: tuple[Joint, ...]) -> tuple[Joint, ...]:
    """Modified rows, `Rx(alpha) Tx(a) Rz(theta) Tz(d)`, as standard ones: the a and alpha of a row are those at the end
    of the row before, and those of the first row its origin."""
    first = RigidTransform(x_mm=joints[0].a_mm, roll_rad=joints[0].alpha_rad)
    following = [(joint.a_mm, joint.alpha_rad) for joint in joints[1:]] + [(0.0, 0.0)]
    return tuple(
        replace(joint, a_mm=a_mm, alpha_rad=alpha_rad, origin=IDENTITY if index else first)
        for index, (joint, (a_mm, alpha_rad)) in enumerate(zip(joints, following, strict=True))
    )


def _tool(section: _ArmSection) -> RigidTransform:
    return section.tool.with_pen(_tool_axis(section))


def _tool_axis(section: _ArmSection) -> tuple[float, float, float]:
    """A unit vector; zeros, where the file has them for a pen that is not pointed."""
    x, y, z = section.pen.tool_axis
    length = math.hypot(x, y, z) or 1.0
    return x / length, y / length, z / length


def _arm(section: _ArmSection) -> Arm:
    joints = _joints(section)
    return Arm(
        name=section.name,
        source=section.source,
        joints=joints,
        couplings=tuple(coupling.coupling(joints) for coupling in section.coupling),
        pen=Pen(
            PenHold(section.pen.hold),
            _tool_axis(section),
            section.pen.lift_mm,
            section.pen.clearance_mm,
            section.pen.speed_mm_s,
        ),
        workspace=Workspace(section.workspace.inner_radius_mm, section.workspace.min_tip_speed_mm_s),
        closed_form=section.closed_form,
        paper=section.paper.pose(),
        tool=_tool(section),
        weights=section.configurations.weights(),
        set_point_period_s=None if section.servos is None else section.servos.set_point_period_ms / 1e3,
        accuracy=None if section.accuracy is None else _accuracy(section.accuracy, joints),
    )


def _accuracy(section: _AccuracySection, joints: tuple[Joint, ...]) -> Accuracy:
    return Accuracy(
        section.marks,
        section.tip_mm,
        section.height_mm,
        tuple(section.slack[joint.name] * joint.per_file_unit for joint in joints),
    )


def _parked(arm: Arm, park: dict[str, float]) -> FloatArray:
    """(n_joints,) rad or mm; couplings fill in what they drive."""
    independent = [arm.joints[index] for index in arm.independent_joints]
    return arm.complete(np.array([park[joint.name] * joint.per_file_unit for joint in independent]))


def _beyond_limits(arm: Arm, parked: FloatArray) -> list[str]:
    values, low, high = arm.to_file_units(np.stack((parked, arm.minimum, arm.maximum)))
    return [
        f"park.{joint.name}: {value:g} {joint.file_unit} is outside its limits of {least:g} to {most:g}"
        for joint, value, least, most in zip(arm.joints, values, low, high, strict=True)
        if not least - _ROUNDING <= value <= most + _ROUNDING
    ]
