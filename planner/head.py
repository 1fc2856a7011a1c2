"""The head of a trajectory file: comment lines that say what it is a trajectory of, and where the drawing went."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import IO, Any, NamedTuple

from planner.arms.paper_pose import BASE_PLANE, PaperPose
from planner.counted import counted
from planner.drawing.options import ReadingOptions
from planner.errors import TrajectoryFileError, UsageError

FORMAT_VERSION = 1
LONGEST_LINE = 1 << 16
_LOWEST_RATE_HZ, _HIGHEST_RATE_HZ = 1e-3, 1e5  # times are written in microseconds


@dataclass(frozen=True, slots=True)
class Placement:
    """Where the drawing went; None for what is not told.

    canvas_mm: near and far side (arm x), right and left side (arm y) of the rectangle that it is within.
    margin_mm: kept free along the sides of that. scale: mm on paper for one on the page.
    rotate_deg: clockwise turn of the page before it is placed. mirror: left and right of the page change places
    before it is turned.
    """

    canvas_mm: tuple[float, float, float, float] | None = None
    margin_mm: float | None = None
    scale: float | None = None
    rotate_deg: float | None = None
    mirror: bool = False


NOTHING_TOLD = Placement()


@dataclass(frozen=True, slots=True)
class LeftOut:
    """What of the drawing was not drawn on purpose: a length of line, and taps."""

    length_mm: float = 0.0
    taps: int = 0

    def __str__(self) -> str:
        return f"{self.length_mm:.1f} mm" + (f" and {counted(self.taps, 'tap')}" if self.taps else "")

    def __add__(self, other: LeftOut) -> LeftOut:
        return LeftOut(self.length_mm + other.length_mm, self.taps + other.taps)


NOTHING_LEFT_OUT = LeftOut()


class _Form(NamedTuple):
    """How a value is written, and read. Errors of reading: ValueError."""

    text: Callable[[Any], str]
    value: Callable[[str], object]


def _is_yes(text: str) -> bool:
    if text not in ("yes", "no"):
        raise ValueError("wanted yes or no")
    return text == "yes"


_READING = {
    "text": _Form(str, str),
    "font": _Form(str, Path),
    "crop": _Form(str, str),
    "occlude": _Form(lambda value: "yes" if value else "no", _is_yes),
    "dpi": _Form(lambda value: _shortest(value), float),
}
"""The keys that say how the drawing was read, those of `ReadingOptions`; the usual values are not written."""


@dataclass(frozen=True, slots=True)
class Head:
    """What the comment lines say; the fields are those of `Trajectory`."""

    arm: str
    drawing: str
    method: str
    rate_hz: float
    duration_s: float
    svg_to_arm_mm: tuple[float, float, float, float, float, float]
    placement: Placement
    left_out: LeftOut
    paper: PaperPose
    reading: ReadingOptions

    def text(self) -> str:
        """The comment lines."""
        return "".join(f"# {key}: {' '.join(value.split())}\n" for key, value in self._entries())

    @property
    def n_lines(self) -> int:
        """How many lines that is."""
        return len(self._entries())

    def _entries(self) -> list[tuple[str, str]]:
        placement = self.placement
        entries = [
            ("trajectory", str(FORMAT_VERSION)),
            ("arm", self.arm),
            ("drawing", self.drawing),
            ("method", self.method),
            ("rate_hz", _shortest(self.rate_hz)),
            ("duration_s", f"{self.duration_s:.9g}"),
            ("svg_to_arm_mm", " ".join(repr(float(value)) for value in self.svg_to_arm_mm)),
        ]
        if not self.paper.is_base_plane:
            entries.append(("paper", _pose(self.paper)))
        if placement.canvas_mm is not None:
            entries.append(("canvas_mm", " ".join(map(_shortest, placement.canvas_mm))))
        entries += [
            (key, _shortest(value))
            for key, value in (
                ("margin_mm", placement.margin_mm),
                ("scale", placement.scale),
                ("rotate_deg", placement.rotate_deg),
            )
            if value is not None
        ]
        if placement.mirror:
            entries.append(("mirror", "yes"))
        if self.left_out != NOTHING_LEFT_OUT:
            entries += [("left_out_mm", f"{self.left_out.length_mm:.6g}"), ("left_out_taps", str(self.left_out.taps))]
        entries += [
            (field.name, _READING[field.name].text(getattr(self.reading, field.name)))
            for field in fields(ReadingOptions)
            if getattr(self.reading, field.name) != field.default
        ]
        return entries


def _pose(paper: PaperPose) -> str:
    """x, y, z in mm, then yaw and the tilts about x and y in degrees."""
    angles = (math.degrees(angle) for angle in (paper.yaw_rad, paper.tilt_x_rad, paper.tilt_y_rad))
    return " ".join(f"{value:.9g}" for value in (paper.x_mm, paper.y_mm, paper.z_mm, *angles))


def _shortest(value: float) -> str:
    return repr(float(value)).removesuffix(".0")


def read_head(name: str, file: IO[str]) -> tuple[Head, str, int]:
    """What the comment lines of the file of that name say, the line after them, and its number. Keys that are not
    known are passed over. Errors: TrajectoryFileError with the line."""
    found: dict[str, tuple[str, int]] = {}
    number = 1
    while (line := file.readline(LONGEST_LINE)).startswith("#"):
        key, separator, value = line[1:].partition(":")
        if separator:
            found[key.strip()] = value.strip(), number
        number += 1
    version, version_line = found.get("trajectory", (None, 1))
    if version is None:
        raise TrajectoryFileError(name, 1, "does not begin as a trajectory (no '# trajectory: 1' line)")
    if version != str(FORMAT_VERSION):
        raise TrajectoryFileError(
            name, version_line, f"is of format '{shown(version)}'; this planner reads format {FORMAT_VERSION}"
        )
    rate_hz = _numbers(name, found, "rate_hz", 1)[0]
    if not _LOWEST_RATE_HZ <= rate_hz <= _HIGHEST_RATE_HZ:
        raise TrajectoryFileError(
            name,
            found["rate_hz"][1],
            f"rate_hz is {rate_hz:g}; it has to be from {_LOWEST_RATE_HZ:g} to {_HIGHEST_RATE_HZ:g}",
        )
    duration_s = _numbers(name, found, "duration_s", 1)[0]
    a, b, c, d, e, f = _numbers(name, found, "svg_to_arm_mm", 6)
    if not line:
        raise TrajectoryFileError(name, max(number - 1, 1), "ends before its column names")
    paper = BASE_PLANE
    if "paper" in found:
        x, y, z, *angles = _numbers(name, found, "paper", 6)
        paper = PaperPose(x, y, z, *map(math.radians, angles))
    texts = {key: value for key, (value, _) in found.items()}
    head = Head(
        texts.get("arm", ""),
        texts.get("drawing", ""),
        texts.get("method", ""),
        rate_hz,
        duration_s,
        (a, b, c, d, e, f),
        _placement(name, found),
        _left_out(name, found),
        paper,
        _reading(name, found),
    )
    return head, line, number


def _placement(name: str, found: Mapping[str, tuple[str, int]]) -> Placement:
    canvas_mm = None
    if "canvas_mm" in found:
        near, far, right, left = _numbers(name, found, "canvas_mm", 4)
        canvas_mm = near, far, right, left
    margin_mm, scale, rotate_deg = (
        _numbers(name, found, key, 1)[0] if key in found else None for key in ("margin_mm", "scale", "rotate_deg")
    )
    mirror, line = found.get("mirror", ("no", None))
    if mirror not in ("yes", "no"):
        raise TrajectoryFileError(name, line, f"'# mirror:' is '{shown(mirror)}'; wanted yes or no")
    return Placement(canvas_mm, margin_mm, scale, rotate_deg, mirror == "yes")


def _left_out(name: str, found: Mapping[str, tuple[str, int]]) -> LeftOut:
    length_mm, taps = (
        _numbers(name, found, key, 1)[0] if key in found else 0.0 for key in ("left_out_mm", "left_out_taps")
    )
    for key, value, is_sound in (
        ("left_out_mm", length_mm, length_mm >= 0),
        ("left_out_taps", taps, taps >= 0 and taps == int(taps)),
    ):
        if not is_sound:
            raise TrajectoryFileError(
                name,
                found[key][1],
                f"'# {key}:' is {value:g}; less than nothing, or a part of a tap, cannot be left out",
            )
    return LeftOut(length_mm, int(taps))


def _reading(name: str, found: Mapping[str, tuple[str, int]]) -> ReadingOptions:
    told: dict[str, Any] = {}
    for key, form in _READING.items():
        if key in found:
            text, line = found[key]
            try:
                told[key] = form.value(text)
                ReadingOptions(**{"text": "outline", key: told[key]})  # a font needs outlines
            except (UsageError, ValueError) as error:
                raise TrajectoryFileError(name, line, f"'# {key}:' is '{shown(text)}': {error}") from None
    try:
        return ReadingOptions(**told)
    except UsageError as error:
        raise TrajectoryFileError(name, None, str(error)) from None


def _numbers(name: str, found: Mapping[str, tuple[str, int]], key: str, count: int) -> list[float]:
    if key not in found:
        raise TrajectoryFileError(name, None, f"has no '# {key}:' line")
    text, line = found[key]
    cells = text.split()
    if len(cells) != count or not all(map(is_number, cells)):
        raise TrajectoryFileError(name, line, f"'# {key}:' is '{shown(text)}'; wanted {count} number(s)")
    return [float(cell) for cell in cells]


def is_number(text: str) -> bool:
    """Whether a cell is a finite number as a file may hold it."""
    try:
        return math.isfinite(float(text)) and text.isascii() and "_" not in text
    except ValueError:
        return False


def shown(text: str) -> str:
    """A part of a file as it may stand in a message: short, and without characters that upset a terminal."""
    return "".join(character if character.isprintable() else "?" for character in text[:60])
