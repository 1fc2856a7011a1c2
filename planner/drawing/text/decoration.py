"""Lines under, over and through text, as Chromium draws them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.style.style import Style
from planner.drawing.subpath import Subpath, polyline
from planner.drawing.text.characters import Character, Text
from planner.drawing.text.context import Glyphs, TextContext
from planner.drawing.text.frame import frame

THICKNESS = 0.1
"""Of a line, in em."""

_SAME_LINE = 1e-6


@dataclass(frozen=True, slots=True)
class Decorations:
    """below: what is painted before the glyphs, and above: after them."""

    below: list[Glyphs]
    above: list[Glyphs]


@dataclass(frozen=True, slots=True)
class _Line:
    """A line that an element asks for: over characters first to stop, painted in the style of that element."""

    kind: str
    style: Style
    first: int
    stop: int


def decorations(text: Text, context: TextContext) -> Decorations:
    below: list[Glyphs] = []
    above: list[Glyphs] = []
    for line in _lines(text):
        drawn = tuple(_drawn(text, line, is_outline=context.options.text == "outline"))
        if drawn:
            is_single = context.options.text != "outline"
            (above if line.kind == "line-through" else below).append(Glyphs(drawn, line.style, is_single))
    return Decorations(below, above)


def _lines(text: Text) -> list[_Line]:
    """Those of elements around the text, then those of its own, each where it begins."""
    asked = [(style, 0, len(text.characters)) for style in _styles_around(text.root.style)]
    asked += [(span.style, span.first, span.stop) for span in text.spans]
    return [
        _Line(kind, style, first, stop)
        for kind in ("underline", "overline", "line-through")
        for style, first, stop in asked
        if kind in style["text-decoration"].split()
    ]


def _styles_around(style: Style) -> list[Style]:
    """Styles of what a text is shown under, the outermost first."""
    around = []
    while (above := style.parent) is not None:
        around.append(above)
        style = above
    return around[::-1]


def _drawn(text: Text, line: _Line, *, is_outline: bool) -> list[Subpath]:
    """The line over each character, joined where characters stand in a row."""
    pieces: list[tuple[FloatArray, float]] = []
    for character in text.characters[line.first : line.stop]:
        if character.is_middle or character.span.style["visibility"] != "visible" or character.advance == 0.0:
            continue
        placed = frame(character, is_vertical=text.is_vertical)
        if placed is None:
            continue
        y = _height(line.kind, character)
        ends = np.array([[0.0, y], [character.advance / character.stretch, y]])
        if character.is_upright:
            ends = np.array([[y, 0.0], [y, -character.advance / character.stretch]])
        piece = ends @ placed[:, :2].T + placed[:, 2]
        if pieces and pieces[-1][1] == character.size and _is_continued(pieces[-1][0], piece, character):
            pieces[-1] = np.stack((pieces[-1][0][0], piece[1])), character.size
        else:
            pieces.append((piece, character.size))
    return [_box(piece, THICKNESS * size) if is_outline else polyline(piece) for piece, size in pieces]


def _is_continued(before: FloatArray, piece: FloatArray, character: Character) -> bool:
    """Whether a piece begins where the one before ends, and goes the same way."""
    gap = np.abs(before[1] - piece[0]).max()
    first, second = before[1] - before[0], piece[1] - piece[0]
    is_straight = abs(first[0] * second[1] - first[1] * second[0]) <= _SAME_LINE * np.hypot(*first) * np.hypot(*second)
    return bool(gap <= 1e-3 * character.size and is_straight and first @ second > 0.0)


def _height(kind: str, character: Character) -> float:
    """Of the middle of a line above the alphabetic baseline."""
    ascent = character.metrics.ascent
    if kind == "underline":
        return -THICKNESS * character.size
    if kind == "overline":
        return (ascent - THICKNESS / 2.0) * character.size
    return ascent / 3.0 * character.size


def _box(ends: FloatArray, width: float) -> Subpath:
    along = ends[1] - ends[0]
    across = np.array([-along[1], along[0]]) / np.hypot(*along) * width / 2.0
    return polyline(np.array([ends[0] - across, ends[1] - across, ends[1] + across, ends[0] + across]), True)
