"""The single-line faces to look at: a line of text in one of them, and what each has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.drawing.subpath import Subpath
from planner.drawing.text.faces import FACES, Face, face_with, is_shown, load_face

PANGRAM = (
    "The quick brown fox jumps over the lazy dog 0123456789",
    "Příliš žluťoučký kůň, zażółć gęślą jaźń, Ævar nær Þór, Ærøskøbing, ñandú, çığlık",
    "Ξεσκεπάζω την ψυχοφθόρα βδελυγμία",
    "Съешь же ещё этих мягких французских булок, їжак ґедзь",
    "!?.,:;…-–—'\"‘’“”„«»()[]{}/\\|&@#$%*+=<>^_~°±×÷€£µ§©←→↑↓",
)

_BLOCKS = {
    "Basic Latin": range(0x21, 0x7F),
    "Latin-1": range(0xA1, 0x100),
    "Latin Extended-A": range(0x100, 0x180),
    "Greek": (*range(0x386, 0x3AC), *range(0x3AC, 0x3CF)),
    "Cyrillic": range(0x400, 0x460),
}


@dataclass(frozen=True, eq=False, slots=True)
class Line:
    """subpaths: y up, the baseline at 0 and capitals 1 high. missing: characters that no face has."""

    subpaths: tuple[Subpath, ...]
    width: float
    missing: str


def written(text: str, face: Face) -> Line:
    """A line in the room of the face itself; what it lacks is taken from the face that stands in for all."""
    subpaths: list[Subpath] = []
    x, missing = 0.0, ""
    for character in text:
        source = face_with(character, face)
        if source is None:
            missing += character if is_shown(character) else ""
            continue
        scale = 1.0 / source.cap_height
        glyph = source.glyph(character)
        affine = np.array([[scale, 0.0, x], [0.0, scale, 0.0]])
        subpaths += [subpath.moved(affine) for subpath in glyph.subpaths]
        x += glyph.advance * scale
    return Line(tuple(subpaths), x, missing)


def faces() -> dict[str, Face]:
    """By the kind of font that each stands for."""
    return {kind: load_face(file) for kind, file in FACES.items()}


def coverage(face: Face) -> dict[str, tuple[int, int]]:
    """How many characters a face itself has of each block, and how many there are."""
    return {
        name: (sum(chr(code) in face.lines for code in block), sum(chr(code).isprintable() for code in block))
        for name, block in ((name, [code for code in block if _is_assigned(code)]) for name, block in _BLOCKS.items())
    }


def _is_assigned(code: int) -> bool:
    return is_shown(chr(code))
