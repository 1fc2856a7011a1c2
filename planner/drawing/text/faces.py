"""Single-line faces: letters as a pen writes them."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files

import numpy as np

from planner.arrays import FloatArray, frozen
from planner.drawing.subpath import Subpath, polyline

STAND_IN = "newstroke"
"""The face with by far the most letters: what another lacks is taken from it."""

FACES = {"sans": "relief", "serif": "nixish", "script": "allure", "mono": STAND_IN}
"""By kind of font."""

_CORNER = np.cos(np.radians(50.0))
"""Where a polyline turns by more than that it has a corner; elsewhere it stands for a smooth curve."""


@dataclass(frozen=True, eq=False, slots=True)
class SingleLine:
    """A glyph of a face: its strokes in units of the face, y up, the baseline at 0."""

    advance: float
    subpaths: tuple[Subpath, ...]


@dataclass(frozen=True, eq=False, slots=True)
class Face:
    """licence: its name and its file. cap_height, x_height: of `H` and `x`, in units of the face. lines: by character,
    as the file has them."""

    name: str
    licence: str
    cap_height: float
    x_height: float
    is_smooth: bool
    lines: dict[str, str]
    _read: dict[str, SingleLine] = field(default_factory=dict)

    def glyph(self, character: str) -> SingleLine:
        """Errors: KeyError where the face lacks it."""
        if character not in self._read:
            advance, _, strokes = self.lines[character].partition(" ")
            subpaths = [self._subpath(kind, numbers) for kind, numbers in re.findall(r"([LC])([-\d, ]+)", strokes)]
            self._read[character] = SingleLine(float(advance), tuple(subpaths))
        return self._read[character]

    def _subpath(self, kind: str, numbers: str) -> Subpath:
        points = np.array([float(number) for number in numbers.replace(",", " ").split()]).reshape(-1, 2)
        if kind == "C":
            n_curves = len(points) // 3
            beziers = points[np.arange(n_curves)[:, None] * 3 + np.arange(4)]
            return Subpath(frozen(beziers), False, np.ones(n_curves, dtype=np.bool_))
        return _smooth(points) if self.is_smooth and len(points) > 2 else polyline(points)


def _smooth(points: FloatArray) -> Subpath:
    """A curve through points (n, 2), straight to and from corners: its tangent at a point is the mean of the edges
    there, the longer edge counting more."""
    edges = np.diff(points, axis=0)
    is_edge = np.hypot(*edges.T) > 0.0
    points, edges = np.concatenate((points[:1], points[1:][is_edge])), edges[is_edge]
    if len(edges) < 2:
        return polyline(points)
    lengths = np.hypot(*edges.T)[:, None]
    directions = edges / lengths
    before, after = np.roll(directions, 1, axis=0), directions
    is_curved = (before * after).sum(axis=1, keepdims=True) > _CORNER
    is_curved[0] &= bool(np.all(points[0] == points[-1]))
    mean = before * np.roll(lengths, 1, axis=0) + after * lengths
    mean /= np.maximum(np.hypot(*mean.T)[:, None], 1e-12)
    starts = np.where(is_curved, mean, after)
    ends = np.roll(np.where(is_curved, mean, before), -1, axis=0)
    beziers = np.stack(
        (points[:-1], points[:-1] + starts * lengths / 3.0, points[1:] - ends * lengths / 3.0, points[1:]), axis=1
    )
    return Subpath(frozen(beziers), False, np.ones(len(beziers), dtype=np.bool_))


@cache
def load_face(file: str) -> Face:
    """A face by the name of its file in `faces/`, without its ending."""
    text = (files("planner.drawing.text") / "faces" / f"{file}.txt").read_text(encoding="ascii")
    head = dict(re.findall(r"^# (\w+): (.*)$", text, re.MULTILINE))
    lines = {}
    for line in text.splitlines():
        if not line.startswith("#"):
            code, _, rest = line.partition(" ")
            lines[chr(int(code, 16))] = rest
    return Face(
        head["name"],
        head["licence"],
        float(head["cap_height"]),
        float(head["x_height"]),
        head["smooth"] == "yes",
        lines,
    )


def face_with(character: str, wanted: Face) -> Face | None:
    """The face to take a character from: the one that is wanted, or what stands in for it; None where none has it."""
    return next((face for face in (wanted, load_face(STAND_IN)) if character in face.lines), None)


def is_shown(character: str) -> bool:
    """Whether a glyph is expected of it at all: spaces and controls have none."""
    return unicodedata.category(character)[0] not in "ZC"
