"""Arms whose files were checked by an earlier process: the checker of what files say takes longer to load than the arm
takes to plan with.

What is kept is the arm itself, as JSON. It is made of frozen values, texts, numbers and tuples; each value is written
as a table of its fields that names its type, and numbers come back to the last bit.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import fields
from enum import Enum
from typing import Any

from planner.arms.accuracy import Accuracy
from planner.arms.arm import Arm, BusServo, Coupling, Joint, JointKind, Pen, PenHold, Servo, Workspace
from planner.arms.paper_pose import PaperPose
from planner.arms.rigid_transform import RigidTransform
from planner.kept import kept_text
from planner.settings import ConfigurationWeights

_TYPES: dict[str, type[Any]] = {
    one.__name__: one
    for one in (
        Accuracy,
        Arm,
        BusServo,
        ConfigurationWeights,
        Coupling,
        Joint,
        JointKind,
        PaperPose,
        Pen,
        PenHold,
        RigidTransform,
        Servo,
        Workspace,
    )
}
_TYPE = "type"
"""The key of a table that names what it is of; no field is called so."""


def kept_arm(text: str, checked: Callable[[], Arm]) -> Arm:
    """The arm of a file with that text, which `checked` makes of it where no earlier process has. Errors: those of
    `checked`, and only those: a file with faults is checked each time."""
    return arm_of_json(kept_text(f"arm of {text}", lambda: arm_as_json(checked())))


def arm_as_json(arm: Arm) -> str:
    """From which `arm_of_json` makes an equal arm."""
    return json.dumps(_told(arm))


def arm_of_json(told: str) -> Arm:
    """The arm that `arm_as_json` told of."""
    arm: Arm = _made(json.loads(told))
    return arm


def _told(value: object) -> object:
    name = type(value).__name__
    if isinstance(value, Enum):
        return {_TYPE: name, "value": value.value}
    if name in _TYPES:
        return {_TYPE: name} | {one.name: _told(getattr(value, one.name)) for one in fields(_TYPES[name])}
    return [_told(one) for one in value] if isinstance(value, tuple) else value


def _made(told: Any) -> Any:
    if isinstance(told, dict):
        return _TYPES[told[_TYPE]](**{name: _made(value) for name, value in told.items() if name != _TYPE})
    return tuple(_made(one) for one in told) if isinstance(told, list) else told
