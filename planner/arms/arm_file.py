"""Arm files: `configs/NAME.toml`, in degrees, millimetres and seconds, checked whole before use."""

from __future__ import annotations

import math
import tomllib
from abc import abstractmethod
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError, model_validator

from planner.arms.arm import Arm, Coupling, Joint, JointKind, Pen, PenHold, Servo, Workspace
from planner.errors import ArmFileError, UnknownArm

DEFAULT_ARM = "drawing_arm"

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Number = Annotated[float, Field(allow_inf_nan=False)]


def _is_column_name(name: str) -> str:
    if not (name.isidentifier() and name.isascii()):
        raise ValueError("must be letters, digits and underscores, and not begin with a digit")
    return name


def _ascending(pulses_us: list[float]) -> list[float]:
    if pulses_us[0] >= pulses_us[1]:
        raise ValueError(f"{pulses_us[0]:g} is not below {pulses_us[1]:g}")
    return pulses_us


Name = Annotated[str, AfterValidator(_is_column_name)]
PulseRange = Annotated[list[Positive], Field(min_length=2, max_length=2), AfterValidator(_ascending)]


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class _ServoSection(_Section):
    pulse_at_zero_us: Number
    us_per_deg: Number
    pulse_range_us: PulseRange
    resolution_us: NotNegative = 1.0
    dead_band_us: NotNegative = 0.0
    backlash_deg: NotNegative = 0.0


class _JointBase(_Section):
    name: Name
    theta_deg: Number = 0.0
    d_mm: Number = 0.0
    a_mm: Number = 0.0
    alpha_deg: Number = 0.0
    servo: _ServoSection | None = None
    thickness_mm: Positive | None = None

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
    max_velocity_deg_s: Positive
    max_acceleration_deg_s2: Positive
    max_jerk_deg_s3: Positive

    @property
    def limits(self) -> tuple[float, float]:
        return self.min_deg, self.max_deg

    @model_validator(mode="after")
    def _what_is_thick_has_length(self) -> Self:
        if self.thickness_mm is not None and self.d_mm == 0 and self.a_mm == 0:
            raise ValueError(f"thickness_mm {self.thickness_mm:g} is that of no link: d_mm and a_mm are 0")
        return self


class _PrismaticSection(_JointBase):
    kind: Literal["prismatic"]
    min_mm: Number
    max_mm: Number
    max_velocity_mm_s: Positive
    max_acceleration_mm_s2: Positive
    max_jerk_mm_s3: Positive

    @property
    def limits(self) -> tuple[float, float]:
        return self.min_mm, self.max_mm


class _CouplingSection(_Section):
    joint: str
    constant_deg: Number
    coefficients: dict[str, Number]


class _PenSection(_Section):
    hold: Literal["coupling", "construction", "tool_axis", "free"]
    tool_axis: Annotated[list[Number], Field(min_length=3, max_length=3)] = Field(default=[1.0, 0.0, 0.0])
    lift_mm: Positive
    clearance_mm: Positive = 1.0

    @model_validator(mode="after")
    def _is_consistent(self) -> Self:
        if self.clearance_mm > self.lift_mm:
            raise ValueError(f"clearance_mm {self.clearance_mm:g} is above lift_mm {self.lift_mm:g}")
        if self.hold == "tool_axis" and math.hypot(*self.tool_axis) < 1e-9:
            raise ValueError("tool_axis has no direction")
        return self


class _WorkspaceSection(_Section):
    inner_radius_mm: NotNegative
    min_tip_speed_mm_s: Positive = 80.0


class _ArmSection(_Section):
    name: Name
    source: str
    closed_form: Literal["drawing_arm", "scara", "three_joint", "six_joint", "stanford"] | None = None
    pen: _PenSection
    workspace: _WorkspaceSection
    joints: Annotated[
        list[Annotated[_RevoluteSection | _PrismaticSection, Field(discriminator="kind")]], Field(min_length=1)
    ]
    coupling: list[_CouplingSection] = []


def arms_folder() -> Path:
    """Where the arm files live: inside the installed package, or at the top of a checkout."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "configs"
    return installed if installed.is_dir() else package.parent / "configs"


def known_arms() -> tuple[str, ...]:
    """Names of the arms that come with the planner, sorted."""
    return tuple(sorted(path.stem for path in arms_folder().glob("*.toml")))


def load_arm(name_or_file: str) -> Arm:
    """The arm of that name, or of that file if it ends in `.toml`.

    Errors: UnknownArm, ArmFileError (which lists every fault in the file).
    """
    if name_or_file.endswith(".toml"):
        return read_arm_file(Path(name_or_file))
    if name_or_file not in known_arms():
        raise UnknownArm(name_or_file, known_arms())
    return read_arm_file(arms_folder() / f"{name_or_file}.toml")


def read_arm_file(path: Path) -> Arm:
    """Read, check and convert one arm file. Errors: ArmFileError with all faults."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ArmFileError(str(path), [f"cannot be read: {error.strerror}"]) from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ArmFileError(str(path), [f"is not TOML: {error}"]) from error
    except RecursionError as error:
        raise ArmFileError(str(path), ["is not an arm: its values are nested too deeply"]) from error
    try:
        section = _ArmSection.model_validate(content)
    except ValidationError as error:
        raise ArmFileError(str(path), [_fault(detail) for detail in error.errors()]) from error
    faults = _contradictions(section)
    if faults:
        raise ArmFileError(str(path), faults)
    return _arm(section)


def _fault(detail: Any) -> str:
    """One pydantic complaint as `key: what is wrong (value)`."""
    key = ""
    for part in detail["loc"]:
        if part in ("revolute", "prismatic"):  # the union's tag, which is no key of the file
            continue
        key += f"[{part}]" if isinstance(part, int) else (f".{part}" if key else str(part))
    message = {"extra_forbidden": "unknown key", "missing": "missing"}.get(detail["type"], detail["msg"])
    message = message.removeprefix("Value error, ")
    # A whole section says less than what is wrong with it.
    is_section = isinstance(detail["input"], dict | BaseModel)
    return f"{key}: {message}" + ("" if is_section else f" (value: {detail['input']!r:.60})")


def _contradictions(section: _ArmSection) -> list[str]:
    """Faults that only show when sections are seen together."""
    faults = []
    names = [joint.name for joint in section.joints]
    for index, joint in enumerate(section.joints):
        if names.index(joint.name) != index:
            faults.append(f"joints[{index}].name: '{joint.name}' is used twice")
    driven = [coupling.joint for coupling in section.coupling]
    for index, coupling in enumerate(section.coupling):
        key = f"coupling[{index}]"
        for name in (coupling.joint, *coupling.coefficients):
            if name not in names:
                faults.append(f"{key}: there is no joint '{name}' (joints: {', '.join(names)})")
            elif section.joints[names.index(name)].kind != "revolute":
                faults.append(f"{key}: joint '{name}' is prismatic; couplings hold between revolute joints")
        if driven.index(coupling.joint) != index:
            faults.append(f"{key}.joint: '{coupling.joint}' is driven by two couplings")
        faults += [f"{key}.coefficients: '{name}' is itself driven by a coupling"
                   for name in coupling.coefficients if name in driven]
    if section.pen.hold == "coupling" and not section.coupling:
        faults.append("pen.hold: 'coupling' needs at least one [[coupling]]")
    return faults


def _joint(section: _RevoluteSection | _PrismaticSection) -> Joint:
    if isinstance(section, _RevoluteSection):
        limits = (section.min_deg, section.max_deg, section.max_velocity_deg_s,
                  section.max_acceleration_deg_s2, section.max_jerk_deg_s3)
        minimum, maximum, velocity, acceleration, jerk = (math.radians(value) for value in limits)
    else:
        minimum, maximum, velocity, acceleration, jerk = (
            section.min_mm, section.max_mm, section.max_velocity_mm_s,
            section.max_acceleration_mm_s2, section.max_jerk_mm_s3)
    servo = None
    if section.servo is not None:
        low, high = section.servo.pulse_range_us
        servo = Servo(section.servo.pulse_at_zero_us, section.servo.us_per_deg, (low, high),
                      section.servo.resolution_us, section.servo.dead_band_us, section.servo.backlash_deg)
    return Joint(section.name, JointKind(section.kind), math.radians(section.theta_deg), section.d_mm,
                 section.a_mm, math.radians(section.alpha_deg), minimum, maximum, velocity, acceleration,
                 jerk, servo, section.thickness_mm)


def _arm(section: _ArmSection) -> Arm:
    names = [joint.name for joint in section.joints]
    couplings = tuple(
        Coupling(names.index(coupling.joint), math.radians(coupling.constant_deg),
                 tuple((names.index(name), value) for name, value in coupling.coefficients.items()))
        for coupling in section.coupling
    )
    length = math.hypot(*section.pen.tool_axis)
    x, y, z = (component / length if length else component for component in section.pen.tool_axis)
    return Arm(
        name=section.name,
        source=section.source,
        joints=tuple(_joint(joint) for joint in section.joints),
        couplings=couplings,
        pen=Pen(PenHold(section.pen.hold), (x, y, z), section.pen.lift_mm, section.pen.clearance_mm),
        workspace=Workspace(section.workspace.inner_radius_mm, section.workspace.min_tip_speed_mm_s),
        closed_form=section.closed_form,
    )
