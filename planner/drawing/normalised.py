"""Outlines from normalised SVG: nested groups and paths of absolute M, L, C, Q and Z."""

from __future__ import annotations

import hashlib
import re
from array import array
from collections import Counter
from dataclasses import dataclass
from xml.parsers import expat

import numpy as np

from planner.affine import compose
from planner.arrays import BoolArray, FloatArray, frozen
from planner.drawing.drawing import Outline
from planner.drawing.rewrite import PLACEHOLDERS
from planner.errors import DrawingError

# Beyond this a coordinate is a mistake, and the normaliser clamps numbers at 2^31.
LARGEST_COORDINATE = 1e9
CURVE_LIMIT = 2_500_000
SUBPATH_LIMIT = 250_000
REPEAT_LIMIT = 10
"""How often the same line is drawn over itself: a few times make it darker, more wear the paper through, and are a
slip of the program that wrote the file."""
_TOKEN = re.compile(r"\S+")
_URL = re.compile(r"url\(#(.*)\)")
_IDENTITY = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
_NOTHING = (np.inf, np.inf, -np.inf, -np.inf)
Box = tuple[float, float, float, float]


@dataclass(frozen=True, eq=False, slots=True)
class NormalisedSvg:
    """outlines: visible subpaths in user units, document order. root: attributes of the outermost `svg`.
    skipped: what is rendered but cannot be drawn, by kind.
    """

    outlines: tuple[Outline, ...]
    root: dict[str, str]
    skipped: Counter[str]


def read_normalised(data: bytes, source: str) -> NormalisedSvg:
    """Parse the result of the normaliser. Errors: DrawingError where it has more curves or subpaths than the limits."""
    reader = _Reader(source)
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows is found where it would be drawn
        reader.parser.Parse(data, True)
    return NormalisedSvg(tuple(reader.outlines), reader.root, reader.skipped)


@dataclass(slots=True)
class _Group:
    """An open group: `to_user` (2, 3), whether it is visible, its clip, and the box of what it drew so far.

    The box is in the units of the innermost group with a clip, to which `user_to_clip` leads; without one, none is
    kept.
    """

    to_user: FloatArray
    is_visible: bool
    clip: str | None
    user_to_clip: FloatArray | None
    box: Box


class _Reader:
    def __init__(self, source: str) -> None:
        self._source = source
        self._n_curves = self._n_subpaths = 0
        self._times_drawn: Counter[bytes] = Counter()
        self.outlines: list[Outline] = []
        self.root: dict[str, str] = {}
        self.skipped: Counter[str] = Counter()
        self._groups: list[_Group] = []
        self._defs_depth = 0
        self._clip_id: str | None = None
        self._clip_boxes: dict[str, Box | None] = {}
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._start
        self.parser.EndElementHandler = self._end

    def _start(self, name: str, attributes: dict[str, str]) -> None:
        if self._defs_depth:
            self._defs_depth += 1
            self._note_clip(name, attributes)
        elif name == "defs":
            self._defs_depth = 1
        elif name == "svg":
            self.root = attributes
            self._groups.append(_Group(_IDENTITY, True, None, None, _NOTHING))
        else:
            self._open(name, attributes)

    def _open(self, name: str, attributes: dict[str, str]) -> None:
        parent = self._groups[-1]
        to_user = parent.to_user
        if "transform" in attributes:
            to_user = compose(to_user, _matrix(attributes["transform"]))
        is_visible = (
            parent.is_visible
            and float(attributes.get("opacity", 1.0)) > 0.0
            and attributes.get("visibility", "visible") == "visible"
        )
        clip = _URL.fullmatch(attributes.get("clip-path", ""))
        user_to_clip = _inverse(to_user) if clip else parent.user_to_clip
        group = _Group(to_user, is_visible, clip[1] if clip else None, user_to_clip, _NOTHING)
        self._groups.append(group)
        if not is_visible:
            return
        if "mask" in attributes:
            self.skipped["mask"] += 1
        if name == "path":
            self._draw(attributes, group)
        elif name == "image":
            self.skipped[_placeholder_kind(attributes)] += 1

    def _end(self, name: str) -> None:
        if self._defs_depth:
            self._defs_depth -= 1
            if name == "clipPath":
                self._clip_id = None
            return
        group = self._groups.pop()
        if group.box == _NOTHING:
            return
        box = group.box
        parent = self._groups[-1]
        if group.clip is not None:
            if not _contains(self._clip_boxes.get(group.clip), box):
                self.skipped["clip path"] += 1
            if parent.user_to_clip is None:
                return
            to_parent = compose(parent.user_to_clip, group.to_user)
            corners = np.array([(x, y) for x in box[::2] for y in box[1::2]])
            box = _box(corners @ to_parent[:, :2].T + to_parent[:, 2])
        parent.box = _union(parent.box, box)

    def _draw(self, attributes: dict[str, str], group: _Group) -> None:
        fill, stroke = attributes.get("fill", "#000000"), attributes.get("stroke", "none")
        is_filled = fill != "none" and float(attributes.get("fill-opacity", 1.0)) > 0.0
        is_stroked = stroke != "none" and float(attributes.get("stroke-opacity", 1.0)) > 0.0
        if not is_filled and not is_stroked:
            return
        data = attributes.get("d", "")
        self._count(data)
        found = []
        for curves in _subpaths(data):
            beziers = frozen(curves @ group.to_user[:, :2].T + group.to_user[:, 2])
            if not np.all(np.abs(beziers) < LARGEST_COORDINATE):
                self.skipped["path with unusable numbers"] += 1
                continue
            mark = hashlib.blake2b(beziers.data, digest_size=16).digest()
            self._times_drawn[mark] += 1
            if self._times_drawn[mark] > REPEAT_LIMIT:
                self.skipped[f"repeats of a line that is there {REPEAT_LIMIT} times"] += 1
                continue
            found.append(Outline(beziers))
            if group.user_to_clip is not None:
                points = beziers @ group.user_to_clip[:, :2].T + group.user_to_clip[:, 2]
                group.box = _union(group.box, _box(points.reshape(-1, 2)))
        if found and is_stroked and "stroke-dasharray" in attributes:
            self.skipped["dash pattern"] += 1
        self.outlines.extend(found)

    def _count(self, data: str) -> None:
        """Count curves and subpaths before they take memory."""
        self._n_subpaths += data.count("M")
        self._n_curves += sum(map(data.count, "LCQZ"))
        for count, limit, what in (
            (self._n_subpaths, SUBPATH_LIMIT, "subpaths"),
            (self._n_curves, CURVE_LIMIT, "lines and curves"),
        ):
            if count > limit:
                raise DrawingError(self._source, f"more than {limit} {what} (split it into several drawings)")

    def _note_clip(self, name: str, attributes: dict[str, str]) -> None:
        """Remember the box of a clip path that is one plain rectangle, in the units of the clipped group."""
        if name == "clipPath":
            self._clip_id = attributes.get("id")
            if self._clip_id is not None and set(attributes) > {"id"}:
                self._clip_boxes[self._clip_id] = None
        elif self._clip_id is not None:
            is_first = self._clip_id not in self._clip_boxes
            is_plain = name == "path" and not {"transform", "clip-path"} & set(attributes)
            self._clip_boxes[self._clip_id] = _rectangle(attributes.get("d", "")) if is_first and is_plain else None


def _contains(clip: Box | None, box: Box) -> bool:
    """Whether a rectangular clip, such as that of a nested `svg` or a marker, cuts nothing off."""
    if clip is None:
        return False
    slack = 1e-6 * max(clip[2] - clip[0], clip[3] - clip[1])
    return (
        clip[0] - slack <= box[0]
        and clip[1] - slack <= box[1]
        and box[2] <= clip[2] + slack
        and box[3] <= clip[3] + slack
    )


def _box(points: FloatArray) -> Box:
    (left, top), (right, bottom) = points.min(axis=0), points.max(axis=0)
    return float(left), float(top), float(right), float(bottom)


def _inverse(affine: FloatArray) -> FloatArray:
    """The affine (2, 3) that undoes `affine`; something of the kind where it squeezes everything to a line."""
    if not np.isfinite(affine).all():
        return np.full((2, 3), np.nan)
    linear = np.linalg.pinv(affine[:, :2])
    return np.column_stack([linear, -linear @ affine[:, 2]])


def _placeholder_kind(attributes: dict[str, str]) -> str:
    reference = next((value for key, value in attributes.items() if key.endswith("href")), "")
    return PLACEHOLDERS.get(reference.rpartition(",")[2].strip(), "image")


def _union(one: Box, other: Box) -> Box:
    return (min(one[0], other[0]), min(one[1], other[1]), max(one[2], other[2]), max(one[3], other[3]))


def _matrix(text: str) -> FloatArray:
    """`matrix(a b c d e f)` as [[a, c, e], [b, d, f]]."""
    values = text[text.index("(") + 1 : text.index(")")].split()
    return np.array([float(value) for value in values]).reshape(3, 2).T


def _rectangle(data: str) -> Box | None:
    """The box of path data that is one closed axis-aligned rectangle."""
    subpaths = _subpaths(data)
    if len(subpaths) != 1 or len(subpaths[0]) != 4:
        return None
    points = subpaths[0].reshape(-1, 2)
    box = _box(points)
    is_on_border = np.any((points == box[:2]) | (points == box[2:]), axis=1)
    return box if np.all(is_on_border) else None


def _subpaths(data: str) -> list[FloatArray]:
    """Cubics (n, 4, 2) of each subpath: closed with a line where Z needs one, four equal points for a dot."""
    subpaths = []
    # Typed arrays and an iterator: a path may hold millions of numbers.
    tokens = (match[0] for match in _TOKEN.finditer(data))
    flat = array("d")
    is_line = bytearray()
    x = y = start_x = start_y = 0.0

    def finish() -> None:
        if flat:
            subpaths.append(_curves(flat, is_line))
            del flat[:]
            is_line.clear()

    for letter in tokens:
        if letter == "M":
            finish()
            x = start_x = float(next(tokens))
            y = start_y = float(next(tokens))
            continue
        if letter == "Z":
            if not flat or (x, y) != (start_x, start_y):
                flat.extend((x, y, x, y, start_x, start_y, start_x, start_y))
                is_line.append(True)
            finish()
            x, y = start_x, start_y
            continue
        if letter == "L":
            end_x, end_y = float(next(tokens)), float(next(tokens))
            flat.extend((x, y, x, y, end_x, end_y, end_x, end_y))
        else:
            x1, y1, x2, y2 = (float(next(tokens)) for _ in range(4))
            if letter == "C":
                end_x, end_y = float(next(tokens)), float(next(tokens))
                flat.extend((x, y, x1, y1, x2, y2, end_x, end_y))
            else:
                end_x, end_y = x2, y2
                flat.extend(
                    (
                        x,
                        y,
                        x + (x1 - x) / 1.5,
                        y + (y1 - y) / 1.5,
                        end_x + (x1 - end_x) / 1.5,
                        end_y + (y1 - end_y) / 1.5,
                        end_x,
                        end_y,
                    )
                )
        is_line.append(letter == "L")
        x, y = end_x, end_y
    finish()
    return subpaths


def _curves(flat: array[float], is_line: bytearray) -> FloatArray:
    """Curves with the control points of lines at their thirds and those of zero length dropped."""
    curves = np.array(flat).reshape(-1, 4, 2)
    lines: BoolArray = np.array(is_line, dtype=np.bool_)
    step = (curves[lines, 3] - curves[lines, 0]) / 3.0
    curves[lines, 1] += step
    curves[lines, 2] -= step
    has_length = np.any(curves[:, 1:] != curves[:, :1], axis=(1, 2))
    return curves[has_length] if np.any(has_length) else curves[:1]
