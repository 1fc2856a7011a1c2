"""The lines that a drawing wants, cut in the check's own way from what the drawing shows.

The reader cuts cubics at exact parameters, many at once. Here curves become polylines first, and Shapely's overlays
cut these, shape by shape. Whether a line that runs along the edge of a region is in it is then a matter of chords: such
lines may be drawn, and have to be only where they are surely inside.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import shapely
from shapely.affinity import affine_transform
from shapely.geometry.base import BaseGeometry

from planner.affine import inverse
from planner.arrays import FloatArray
from planner.checking.filled import filled
from planner.drawing.drawing import Drawing, Outline
from planner.drawing.flatten import flatten_all
from planner.drawing.scene.shape import Scene, Shape

_SHORTEST_GAP_MM = 0.5
_ROUNDING = 1e-4
_EXACT_MM = 1e-7
CRUMB_MM = 0.02
"""A cut may leave as much of a line that a region only touches."""
_PAPER = 1e-3
"""By so much of the page a rectangle may be smaller, and still is paper."""
_Overlay = Callable[[Any], Any]


@dataclass(frozen=True, eq=False, slots=True)
class WantedLines:
    """Polylines (n, 2) on the paper; a tap has one point. allowed: what may be drawn. required: what has to be."""

    allowed: list[FloatArray]
    required: list[FloatArray]


def all_of_it(line: Outline) -> bool:
    """Every line is wanted."""
    return True


def wanted_lines(
    drawing: Drawing, affine: FloatArray, chord_mm: float, is_wanted: Callable[[Outline], bool] = all_of_it
) -> WantedLines:
    """Those of a drawing where `affine` (2, 3) puts it, no further than `chord_mm` from its curves. Of a drawing
    without a scene they are its outlines. is_wanted: by layer, colour and width; what is not may still hide lines."""
    if drawing.scene is None:
        lines = flatten_all([one for one in drawing.outlines if is_wanted(one)], affine, chord_mm)
        return WantedLines(lines, lines)
    allowed = _Cuts(drawing, affine, chord_mm, is_wanted, is_generous=True)
    lines = allowed.lines()
    if not allowed.has_cut:
        return WantedLines(lines, lines)
    return WantedLines(lines, _Cuts(drawing, affine, chord_mm, is_wanted, is_generous=False).lines())


class _Cuts:
    """One way to cut the lines of a scene: generous, with regions that show a little wider and those that hide as they
    are, or the other way round."""

    def __init__(
        self,
        drawing: Drawing,
        affine: FloatArray,
        chord_mm: float,
        is_wanted: Callable[[Outline], bool],
        is_generous: bool,
    ) -> None:
        assert drawing.scene is not None
        self._is_wanted = is_wanted
        self._scene, self._reading = drawing.scene, drawing.reading
        self._affine, self._chord_mm, self._is_generous = affine, chord_mm, is_generous
        along_mm = 2.0 * chord_mm
        self._shown_mm, self._hidden_mm = (along_mm, _EXACT_MM) if is_generous else (_EXACT_MM, along_mm)
        self._crumb_mm = 0.0 if is_generous else CRUMB_MM
        self._known: dict[int, BaseGeometry] = {}
        self.has_cut = False

    def lines(self) -> list[FloatArray]:
        shapes = _without_paper(self._scene)
        covers = [self._cover(shape) for shape in shapes] if self._reading.occlude else []
        under = shapely.STRtree(covers)
        page = self._page()
        found: list[FloatArray] = []
        for index, shape in enumerate(shapes):
            if not self._is_wanted(_told(shape)):
                continue
            seen = self._drawn(shape)
            for clip in shape.clips:
                seen = self._shown_of(seen, self._shown(clip))
            if covers and seen:
                above = np.unique(under.query(seen, predicate="intersects")[1])
                hidden = shapely.union_all(under.geometries[above[above > index]])
                seen = self._unhidden_of(seen, shapely.buffer(hidden, self._hidden_mm))
            if self._reading.crop == "page":
                seen = self._shown_of(seen, page)
            found += [shapely.get_coordinates(line) for line in seen]
            found += self._short_gaps(shape, seen)
        return found

    def _drawn(self, shape: Shape) -> list[BaseGeometry]:
        """The lines of a shape before anything cuts them; edges of a fill only where it has an area."""
        lines = flatten_all(shape.lines, self._affine, self._chord_mm)
        if shape.fill is not None and shape.stroke is None:
            lines = [line for line in lines if not filled([line], is_even_odd=False).is_empty]
        return as_lines(lines)

    def _shown_of(self, lines: Sequence[BaseGeometry], region: BaseGeometry) -> list[BaseGeometry]:
        """What of lines and taps is in a region."""
        is_whole = shapely.covers(region, lines).tolist()
        return self._cut(lines, is_whole, lambda parts: shapely.intersection(parts, region))

    def _unhidden_of(self, lines: Sequence[BaseGeometry], region: BaseGeometry) -> list[BaseGeometry]:
        """What of lines and taps is not."""
        is_whole = shapely.disjoint(region, lines).tolist()
        return self._cut(lines, is_whole, lambda parts: shapely.difference(parts, region))

    def _cut(self, lines: Sequence[BaseGeometry], is_whole: Sequence[bool], overlay: _Overlay) -> list[BaseGeometry]:
        self.has_cut |= not all(is_whole)
        return cut_lines(lines, is_whole, overlay, self._crumb_mm)

    def _shown(self, region: BaseGeometry) -> BaseGeometry:
        if id(region) not in self._known:
            self._known[id(region)] = shapely.buffer(_moved(region, self._affine), self._shown_mm)
        return self._known[id(region)]

    def _page(self) -> BaseGeometry:
        page = shapely.box(0.0, 0.0, *self._scene.page_mm)
        return self._shown(_moved(page, inverse(self._scene.user_to_page)))

    def _cover(self, shape: Shape) -> BaseGeometry:
        """What the shape hides of all that is painted before it."""
        if shape.fill is None or not shape.fill.is_opaque:
            return shapely.Polygon()
        area = filled(flatten_all(shape.outline, self._affine, self._chord_mm), shape.is_even_odd)
        return shapely.intersection_all([area, *(_moved(clip, self._affine) for clip in shape.clips)])

    def _short_gaps(self, shape: Shape, seen: Sequence[BaseGeometry]) -> list[FloatArray]:
        """The gaps that are too short to be left, between dashes that are both still there at them."""
        gaps = [Outline(path.gap) for path in shape.lines if path.gap is not None]
        if not gaps or not seen:
            return []
        longest_mm = _SHORTEST_GAP_MM * (1.0 + (_ROUNDING if self._is_generous else -_ROUNDING))
        dashes = shapely.STRtree(seen)
        return [
            line
            for line in flatten_all(gaps, self._affine, self._chord_mm)
            if len(line) > 1
            and shapely.LineString(line).length < longest_mm
            and all(len(dashes.query(shapely.Point(end), "dwithin", _EXACT_MM)) for end in (line[0], line[-1]))
        ]


def cut_lines(
    lines: Sequence[BaseGeometry], is_whole: Sequence[bool], overlay: _Overlay, crumb_mm: float
) -> list[BaseGeometry]:
    """Lines and taps with those that are not whole cut by an overlay; of lines that leaves no less than a crumb, and of
    taps nothing."""
    left: list[BaseGeometry] = []
    for line, whole in zip(lines, is_whole, strict=True):
        if whole:
            left.append(line)
        elif shapely.get_dimensions(line) == 1:
            left += [part for part in _torn(line, overlay) if part.length > crumb_mm]
    return left


def as_lines(lines: Sequence[FloatArray]) -> list[BaseGeometry]:
    """Polylines (n, 2) and taps (1, 2)."""
    return [shapely.LineString(line) if len(line) > 1 else shapely.Point(line[0]) for line in lines]


def _told(shape: Shape) -> Outline:
    """What is told of the lines of a shape: layer, colour and width."""
    return Outline(np.empty((0, 4, 2)), shape.layer, shape.colour, shape.width)


def _torn(line: BaseGeometry, overlay: _Overlay) -> list[BaseGeometry]:
    """What an overlay leaves of a line, segment by segment: of a line as a whole it makes one of what lies there
    twice."""
    points = shapely.get_coordinates(line)
    segments = shapely.linestrings(np.stack((points[:-1], points[1:]), axis=1))
    left = overlay(segments)
    chains: list[FloatArray] = []
    is_whole, is_gone = np.asarray(shapely.equals_exact(segments, left)), np.asarray(shapely.is_empty(left))
    breaks = np.flatnonzero((is_whole[1:] != is_whole[:-1]) | ~is_whole[1:]) + 1
    for first, last in pairwise([0, *breaks.tolist(), len(left)]):
        if is_whole[first]:
            chains.append(points[first : last + 1])
        elif not is_gone[first]:
            chains += _along(points[first], left[first])
    joined: list[list[FloatArray]] = []
    for chain in chains:
        if joined and np.array_equal(joined[-1][-1][-1], chain[0]):
            joined[-1].append(chain[1:])
        else:
            joined.append([chain])
    return [shapely.LineString(np.concatenate(parts)) for parts in joined]


def _along(start: FloatArray, left: BaseGeometry) -> list[FloatArray]:
    """The parts of a segment that begins there, in its direction."""
    parts = [part for part in shapely.get_parts(left) if shapely.get_dimensions(part) == 1 and not part.is_empty]
    ends = [sorted(shapely.get_coordinates(part), key=lambda end: float(np.hypot(*(end - start)))) for part in parts]
    return [np.array(part) for part in sorted(ends, key=lambda part: float(np.hypot(*(part[0] - start))))]


def _moved(region: BaseGeometry, affine: FloatArray) -> BaseGeometry:
    (a, c, e), (b, d, f) = affine.tolist()
    return affine_transform(region, [a, c, b, d, e, f])


def _without_paper(scene: Scene) -> Sequence[Shape]:
    """The shapes but for the first ones that are nothing but rectangles over all of the page, unless they are all."""
    width, height = scene.page_mm
    slack = _PAPER * max(width, height)
    page = shapely.box(slack, slack, width - slack, height - slack)
    for index, shape in enumerate(scene.shapes):
        is_paper = shape.fill is not None and shape.stroke is None and len(shape.outline) == 1
        if is_paper:
            area = filled(flatten_all(shape.outline, scene.user_to_page, 1e-3 * slack), is_even_odd=False)
            is_paper = area.area >= (1.0 - 1e-6) * area.envelope.area > 0.0 and all(
                shapely.covers(region, page)
                for region in (area, *(_moved(clip, scene.user_to_page) for clip in shape.clips))
            )
        if not is_paper:
            return scene.shapes[index:] if any(rest.shows for rest in scene.shapes[index:]) else scene.shapes
    return scene.shapes
