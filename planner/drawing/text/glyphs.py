"""What a character looks like, in its own frame."""

from __future__ import annotations

import unicodedata

import numpy as np

from planner.affine import compose
from planner.arrays import FloatArray
from planner.drawing.subpath import Subpath
from planner.drawing.text.characters import Character
from planner.drawing.text.faces import FACES, Face, face_with, load_face

ITALIC = np.tan(np.radians(12.0))
"""How far a single-line face leans where an italic one is asked for."""

_NARROWEST, _WIDEST = 0.65, 1.5
"""How far a single-line glyph is squeezed or stretched to fill the room of the font that was asked for."""


def single_lines(character: Character, cluster: str, placed: FloatArray) -> list[Subpath] | None:
    """The strokes of a character with the marks on it; None where no face has all of them. placed: its frame."""
    wanted = load_face(FACES[character.span.request.kind])
    composed = unicodedata.normalize("NFC", cluster)
    face = face_with(composed[0], wanted)
    if face is None or any(unicodedata.combining(mark) for mark in composed[1:]):
        return None
    return _fitted(character, face, composed[0], placed)


def _fitted(character: Character, face: Face, letter: str, placed: FloatArray) -> list[Subpath]:
    """Heights are those of the font that was asked for, and so is the advance, within bounds."""
    glyph = face.glyph(letter)
    up = character.size * character.metrics.cap_height / face.cap_height
    advance = sum(one.advance for one in character.glyphs) * character.size
    x, y = 0.0, 0.0
    if character.is_upright:
        first = character.glyphs[0].offset
        advance, x, y = -2.0 * first[0] * character.size, first[0] * character.size, first[1] * character.size
    along = up
    if glyph.advance > 0.0 and advance > 0.0:
        is_joined = face is load_face(FACES["script"])
        ratio = advance / (glyph.advance * up)
        along = up * (ratio if is_joined else min(max(ratio, _NARROWEST), _WIDEST))
        x += (advance - glyph.advance * along) / 2.0
    lean = ITALIC * up if character.span.request.is_italic and face is not load_face(FACES["script"]) else 0.0
    return _moved(glyph.subpaths, placed, np.array([[along, lean, x], [0.0, up, y]]))


def outlines(character: Character, placed: FloatArray) -> list[Subpath]:
    """The contours of a character's glyphs in its font; empty where there are none. placed: its frame."""
    if character.font is None:
        return []
    drawn: list[Subpath] = []
    pen, size = 0.0, character.size
    for glyph in character.glyphs:
        x, y = pen + glyph.offset[0] * size, glyph.offset[1] * size
        drawn += _moved(character.font.outline(glyph.glyph), placed, np.array([[size, 0.0, x], [0.0, size, y]]))
        pen += 0.0 if character.is_upright else glyph.advance * size
    return drawn


def _moved(subpaths: tuple[Subpath, ...], placed: FloatArray, own: FloatArray) -> list[Subpath]:
    """Under `own`, then under `placed`."""
    both = compose(placed, own)
    return [subpath.moved(both) for subpath in subpaths]
