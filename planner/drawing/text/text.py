"""Text as glyphs: the letters of a single-line face, or the outlines of a font, where a browser has them."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import groupby

from planner.drawing.style.style import Style
from planner.drawing.subpath import Subpath
from planner.drawing.text.characters import Character, Text, read_text
from planner.drawing.text.context import Glyphs, TextContext
from planner.drawing.text.decoration import decorations
from planner.drawing.text.faces import is_shown
from planner.drawing.text.frame import frame
from planner.drawing.text.glyphs import outlines, single_lines
from planner.drawing.text.layout import lay_out
from planner.drawing.xml_tree import Element


def text_shapes(element: Element, style: Style, context: TextContext) -> list[Glyphs]:
    """What a `text` element shows, in the order of painting, in its own user units. Errors: DrawingError."""
    text = read_text(element, style, context)
    visible = [one for one in text.characters if one.span.style["visibility"] == "visible"]
    if context.options.text == "skip":
        context.skipped["text"] += any(is_shown(one.text) for one in visible)
        return []
    lay_out(text, context.options)
    lines = decorations(text, context)
    return [*lines.below, *_glyphs(text, context), *lines.above]


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
        if context.options.text == "single" and (drawn := single_lines(character, cluster)) is not None:
            yield character, True, [subpath.moved(placed) for subpath in drawn]
            continue
        drawn = outlines(character)
        code = f"glyph U+{ord(character.text):04X}"
        if not drawn:
            context.skipped[code] += 1
            continue
        if context.options.text == "single":
            context.skipped[f"{code} as a single line (its outline is drawn)"] += 1
        yield character, False, [subpath.moved(placed) for subpath in drawn]


def _clusters(characters: list[Character]) -> Iterator[tuple[Character, str]]:
    """Each character that is not drawn by another, with those that it draws."""
    start = 0
    while start < len(characters):
        stop = start + 1
        while stop < len(characters) and characters[stop].is_middle:
            stop += 1
        yield characters[start], "".join(one.text for one in characters[start:stop])
        start = stop
