"""The head of a trajectory file: comment lines that say what it is a trajectory of, and where the drawing went."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import pairwise
from pathlib import Path
from typing import IO, Any, NamedTuple

from planner.arms.paper_pose import BASE_PLANE, PaperPose
from planner.counted import counted
from planner.drawing.copies import Copies
from planner.drawing.fill_options import NO_FILL, FillOptions, fill_options
from planner.drawing.image_options import image_options
from planner.drawing.options import AS_A_BROWSER, ReadingOptions
from planner.errors import TrajectoryFileError, UsageError
from planner.pens import GroupBy, colour_of, hex_of
from planner.settings import MOST_COPIES, Timing
from planner.tile import Tile

FORMAT_VERSION = 1
LONGEST_LINE = 1 << 16
MOST_BEYOND_LIMITS = 40.0
"""More than any test motion needs: acceleration that climbs tenfold takes jerk that climbs thirtyfold."""
_PEN = re.compile(r"(#[0-9a-f]{6}) (\S+) (.+)")
_LOWEST_RATE_HZ, _HIGHEST_RATE_HZ = 1e-3, 1e5  # times are written in microseconds


@dataclass(frozen=True, slots=True)
class Placement:
    """Where the drawing went; None for what is not told.

    canvas_mm: near and far side (arm x), right and left side (arm y) of the rectangle that it is within.
    margin_mm: kept free along the sides of that. scale: mm on paper for one on the page.
    rotate_deg: clockwise turn of the page before it is placed. mirror: left and right of the page change places
    before it is turned. copies: where there is more than one; the map is that of the first. tile: the sheet, where the
    drawing is cut into several.
    """

    canvas_mm: tuple[float, float, float, float] | None = None
    margin_mm: float | None = None
    scale: float | None = None
    rotate_deg: float | None = None
    mirror: bool = False
    copies: Copies | None = None
    tile: Tile | None = None

    def without_marks(self) -> Placement:
        """Of what a pen draws that does not draw the register marks."""
        return self if self.tile is None else replace(self, tile=replace(self.tile, marks_mm=()))


@dataclass(frozen=True, slots=True)
class Chosen:
    """What of a drawing is drawn. layers: by name or number; None: all that are to be plotted. by, kinds: of these,
    what is of one of these layers, colours or widths, as `kind_of` tells them; None: all."""

    layers: tuple[str, ...] | None = None
    by: GroupBy | None = None
    kinds: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class PathWork:
    """join_mm: ends that are nearer are joined; None: only where that is within the tolerance. dedup_mm: of lines
    that are nearer, one is drawn; 0: all are. simplify_mm: points are dropped that change a line by less. passes: how
    often each line is drawn."""

    join_mm: float | None = None
    dedup_mm: float = 0.0
    simplify_mm: float = 0.0
    passes: int = 1


@dataclass(frozen=True, slots=True)
class PenInk:
    """A pen by what is seen of it. width_mm: 0 where it is not known. height_mm: how much further its tip sticks out
    than that of the pen in the arm's file."""

    name: str
    colour: tuple[int, int, int]
    width_mm: float
    height_mm: float = 0.0

    def __str__(self) -> str:
        return f"{hex_of(self.colour)} {_shortest(self.width_mm)} {self.name}"


NOTHING_TOLD = Placement()
ALL = Chosen()
NO_WORK = PathWork()


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
    "image": _Form(str, image_options),
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
    reading: ReadingOptions = AS_A_BROWSER
    pens: tuple[PenInk, ...] = ()
    pen_changes: tuple[int, ...] = ()
    chosen: Chosen = ALL
    path_work: PathWork = NO_WORK
    fill: FillOptions = NO_FILL
    beyond_limits: float = 1.0
    timing: Timing = Timing.OPTIMAL

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
        if (copies := placement.copies) is not None:
            steps = f"{_shortest(copies.step_x_mm)} {_shortest(copies.step_y_mm)}"
            entries.append(("copies", f"{copies.columns} {copies.rows} {steps}"))
        if (tile := placement.tile) is not None:
            entries += [
                ("tile", f"{tile.column} {tile.row} {tile.columns} {tile.rows}"),
                ("tile_shift_mm", " ".join(map(_shortest, tile.shift_mm))),
                ("tile_window_mm", " ".join(map(_shortest, tile.window_mm))),
                ("tile_marks_mm", " ".join(_shortest(value) for mark in tile.marks_mm for value in mark)),
            ]
        if self.chosen.layers is not None:
            entries.append(("layers", _list(self.chosen.layers)))
        if self.chosen.by is not None:
            entries.append((f"only_{self.chosen.by}", _list(self.chosen.kinds)))
        entries += [(f"pen_{index}", str(pen)) for index, pen in enumerate(self.pens)]
        if any(pen.height_mm for pen in self.pens):
            entries.append(("pen_heights_mm", " ".join(_shortest(pen.height_mm) for pen in self.pens)))
        if self.pen_changes:
            entries.append(("pen_changes", " ".join(map(str, self.pen_changes))))
        entries += [
            (key, _shortest(value))
            for key, value, usual in (
                ("join_mm", self.path_work.join_mm, None),
                ("dedup_mm", self.path_work.dedup_mm, 0.0),
                ("simplify_mm", self.path_work.simplify_mm, 0.0),
                ("passes", self.path_work.passes, 1),
            )
            if value is not None and value != usual
        ]
        if self.timing is not Timing.OPTIMAL:
            entries.append(("timing", self.timing.value))
        if self.fill != NO_FILL:
            entries.append(("fill", str(self.fill)))
        if self.beyond_limits != 1.0:
            entries.append(("beyond_limits", _shortest(self.beyond_limits)))
        if self.left_out != NOTHING_LEFT_OUT:
            entries += [("left_out_mm", f"{self.left_out.length_mm:.6g}"), ("left_out_taps", str(self.left_out.taps))]
        entries += [
            (field.name, _READING[field.name].text(getattr(self.reading, field.name)))
            for field in fields(ReadingOptions)
            if getattr(self.reading, field.name) != field.default
        ]
        return entries


def _list(names: Sequence[str]) -> str:
    """As JSON in which every space counts: lines of the head have single ones, and no others."""
    return re.sub(" (?= )", r"\\u0020", json.dumps(names))


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
        *_pens(name, found),
        _chosen(name, found),
        _path_work(name, found),
        _fill(name, found),
        _beyond_limits(name, found),
        _timing(name, found),
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
    return Placement(canvas_mm, margin_mm, scale, rotate_deg, mirror == "yes", _copies(name, found), _tile(name, found))


def _copies(name: str, found: Mapping[str, tuple[str, int]]) -> Copies | None:
    if "copies" not in found:
        return None
    columns, rows, step_x_mm, step_y_mm = _numbers(name, found, "copies", 4)
    if columns != int(columns) or rows != int(rows) or min(columns, rows) < 1 or columns * rows > MOST_COPIES:
        raise TrajectoryFileError(
            name,
            found["copies"][1],
            f"'# copies:' are {columns:g} x {rows:g}; wanted whole numbers up to {MOST_COPIES}",
        )
    return Copies(int(columns), int(rows), step_x_mm, step_y_mm)


def _tile(name: str, found: Mapping[str, tuple[str, int]]) -> Tile | None:
    if "tile" not in found:
        return None
    column, row, columns, rows = _numbers(name, found, "tile", 4)
    whole = all(value == int(value) for value in (column, row, columns, rows))
    if not (whole and 1 <= column <= columns and 1 <= row <= rows):
        raise TrajectoryFileError(
            name,
            found["tile"][1],
            f"'# tile:' is '{shown(found['tile'][0])}'; wanted a column and a row, and how many there are of each",
        )
    shift_x, shift_y = _numbers(name, found, "tile_shift_mm", 2)
    near, far, right, left = _numbers(name, found, "tile_window_mm", 4)
    if not (near < far and right < left):
        raise TrajectoryFileError(
            name, found["tile_window_mm"][1], "'# tile_window_mm:' has a far side before the near one, or left of right"
        )
    count = 2 * (len(found.get("tile_marks_mm", ("", 0))[0].split()) // 2)
    marks = _numbers(name, found, "tile_marks_mm", count)
    return Tile(
        int(column),
        int(row),
        int(columns),
        int(rows),
        (shift_x, shift_y),
        (near, far, right, left),
        tuple(zip(marks[::2], marks[1::2], strict=True)),
    )


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


def _pens(name: str, found: Mapping[str, tuple[str, int]]) -> tuple[tuple[PenInk, ...], tuple[int, ...]]:
    """The pens, and the samples at which all but the first are put in."""
    pens: list[PenInk] = []
    while (key := f"pen_{len(pens)}") in found:
        text, line = found[key]
        match = _PEN.fullmatch(text)
        if match is None or not is_number(match[2]):
            raise TrajectoryFileError(name, line, f"'# {key}:' is '{shown(text)}'; wanted a colour, a width and a name")
        pens.append(PenInk(match[3], colour_of(match[1]), float(match[2])))
    if "pen_heights_mm" in found:
        heights_mm = _numbers(name, found, "pen_heights_mm", len(pens))
        pens = [replace(pen, height_mm=height_mm) for pen, height_mm in zip(pens, heights_mm, strict=True)]
    changes: list[int] = []
    if "pen_changes" in found:
        text, line = found["pen_changes"]
        cells = text.split()
        if not all(cell.isdecimal() and len(cell) < 10 for cell in cells):
            raise TrajectoryFileError(name, line, f"'# pen_changes:' is '{shown(text)}'; wanted numbers of samples")
        changes = [int(cell) for cell in cells]
        if any(later <= earlier for earlier, later in pairwise(changes)) or len(changes) != len(pens) - 1:
            raise TrajectoryFileError(
                name, line, f"'# pen_changes:' are {len(changes)} for {len(pens)} pens; wanted one less, in their order"
            )
    elif len(pens) > 1:
        raise TrajectoryFileError(name, found["pen_1"][1], "has several pens and no '# pen_changes:' line")
    return tuple(pens), tuple(changes)


def _chosen(name: str, found: Mapping[str, tuple[str, int]]) -> Chosen:
    layers = _names(name, found, "layers") if "layers" in found else None
    for by in GroupBy:
        if (key := f"only_{by}") in found:
            return Chosen(layers, by, _names(name, found, key))
    return Chosen(layers)


def _timing(name: str, found: Mapping[str, tuple[str, int]]) -> Timing:
    text, line = found.get("timing", (Timing.OPTIMAL.value, None))
    try:
        return Timing(text)
    except ValueError:
        wanted = " or ".join(Timing)
        raise TrajectoryFileError(name, line, f"'# timing:' is '{shown(text)}'; wanted {wanted}") from None


def _fill(name: str, found: Mapping[str, tuple[str, int]]) -> FillOptions:
    if "fill" not in found:
        return NO_FILL
    text, line = found["fill"]
    try:
        return fill_options(text)
    except UsageError as error:
        raise TrajectoryFileError(name, line, f"'# fill:': {error}") from None


def _beyond_limits(name: str, found: Mapping[str, tuple[str, int]]) -> float:
    if "beyond_limits" not in found:
        return 1.0
    (factor,) = _numbers(name, found, "beyond_limits", 1)
    line = found["beyond_limits"][1]
    if not 1.0 <= factor <= MOST_BEYOND_LIMITS:
        raise TrajectoryFileError(
            name, line, f"'# beyond_limits:' is {factor:g}; wanted a factor of 1 to {MOST_BEYOND_LIMITS:g}"
        )
    return factor


def _path_work(name: str, found: Mapping[str, tuple[str, int]]) -> PathWork:
    values = {}
    for key, least in (("join_mm", 0.0), ("dedup_mm", 0.0), ("simplify_mm", 0.0), ("passes", 1.0)):
        if key in found:
            (value,) = _numbers(name, found, key, 1)
            if value < least or (key == "passes" and value != int(value)):
                raise TrajectoryFileError(name, found[key][1], f"'# {key}:' is {value:g}; that cannot be")
            values[key] = value
    return PathWork(
        values.get("join_mm"), values.get("dedup_mm", 0.0), values.get("simplify_mm", 0.0), int(values.get("passes", 1))
    )


def _names(name: str, found: Mapping[str, tuple[str, int]], key: str) -> tuple[str, ...]:
    text, line = found[key]
    try:
        names = json.loads(text)
    except ValueError:
        names = None
    if not isinstance(names, list) or not names or not all(isinstance(one, str) for one in names):
        raise TrajectoryFileError(name, line, f"'# {key}:' is '{shown(text)}'; wanted a JSON list of names")
    return tuple(names)


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
