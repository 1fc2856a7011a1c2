"""A robot description (URDF) as it is written: its links, its joints, and what each joint says of itself.

The file is read by expat, with all that could make it fetch or grow refused. Nothing deeper than a joint's own elements
is kept, so that meshes, inertias and what simulators add cost nothing.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn
from xml.parsers import expat

from planner.errors import ArmFileError

_MOST_BYTES = 64_000_000
_OTHER_FORMATS = {"sdf": "SDF", "mujoco": "MJCF", "COLLADA": "COLLADA"}
_EXPAND = "is xacro, which URDF is made of: expand it first, with xacro FILE.xacro > robot.urdf"


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """parts: the attributes of its elements (`origin`, `axis`, `limit`, `mimic`, ...). line: in the file, from 1."""

    name: str
    kind: str
    parent: str
    child: str
    line: int
    parts: Mapping[str, Mapping[str, str]]


@dataclass(frozen=True, eq=False, slots=True)
class Robot:
    """source: what messages call the file. links: in the order of the file."""

    source: str
    name: str
    links: tuple[str, ...]
    joints: tuple[UrdfJoint, ...]

    def refuse(self, reason: str) -> NoReturn:
        raise ArmFileError(self.source, [reason])

    def numbers(self, joint: UrdfJoint, part: str, key: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """As many finite numbers as the default has. Errors: ArmFileError."""
        text = joint.parts.get(part, {}).get(key)
        if text is None:
            return default
        try:
            values = tuple(float(word) for word in text.split())
        except ValueError:
            values = ()
        if len(values) != len(default) or not all(map(math.isfinite, values)):
            count = f"{len(default)} numbers" if len(default) > 1 else "a number"
            self.refuse(f'joint {joint.name} in line {joint.line}: {part} {key}="{text[:60]}" has to be {count}')
        return values

    def number(self, joint: UrdfJoint, part: str, key: str, default: float) -> float:
        return self.numbers(joint, part, key, (default,))[0]


def read_urdf(source: Path) -> Robot:
    """Errors: ArmFileError, with what to do where the file is of another format."""
    name = str(source)
    try:
        with source.open("rb") as file:
            data = file.read(_MOST_BYTES + 1)
    except OSError as error:
        raise ArmFileError(name, [f"cannot be read: {error.strerror or error}"]) from error
    if len(data) > _MOST_BYTES:
        raise ArmFileError(name, [f"is no robot description: it has more than {_MOST_BYTES} bytes"])
    reader = _Reader(name)
    try:
        reader.parser.Parse(data, True)
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code) or "unknown fault"
        raise ArmFileError(name, [f"is not well-formed XML: {reason} in line {error.lineno}"]) from None
    except (LookupError, ValueError) as error:
        raise ArmFileError(name, [f"is not readable XML: {' '.join(str(error).split())}"]) from None
    return reader.robot()


@dataclass(slots=True)
class _Joint:
    attributes: Mapping[str, str]
    line: int
    parts: dict[str, Mapping[str, str]] = field(default_factory=dict)


class _Reader:
    def __init__(self, source: str) -> None:
        self._source = source
        self._depth = 0
        self._name = ""
        self._links: list[str] = []
        self._joints: list[_Joint] = []
        self._within: _Joint | None = None
        self.parser = parser = expat.ParserCreate()
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.EntityDeclHandler = self._entity

    def _refuse(self, reason: str) -> NoReturn:
        raise ArmFileError(self._source, [reason])

    def _entity(self, name: str, *_: object) -> NoReturn:
        self._refuse(f"declares an entity, {name[:40]}, which no robot description needs: write out what it stands for")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        line = self.parser.CurrentLineNumber
        if tag.startswith("xacro:") or any("${" in value or "$(" in value for value in attributes.values()):
            self._refuse(f"line {line}: {_EXPAND}")
        if self._depth == 0:
            self._enter(tag, attributes)
        elif self._depth == 1 and tag == "link":
            self._links.append(attributes.get("name", ""))
        elif self._depth == 1 and tag == "joint":
            self._within = _Joint(attributes, line)
            self._joints.append(self._within)
        elif self._depth == 2 and self._within is not None:
            self._within.parts.setdefault(tag, attributes)
        self._depth += 1

    def _end(self, _: str) -> None:
        self._depth -= 1
        if self._depth == 1:
            self._within = None

    def _enter(self, tag: str, attributes: dict[str, str]) -> None:
        if tag != "robot":
            other = _OTHER_FORMATS.get(tag)
            what = f"is {other}" if other else f"is no robot description: its outermost element is <{tag[:40]}>"
            self._refuse(f"{what}; URDF, whose outermost element is <robot>, is read")
        self._name = attributes.get("name", "")

    def robot(self) -> Robot:
        if not self._links:
            self._refuse("is a robot description without links")
        joints = []
        for joint in self._joints:
            parent, child = (joint.parts.get(end, {}).get("link", "") for end in ("parent", "child"))
            name, kind = (joint.attributes.get(key, "") for key in ("name", "type"))
            joints.append(UrdfJoint(name, kind, parent, child, joint.line, joint.parts))
        return Robot(self._source, self._name, tuple(self._links), tuple(joints))
