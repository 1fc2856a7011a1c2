"""LeRobot's calibration of an arm of bus servos: `{"shoulder_pan": {"id": 1, "range_min": 740, ...}, ...}`.

LeRobot counts degrees from the middle of the range that a joint was moved over by hand, which for an SO-101 is the zero
of its URDF. `homing_offset` is kept by the servo itself, whose counts have it in them already. None of this was tried
on an arm.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, Field, TypeAdapter, ValidationError

from planner.arms.arm import Arm, Joint
from planner.errors import ArmFileError

_COUNTS = 4096
_Count = Annotated[int, Field(ge=0, lt=_COUNTS)]


class _Motor(BaseModel):
    id: Annotated[int, Field(ge=0, le=252)]
    drive_mode: Annotated[int, Field(ge=0, le=1)] = 0
    homing_offset: int = 0
    range_min: _Count
    range_max: _Count


_MOTORS = TypeAdapter(dict[str, _Motor])


def with_lerobot_calibration(arm: Arm, source: Path) -> Arm:
    """The arm with ids, zeros and ranges of that file; joints are found by name, motors that are no joints of the arm,
    such as the gripper, are passed over. Errors: ArmFileError."""
    try:
        motors = _MOTORS.validate_json(source.read_bytes())
    except OSError as error:
        raise ArmFileError(str(source), [f"cannot be read: {error.strerror}"]) from error
    except ValidationError as error:
        faults = [f"{'.'.join(map(str, fault['loc'])) or 'file'}: {fault['msg']}" for fault in error.errors()]
        raise ArmFileError(str(source), ["is no calibration of LeRobot", *faults]) from error
    missing = [joint.name for joint in arm.joints if joint.name not in motors]
    if missing:
        raise ArmFileError(str(source), [f"says nothing of joint {name} of arm '{arm.name}'" for name in missing])
    return replace(arm, joints=tuple(_calibrated(arm, joint, motors[joint.name], source) for joint in arm.joints))


def _calibrated(arm: Arm, joint: Joint, motor: _Motor, source: Path) -> Joint:
    bus = joint.bus
    if bus is None:
        raise ArmFileError(f"arm '{arm.name}'", [f"joint {joint.name} is not moved by a servo on a bus"])
    if motor.range_min >= motor.range_max:
        raise ArmFileError(str(source), [f"{joint.name}: range_min is not below range_max"])
    if motor.drive_mode:
        raise ArmFileError(
            str(source), [f"{joint.name}: drive_mode 1, a servo that turns the other way, is not understood"]
        )
    middle = (motor.range_min + motor.range_max) / 2
    moved = replace(bus, id=motor.id, count_at_zero=middle, count_range=(motor.range_min, motor.range_max), curve=None)
    ends = sorted((count - middle) / bus.counts_per_unit for count in (motor.range_min, motor.range_max))
    low, high = max(joint.minimum, ends[0]), min(joint.maximum, ends[1])
    if low >= high:
        raise ArmFileError(str(source), [f"{joint.name}: its range has nothing in common with the limits of the arm"])
    return replace(joint, minimum=low, maximum=high, bus=moved)
