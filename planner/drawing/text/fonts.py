"""Fonts: what room characters take, and their outlines.

HarfBuzz shapes text and draws glyphs. The fourteen fonts that every printer once had have their metrics in files of
Adobe's, which Matplotlib brings: text for them takes the room that it was made for where they are not installed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Protocol

import numpy as np

from planner.drawing.subpath import Subpath
from planner.drawing.text.faces import Face
from planner.errors import DrawingError

SLANT = 0.25
"""How far an upright font leans, per height, where an italic one is asked for and there is none."""

_WITHOUT_LIGATURES = {"liga": False, "clig": False}


@dataclass(frozen=True, slots=True)
class ShapedGlyph:
    """A glyph where HarfBuzz puts it: cluster is the index of the first character that it stands for; advance along
    the line and offset (x, y up) in em."""

    cluster: int
    advance: float
    offset: tuple[float, float]
    glyph: int


@dataclass(frozen=True, slots=True)
class Metrics:
    """Heights above the baseline in em; descent is counted downwards."""

    ascent: float
    descent: float
    x_height: float
    cap_height: float


USUAL = Metrics(0.93, 0.24, 0.55, 0.73)


class Font(Protocol):
    @property
    def metrics(self) -> Metrics: ...

    def has(self, character: str) -> bool: ...

    def shape(
        self, text: str, start: int, stop: int, *, is_rtl: bool, is_vertical: bool, has_ligatures: bool
    ) -> list[ShapedGlyph]:
        """The glyphs of text[start:stop] in the order in which they are seen; the rest of the text is context."""

    def outline(self, glyph: int) -> tuple[Subpath, ...]:
        """Closed contours in em, y up; empty where the font has metrics alone."""


class FontFile:
    """A font of a file."""

    def __init__(self, path: Path, index: int = 0, *, is_slanted: bool = False) -> None:
        """Errors: DrawingError where the file is no font."""
        import uharfbuzz as hb

        try:
            face = hb.Face(hb.Blob.from_file_path(str(path)), index)
        except (OSError, hb.HarfBuzzError) as error:
            raise DrawingError(str(path), f"cannot be read: {error}") from None
        if face.glyph_count == 0:
            raise DrawingError(str(path), "is no TrueType or OpenType font (.ttf, .otf, .ttc)")
        self._em = float(face.upem)
        self._slant = SLANT if is_slanted else 0.0
        self._font = hb.Font(face)
        self._outlines: dict[int, tuple[Subpath, ...]] = {}

    def has(self, character: str) -> bool:
        return self._font.get_nominal_glyph(ord(character)) is not None

    @cached_property
    def metrics(self) -> Metrics:
        extents = self._font.get_font_extents("ltr")
        return Metrics(
            extents.ascender / self._em, -extents.descender / self._em, self._top("x", 0.5), self._top("H", 0.7)
        )

    def _top(self, letter: str, otherwise: float) -> float:
        glyph = self._font.get_nominal_glyph(ord(letter))
        extents = None if glyph is None else self._font.get_glyph_extents(glyph)
        return extents.y_bearing / self._em if extents is not None and extents.y_bearing > 0 else otherwise

    def shape(
        self, text: str, start: int, stop: int, *, is_rtl: bool, is_vertical: bool, has_ligatures: bool
    ) -> list[ShapedGlyph]:
        import uharfbuzz as hb

        buffer = hb.Buffer()
        buffer.add_codepoints([ord(character) for character in text], start, stop - start)
        buffer.guess_segment_properties()
        buffer.direction = "ttb" if is_vertical else "rtl" if is_rtl else "ltr"
        hb.shape(self._font, buffer, {} if has_ligatures else _WITHOUT_LIGATURES)
        return [
            ShapedGlyph(
                info.cluster,
                (-position.y_advance if is_vertical else position.x_advance) / self._em,
                (position.x_offset / self._em, position.y_offset / self._em),
                info.codepoint,
            )
            for info, position in zip(buffer.glyph_infos, buffer.glyph_positions, strict=True)
        ]

    def outline(self, glyph: int) -> tuple[Subpath, ...]:
        if glyph not in self._outlines:
            from planner.drawing.text.pen import contours

            lean = np.array([[1.0, self._slant, 0.0], [0.0, 1.0, 0.0]]) / self._em
            self._outlines[glyph] = tuple(contour.moved(lean) for contour in contours(self._font, glyph))
        return self._outlines[glyph]


class MetricsFile:
    """A font of which its metrics alone are known: an AFM file. ascent, descent: of the TrueType fonts that took its
    place, which browsers measure lines by."""

    def __init__(self, path: Path, ascent: float, descent: float) -> None:
        from fontTools.afmLib import AFM
        from fontTools.agl import AGL2UV

        afm = AFM(str(path))
        self._names = {chr(AGL2UV[name]): name for name in afm.chars() if name in AGL2UV}
        self._afm = afm
        self.metrics = Metrics(ascent, descent, afm.XHeight / 1000.0, afm.CapHeight / 1000.0)

    def has(self, character: str) -> bool:
        return character in self._names

    def shape(
        self, text: str, start: int, stop: int, *, is_rtl: bool, is_vertical: bool, has_ligatures: bool
    ) -> list[ShapedGlyph]:
        names = [self._names[character] for character in text[start:stop]]
        afm = self._afm
        advances = [
            (afm[name][1] + (afm[name, after] if afm.has_kernpair((name, after)) else 0.0)) / 1000.0
            for name, after in zip(names, [*names[1:], ""], strict=True)
        ]
        return _in_a_row(advances, start, self.metrics, is_rtl=is_rtl, is_vertical=is_vertical)

    def outline(self, glyph: int) -> tuple[Subpath, ...]:
        return ()


class FaceMetrics:
    """A single-line face that takes room of its own."""

    def __init__(self, face: Face) -> None:
        self._face = face
        self._scale = 0.7 / face.cap_height
        self.metrics = Metrics(0.93, 0.24, face.x_height * self._scale, 0.7)

    def has(self, character: str) -> bool:
        return character in self._face.lines

    def shape(
        self, text: str, start: int, stop: int, *, is_rtl: bool, is_vertical: bool, has_ligatures: bool
    ) -> list[ShapedGlyph]:
        advances = [self._face.glyph(character).advance * self._scale for character in text[start:stop]]
        return _in_a_row(advances, start, self.metrics, is_rtl=is_rtl, is_vertical=is_vertical)

    def outline(self, glyph: int) -> tuple[Subpath, ...]:
        return ()


def _in_a_row(
    advances: Sequence[float], start: int, metrics: Metrics, *, is_rtl: bool, is_vertical: bool
) -> list[ShapedGlyph]:
    """A glyph for each character, from HarfBuzz's point of view."""
    row = [
        ShapedGlyph(index, metrics.ascent + metrics.descent, (-advance / 2.0, -metrics.ascent), 0)
        if is_vertical
        else ShapedGlyph(index, advance, (0.0, 0.0), 0)
        for index, advance in enumerate(advances, start)
    ]
    return row[::-1] if is_rtl else row
