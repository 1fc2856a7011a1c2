"""What a printed page paints: the paths of a PDF as polylines, with what cuts them."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
import pypdfium2
import pypdfium2.raw as pdfium
import shapely
from shapely.geometry.base import BaseGeometry
from shapely.ops import substring

from planner.arrays import FloatArray

_PX_PER_POINT = 96.0 / 72.0
_ON_THE_EDGE_PX = 0.02
"""What lies on the edge of a clip is inside."""
_CHORD = 1e-4
"""Of the longer side of the page."""


@dataclass(eq=False, slots=True)
class Painted:
    """One painted object. kind: "fill", "stroke", "text" or "image". lines: polylines (n, 2) in pixels of CSS from
    the top left corner of the page, closed where it is a fill; of a text or image its box. clip: what cuts it, or
    None. width: of a stroke."""

    kind: str
    lines: list[FloatArray]
    clip: BaseGeometry | None
    alpha: int
    width: float = 0.0
    area: BaseGeometry | None = field(default=None)

    def visible(self) -> list[FloatArray]:
        """Its lines inside of its clip."""
        if self.clip is None:
            return self.lines
        return [part for line in self.lines for part in parts_of(line, self.clip)]

    def region(self) -> BaseGeometry:
        """What a fill covers, by the non-zero rule as well as it matters here."""
        if self.area is None:
            self.area = _union(self.lines)
        return self.area


def is_dot(line: FloatArray) -> bool:
    return len(line) == 1 or bool(np.ptp(line, axis=0).max() == 0.0)


def parts_of(line: FloatArray, region: BaseGeometry) -> list[FloatArray]:
    """The parts of a line inside of a region; where they only touch there is none."""
    if is_dot(line):
        return [line] if region.intersects(shapely.Point(line[0])) else []
    parts = shapely.get_parts(shapely.line_merge(shapely.LineString(line).intersection(region)))
    return [shapely.get_coordinates(part) for part in parts if part.length > 0.0]


def trimmed(line: FloatArray, length: float) -> list[FloatArray]:
    """A line without so much of both of its ends, if anything is left."""
    whole = shapely.LineString(line) if len(line) > 1 else shapely.Point(line[0])
    if whole.length <= 2.0 * length:
        return []
    return [shapely.get_coordinates(substring(whole, length, whole.length - length))]


def painted(pdf: bytes, stretch: tuple[float, float] = (1.0, 1.0)) -> list[Painted]:
    """All painted objects of the first page in order, x and y times `stretch`."""
    document = pypdfium2.PdfDocument(pdf)
    try:
        page = document[0]
        height = page.get_height()
        across, down = (_PX_PER_POINT * factor for factor in stretch)
        flip = np.array([[across, 0.0, 0.0], [0.0, -down, down * height], [0.0, 0.0, 1.0]])
        raw = page.raw
        reader = _Reader(_CHORD * _PX_PER_POINT * max(page.get_size()))
        count = pdfium.FPDFPage_CountObjects(raw)
        return list(reader.objects(lambda index: pdfium.FPDFPage_GetObject(raw, index), count, flip, None))
    finally:
        document.close()


class _Reader:
    """chord: how far curves may be from their chords, in pixels."""

    def __init__(self, chord: float) -> None:
        self._chord = chord
        self._clips: dict[bytes, BaseGeometry] = {}

    def objects(
        self, item: Callable[[int], object], count: int, affine: FloatArray, outer: BaseGeometry | None
    ) -> Iterator[Painted]:
        for index in range(count):
            thing = item(index)
            kind = pdfium.FPDFPageObj_GetType(thing)
            own = pdfium.FS_MATRIX()
            pdfium.FPDFPageObj_GetMatrix(thing, own)
            matrix = np.array([[own.a, own.c, own.e], [own.b, own.d, own.f], [0.0, 0.0, 1.0]])
            clip = self._clip(thing, affine, outer)
            if kind == pdfium.FPDF_PAGEOBJ_FORM:

                def inner(at: int, form: object = thing) -> object:
                    return pdfium.FPDFFormObj_GetObject(form, at)

                yield from self.objects(inner, pdfium.FPDFFormObj_CountObjects(thing), affine @ matrix, clip)
            elif kind == pdfium.FPDF_PAGEOBJ_PATH:
                yield from self._path(thing, affine @ matrix, clip)
            elif kind in (pdfium.FPDF_PAGEOBJ_TEXT, pdfium.FPDF_PAGEOBJ_IMAGE):
                name = "text" if kind == pdfium.FPDF_PAGEOBJ_TEXT else "image"
                box = [ctypes.c_float() for _ in range(4)]
                if pdfium.FPDFPageObj_GetBounds(thing, *box):
                    left, bottom, right, top = (side.value for side in box)
                    corners = np.array([[left, bottom], [right, bottom], [right, top], [left, top], [left, bottom]])
                    yield Painted(name, [_moved(corners, affine)], clip, 255)

    def _path(self, thing: object, affine: FloatArray, clip: BaseGeometry | None) -> Iterator[Painted]:
        mode, is_stroked = ctypes.c_int(), ctypes.c_int()
        pdfium.FPDFPath_GetDrawMode(thing, mode, is_stroked)

        def segment(index: int) -> object:
            return pdfium.FPDFPath_GetPathSegment(thing, index)

        lines = self._polylines(segment, pdfium.FPDFPath_CountSegments(thing), affine)
        if mode.value:
            closed = [line if len(line) < 2 else np.concatenate((line, line[:1])) for line in lines]
            yield Painted("fill", closed, clip, _alpha(pdfium.FPDFPageObj_GetFillColor, thing))
        if is_stroked.value:
            width = ctypes.c_float()
            pdfium.FPDFPageObj_GetStrokeWidth(thing, width)
            across = width.value * float(np.sqrt(abs(np.linalg.det(affine[:2, :2]))))
            yield Painted("stroke", lines, clip, _alpha(pdfium.FPDFPageObj_GetStrokeColor, thing), across)

    def _clip(self, thing: object, affine: FloatArray, outer: BaseGeometry | None) -> BaseGeometry | None:
        path = pdfium.FPDFPageObj_GetClipPath(thing)
        clip = outer
        for index in range(max(pdfium.FPDFClipPath_CountPaths(path), 0)):

            def segment(at: int, index: int = index) -> object:
                return pdfium.FPDFClipPath_GetPathSegment(path, index, at)

            lines = self._polylines(segment, pdfium.FPDFClipPath_CountPathSegments(path, index), affine)
            key = b"".join(line.tobytes() for line in lines)
            if key not in self._clips:
                self._clips[key] = _union(lines)
                if len(shapely.get_coordinates(self._clips[key])) <= 5:  # a page, a viewport, a marker or a tile
                    self._clips[key] = self._clips[key].buffer(_ON_THE_EDGE_PX, join_style="mitre")
            clip = self._clips[key] if clip is None else clip.intersection(self._clips[key])
        return clip

    def _polylines(self, segment: Callable[[int], object], count: int, affine: FloatArray) -> list[FloatArray]:
        lines: list[FloatArray] = []
        points: list[FloatArray] = []
        controls: list[FloatArray] = []
        x, y = ctypes.c_float(), ctypes.c_float()

        def finish() -> None:
            if points:
                lines.append(np.array(points))
            points.clear()

        for index in range(count):
            part = segment(index)
            pdfium.FPDFPathSegment_GetPoint(part, x, y)
            point = _moved(np.array([[x.value, y.value]]), affine)[0]
            kind = pdfium.FPDFPathSegment_GetType(part)
            if kind == pdfium.FPDF_SEGMENT_MOVETO:
                finish()
                points.append(point)
            elif kind == pdfium.FPDF_SEGMENT_LINETO:
                points.append(point)
            else:
                controls.append(point)
                if len(controls) == 3:
                    points += list(curve_points(np.array([points[-1], *controls]), self._chord))
                    controls.clear()
            if pdfium.FPDFPathSegment_GetClose(part) and points:
                points.append(points[0])
                start = points[0]
                finish()
                points.append(start)
        if len(points) > 1 or not lines:
            finish()
        return lines


def _alpha(colour_of: Callable[..., int], thing: object) -> int:
    channels = [ctypes.c_uint() for _ in range(4)]
    return channels[3].value if colour_of(thing, *channels) else 255


def _union(lines: list[FloatArray]) -> BaseGeometry:
    """What rings cover; one that runs the other way round inside another is a hole."""
    areas: list[list[BaseGeometry]] = [[], []]
    for line in lines:
        if len(line) >= 3:
            ring = shapely.LinearRing(line)
            area = shapely.Polygon(ring)
            areas[ring.is_ccw].append(area if area.is_valid else shapely.make_valid(area))
    one, other = (shapely.unary_union(turning) for turning in areas)
    return one.symmetric_difference(other)


def curve_points(controls: FloatArray, chord: float) -> FloatArray:
    """Points of a cubic (4, 2) without its first, no chord further from it than `chord`."""
    bend = np.abs(np.diff(controls, 2, axis=0)).max()
    steps = int(np.clip(np.ceil(np.sqrt(0.75 * bend / chord)), 1, 200))
    t = np.linspace(0.0, 1.0, steps + 1)[1:, None]
    weights = np.hstack(((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3))
    return np.asarray(weights @ controls)


def _moved(points: FloatArray, affine: FloatArray) -> FloatArray:
    return np.asarray(points @ affine[:2, :2].T + affine[:2, 2])
