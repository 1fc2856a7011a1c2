"""From characters to glyphs in a row, in the order in which they are seen."""

from __future__ import annotations

import unicodedata
from dataclasses import replace
from itertools import groupby

from planner.drawing.options import ReadingOptions
from planner.drawing.text.bidi import levels, visual_order
from planner.drawing.text.characters import Character, Text, is_spaced
from planner.drawing.text.families import any_font_with, font_file, fonts_for
from planner.drawing.text.fonts import Font, ShapedGlyph

_CONTEXT = 5
"""Characters on either side that HarfBuzz looks at, to join letters."""


def shape(text: Text, options: ReadingOptions) -> list[int]:
    """Gives each character its font, glyphs and advance, and its place `u` in one line. Returns their order from left
    to right, or from top to bottom."""
    characters = text.characters
    content = "".join(character.text for character in characters)
    overrides = [_override(character) for character in characters]
    found = levels(content, overrides, is_rtl=text.root.is_rtl)
    for character in characters:
        character.font = _font(character, options)
        character.is_upright = text.is_vertical and _is_upright(character)
    start = 0
    for _, run in groupby(range(len(characters)), _RunKey(characters, found)):
        stop = start + len(list(run))
        _shape_run(characters, content, start, stop, is_rtl=found[start] % 2 == 1, is_single=options.text == "single")
        start = stop
    order = visual_order(found)
    pen = 0.0
    for index in order:
        character = characters[index]
        character.u = pen
        pen += character.advance
    return order


class _RunKey:
    """Characters that are shaped together have the same key: one font and size, one direction, one script, and none
    but the first has a place of its own."""

    def __init__(self, characters: list[Character], found: list[int]) -> None:
        from fontTools.unicodedata import script

        self._keys: list[tuple[object, ...]] = []
        piece, last_script, path = 0, "Zyyy", None
        for character, level in zip(characters, found, strict=True):
            own = script(character.text)
            is_common = own in ("Zyyy", "Zinh")
            if character.x is not None or character.y is not None or character.span.path is not path:
                piece += 1
            if not is_common and last_script not in ("Zyyy", own):
                piece += 1
            last_script = last_script if is_common else own
            path = character.span.path
            spacing = character.span.letter_spacing
            self._keys.append((piece, id(character.font), character.size, level, character.is_upright, spacing))

    def __call__(self, index: int) -> tuple[object, ...]:
        return self._keys[index]


def _shape_run(
    characters: list[Character], content: str, start: int, stop: int, *, is_rtl: bool, is_single: bool
) -> None:
    first = characters[start]
    if first.font is None:
        glyphs = [ShapedGlyph(index, _missing_advance(content[index]), (0.0, 0.0), 0) for index in range(start, stop)]
    else:
        before, after = max(start - _CONTEXT, 0), stop + _CONTEXT
        glyphs = first.font.shape(
            content[before:after],
            start - before,
            stop - before,
            is_rtl=is_rtl,
            is_vertical=first.is_upright,
            has_ligatures=not is_single and first.span.letter_spacing == 0.0,
        )
        glyphs = [replace(glyph, cluster=glyph.cluster + before) for glyph in glyphs]
    clusters = {glyph.cluster for glyph in glyphs}
    for index in range(start, stop):
        character = characters[index]
        character.is_middle = index not in clusters
    for glyph in glyphs:
        characters[glyph.cluster].glyphs.append(glyph)
    for character in characters[start:stop]:
        character.advance = sum(glyph.advance for glyph in character.glyphs) * character.size
        if not character.is_middle and is_spaced(character.text):
            character.advance += character.span.letter_spacing
            if character.text in " \u00a0":
                character.advance += character.span.word_spacing


def _font(character: Character, options: ReadingOptions) -> Font | None:
    """The first font that has it; where none has, the first of all, with its sign for what is missing."""
    is_outline = options.text == "outline"
    fonts: tuple[Font, ...] = fonts_for(character.span.request, needs_outlines=is_outline)
    if options.font is not None and is_outline:
        fonts = (font_file(options.font), *fonts)
    if not is_spaced(character.text) or character.text.isspace():
        return fonts[0] if fonts[0].has(character.text) else fonts[-1]
    return next((font for font in fonts if font.has(character.text)), None) or any_font_with(character.text)


def _override(character: Character) -> str | None:
    span = character.span
    if span.style["unicode-bidi"] in ("bidi-override", "isolate-override"):
        return "R" if span.is_rtl else "L"
    return None


def _is_upright(character: Character) -> bool:
    """In vertical text; of wide characters, and of all where the style says so."""
    style = character.span.style
    if style["writing-mode"].startswith("sideways") or style["text-orientation"] == "sideways":
        return False
    return style["text-orientation"] == "upright" or unicodedata.east_asian_width(character.text) in "WF"


def _missing_advance(character: str) -> float:
    """Of what no font has, in em."""
    return 1.0 if unicodedata.east_asian_width(character) in "WF" else 0.6
