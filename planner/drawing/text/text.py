"""Text as glyphs: the letters of a single-line face, or the outlines of a font, where a browser has them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

import numpy as np

from planner.drawing.style.style import Style
from planner.drawing.subpath import Subpath
from planner.drawing.text.characters import Character, Text, read_text
from planner.drawing.text.context import Glyphs, TextContext
from planner.drawing.text.decoration import decorations
from planner.drawing.text.faces import is_shown
from planner.drawing.text.frame import cell, frame
from planner.drawing.text.glyphs import outlines, single_lines
from planner.drawing.text.layout import lay_out
from planner.drawing.xml_tree import Element

MOST_NAMED = 12
"""Characters that are not drawn as they should be, and are counted by name."""


def text_shapes(element: Element, style: Style, context: TextContext) -> list[Glyphs]:
    """What a `text` element shows, in the order of painting, in its own user units. Errors: DrawingError."""
    text = read_text(element, style, context)
    visible = [one for one in text.characters if one.span.style["visibility"] == "visible"]
    if context.options.text == "skip":
        context.skipped["text"] += any(is_shown(one.text) for one in visible)
        return []
    with np.errstate(over="ignore", invalid="ignore"):  # who reads the drawing refuses coordinates that are too large
        lay_out(text, context.options)
        lines = decorations(text, context)
        return [*lines.below, *_glyphs(text, context), *lines.above]


def text_box(element: Element, style: Style, context: TextContext) -> tuple[float, float, float, float] | None:
    """The box around the cells of all characters (x, y, width, height), as a browser has it; None where there are
    none. A cell is as high as the font says that lines are. Errors: DrawingError."""
    text = read_text(element, style, context)
    lay_out(text, context.options)
    corners = [
        cell(character) @ placed[:, :2].T + placed[:, 2]
        for character, _ in _clusters(text.characters)
        if (placed := frame(character, is_vertical=text.is_vertical)) is not None
    ]
    if not corners:
        return None
    low, high = np.min(corners, axis=(0, 1)), np.max(corners, axis=(0, 1))
    return float(low[0]), float(low[1]), float(high[0] - low[0]), float(high[1] - low[1])


def _glyphs(text: Text, context: TextContext) -> Iterator[Glyphs]:
    """Neighbours of one span and one way of drawing come together."""
    pieces = _pieces(text, context)
    for (_, is_single), run in groupby(pieces, lambda piece: (id(piece[0].span), piece[1])):
        found = list(run)
        subpaths = tuple(subpath for _, _, drawn in found for subpath in drawn)
        yield Glyphs(subpaths, found[0][0].span.style, is_single)


def _pieces(text: Text, context: TextContext) -> Iterator[tuple[Character, bool, list[Subpath]]]:
    """Characters that are seen, whether as single lines, and their subpaths."""
    for character, cluster in _clusters(text.characters):
        if character.span.style["visibility"] != "visible" or character.size <= 0.0 or not is_shown(cluster[0]):
            continue
        placed = frame(character, is_vertical=text.is_vertical)
        if placed is None:
            continue
        if context.options.text == "single" and (drawn := single_lines(character, cluster, placed)) is not None:
            yield character, True, drawn
            continue
        drawn = outlines(character, placed)
        code = f"glyph U+{ord(character.text):04X}"
        if not drawn:
            _count(context, code)
            continue
        if context.options.text == "single":
            _count(context, f"{code} as a single line (its outline is drawn)")
        yield character, False, drawn


def _clusters(characters: list[Character]) -> Iterator[tuple[Character, str]]:
    """Each character that is not drawn by another, with those that it draws."""
    start = 0
    while start < len(characters):
        stop = start + 1
        while stop < len(characters) and characters[stop].is_middle:
            stop += 1
        yield characters[start], "".join(one.text for one in characters[start:stop])
        start = stop


def _count(context: TextContext, glyph: str) -> None:
    """By name; of a long text in a script that no font has not all."""
    named = [kind for kind in context.skipped if kind.startswith("glyph ")]
    context.skipped[glyph if glyph in named or len(named) < MOST_NAMED else "other glyphs"] += 1
