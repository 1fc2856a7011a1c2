"""Closed strokes are drawn on the way of a stroke that touches them, so that the pen need not be lifted for them.

A drawing takes as many strokes as half the number of places where an odd number of line ends meet, and one for each
part that has none (Euler, 1736). A line that ends on the middle of an open one leaves that number as it is, whatever
way the two are led; a closed stroke that is touched anywhere, by an end, a middle or another closed one, saves one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.drawing.ink import Ink
from planner.drawing.join import LEAST_ROUND, is_closed
from planner.polyline_length import polyline_length

_AT_ONCE = 500
"""Closed strokes whose neighbours are looked for together."""
_ROUNDING_MM = 1e-9
"""Points nearer than this to the one before are the same: a way of that length has no direction."""


@dataclass(frozen=True, slots=True)
class _Touch:
    """Where a closed stroke is near another stroke: how far along its own length, and along the other's, in mm."""

    closed: int
    other: int
    own_mm: float
    other_mm: float


def with_loops(strokes: Sequence[FloatArray], ink: Ink, tolerance_mm: float) -> list[FloatArray]:
    """Strokes (n, 2) in which closed ones that are within `tolerance_mm` of another stroke are drawn on its way.

    Each line is drawn once, and the way across to a closed stroke to and fro. What is open stays a stroke of its own,
    with its ends. The longer strokes grow so in place; no stroke changes that touches none. ink: what of the strokes
    is line, and may be touched.
    """
    is_loop = [is_closed(stroke) or _is_nearly_closed(stroke, tolerance_mm) for stroke in strokes]
    if not any(is_loop) or len(strokes) < 2:
        return list(strokes)
    given = strokes
    strokes = [
        np.concatenate((stroke, stroke[:1])) if loop and not is_closed(stroke) else stroke
        for stroke, loop in zip(given, is_loop, strict=True)
    ]
    neighbours: dict[int, list[tuple[int, float, float]]] = {}
    group = list(range(len(strokes)))
    has_open = [not loop and len(stroke) > 1 for loop, stroke in zip(is_loop, strokes, strict=True)]
    for touch in _touches(strokes, ink, np.flatnonzero(is_loop), tolerance_mm):
        one, other = _root(group, touch.closed), _root(group, touch.other)
        if one == other or (has_open[one] and has_open[other]):
            continue
        first, second = min(one, other), max(one, other)
        group[second] = first
        has_open[first] |= has_open[second]
        neighbours.setdefault(touch.closed, []).append((touch.other, touch.own_mm, touch.other_mm))
        neighbours.setdefault(touch.other, []).append((touch.closed, touch.other_mm, touch.own_mm))
    members: dict[int, list[int]] = {}
    for index in range(len(strokes)):
        members.setdefault(_root(group, index), []).append(index)
    whole = []
    for part in members.values():
        carrier = next((index for index in part if not is_loop[index]), part[0])
        whole.append(_led_through(strokes, neighbours, carrier) if len(part) > 1 else given[carrier])
    return whole


def _is_nearly_closed(stroke: FloatArray, tolerance_mm: float) -> bool:
    """Whether the ends of a stroke may be joined, and enclose more than what is no larger than their gap may be."""
    if len(stroke) < 3 or float(np.hypot(*(stroke[-1] - stroke[0]))) > tolerance_mm * (1.0 + 1e-9):
        return False
    return polyline_length(stroke) > LEAST_ROUND * tolerance_mm


def _root(group: list[int], index: int) -> int:
    while group[index] != index:
        group[index] = group[group[index]]
        index = group[index]
    return index


def _touches(strokes: Sequence[FloatArray], ink: Ink, loops: IntArray, tolerance_mm: float) -> list[_Touch]:
    """Where closed strokes are near others: the nearest first, so that no way across leads over a line between them.
    Of those that are as near, first where others end, as there the pen comes to rest anyway."""
    import shapely  # heavy, and drawings without closed strokes need none of it

    lines = np.array([shapely.LineString(stroke if len(stroke) > 1 else stroke[[0, 0]]) for stroke in strokes])
    drawn = lines.copy()
    is_gap = np.split(ink.gaps_of(strokes), np.cumsum([len(stroke) - 1 for stroke in strokes])[:-1])
    for index in [index for index, some in enumerate(is_gap) if some.any()]:
        parts = np.split(strokes[index], np.flatnonzero(is_gap[index]) + 1)
        drawn[index] = shapely.MultiLineString([part for part in parts if len(part) > 1])
    is_closed_one = np.zeros(len(strokes), dtype=np.bool_)
    is_closed_one[loops] = True
    is_open = np.array([len(stroke) > 1 for stroke in strokes]) & ~is_closed_one
    opened = np.flatnonzero(is_open)
    within_mm = tolerance_mm * (1.0 + 1e-9)
    ends = np.asarray(shapely.points(np.array([strokes[index][[0, -1]] for index in opened.tolist()]).reshape(-1, 2)))
    others = np.flatnonzero(is_open | is_closed_one)  # a tap is no line to be led on
    touches: list[_Touch] = []
    gaps: list[FloatArray] = []
    for owners, targets, owner_mm in (
        (np.repeat(opened, 2), ends, np.stack([np.zeros(len(opened)), shapely.length(lines[opened])], axis=1).ravel()),
        (others, drawn[others], None),
    ):
        if not len(targets):
            continue
        tree = shapely.STRtree(targets)
        for begin in range(0, len(loops), _AT_ONCE):
            block = loops[begin : begin + _AT_ONCE]
            row, target = tree.query(drawn[block], predicate="dwithin", distance=within_mm)
            closed, other = block[row], owners[target]
            # Of two closed ones, one alone asks.
            is_asked = (closed != other) & ~(is_closed_one[other] & (other < closed))
            closed, other, target = closed[is_asked], other[is_asked], target[is_asked]
            between = shapely.shortest_line(drawn[closed], targets[target])
            own_mm = shapely.line_locate_point(lines[closed], shapely.get_point(between, 0))
            other_mm = (
                shapely.line_locate_point(lines[other], shapely.get_point(between, 1))
                if owner_mm is None
                else owner_mm[target]
            )
            touches += map(_Touch, closed.tolist(), other.tolist(), own_mm.tolist(), other_mm.tolist())
            gaps.append(np.round(shapely.length(between) / _ROUNDING_MM))
    nearest = np.argsort(np.concatenate(gaps), kind="stable") if gaps else np.empty(0, dtype=np.int64)
    return [touches[index] for index in nearest.tolist()]


def _led_through(
    strokes: Sequence[FloatArray], neighbours: dict[int, list[tuple[int, float, float]]], carrier: int
) -> FloatArray:
    """(n, 2) the way along a stroke, with a way round each closed one where it is touched, and so on from these."""
    pieces: list[FloatArray] = []
    is_drawn = {carrier}
    ways = [_way(strokes[carrier], neighbours[carrier], None)]
    while ways:
        part = next(ways[-1], None)
        if part is None:
            ways.pop()
            continue
        points, at = part
        pieces.append(points)
        if at is not None and at[0] not in is_drawn:
            index, on_mm = at
            is_drawn.add(index)
            ways.append(_gentler_way(strokes[index], neighbours[index], on_mm, _heading(pieces)))
    whole = np.concatenate(pieces)
    is_new = np.concatenate(([True], np.abs(np.diff(whole, axis=0)).max(axis=1) > _ROUNDING_MM))
    led: FloatArray = whole[is_new]
    led[-1] = whole[-1]
    return led


def _heading(pieces: Sequence[FloatArray]) -> FloatArray:
    """(2,) where the way goes at its end, of any length."""
    for points in reversed(pieces):
        steps = np.diff(points, axis=0)
        moved = np.flatnonzero(steps.any(axis=1))
        if len(moved):
            heading: FloatArray = steps[moved[-1]]
            return heading
    return np.zeros(2)


def _gentler_way(
    stroke: FloatArray, touched: Sequence[tuple[int, float, float]], from_mm: float, heading: FloatArray
) -> Iterator[tuple[FloatArray, tuple[int, float] | None]]:
    """The way round a closed stroke in the direction that turns less from where the pen is heading."""
    arc = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))))
    step = 1e-3 * arc[-1]
    ahead, behind = (_at(stroke, arc, (from_mm + by) % arc[-1]) for by in (step, -step))
    if (ahead - behind) @ heading < 0.0:
        stroke, from_mm = stroke[::-1], arc[-1] - from_mm
        touched = [(index, arc[-1] - at_mm, on_mm) for index, at_mm, on_mm in touched]
    return _way(stroke, touched, from_mm)


def _way(
    stroke: FloatArray, touched: Sequence[tuple[int, float, float]], from_mm: float | None
) -> Iterator[tuple[FloatArray, tuple[int, float] | None]]:
    """A stroke in parts, each but the last with the closed stroke that is to be drawn after it, and from where on
    that. from_mm: where a closed one begins; None for one from its start to its end."""
    arc = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))))
    begin = 0.0 if from_mm is None else from_mm
    around = arc[-1]
    stops = sorted((at_mm if at_mm >= begin else at_mm + around, index, on_mm) for index, at_mm, on_mm in touched)
    if from_mm is not None:
        stroke, arc = np.concatenate((stroke, stroke[1:])), np.concatenate((arc, around + arc[1:]))
    last = begin
    for at_mm, index, on_mm in chain(stops, [(begin + around if from_mm is not None else around, None, 0.0)]):
        inside = (arc > last) & (arc < at_mm)
        ends = [_at(stroke, arc, place) for place in (last, at_mm)]
        yield np.concatenate((ends[0][None], stroke[inside], ends[1][None])), None if index is None else (index, on_mm)
        last = at_mm


def _at(stroke: FloatArray, arc: FloatArray, place_mm: float) -> FloatArray:
    """(2,) the point so far along; the stroke's own where it is one of these but for rounding."""
    nearest = int(np.argmin(np.abs(arc - place_mm)))
    if abs(arc[nearest] - place_mm) <= 1e-9 * max(arc[-1], 1.0):
        point: FloatArray = stroke[nearest]
        return point
    return np.array([np.interp(place_mm, arc, column) for column in stroke.T])
