"""Ends that are apart, but near the same place of a line, are joined over that place.

Such as the ends of two lines that meet a third from both sides: what is between them is on paper already, so the pen
need not be lifted there. An end that meets the middle of a line alone wins nothing: a drawing takes as many strokes as
half the number of places where an odd number of line ends meet, whichever way these are led (Euler, 1736).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.drawing.ink import Ink
from planner.drawing.join import LEAST_ROUND, chained, free_ends
from planner.drawing.nearest import NearestPoints
from planner.polyline_length import polyline_length

_NEIGHBOURS = 8
"""Other ends that each end may be joined to."""
_CROWD = 64
"""An end with so many others about is left alone, so that a place where thousands meet takes no quadratic work."""
_AT_ONCE = 100_000
"""Ways over pieces of lines that are measured together."""


@dataclass(frozen=True, slots=True)
class Leaps:
    """How far it may be from an end to the line that it is joined over, in mm.

    wide: from an end that is on the line, along it. through_air: from one that is not. on_line: how far off the line
    an end is that is on it.
    """

    wide: float
    through_air: float
    on_line: float


def join_over_lines(strokes: Sequence[FloatArray], ink: Ink, leaps: Leaps) -> list[FloatArray]:
    """Strokes (n, 2) of which ends are joined over a point of one of them, the shortest ways first.

    ink: what of them is line, for the point is on one.
    No line is drawn less, and there are never more strokes. The ends of one stroke may be joined over another one: it
    is closed then, and touches that.
    """
    free = free_ends(strokes)
    partner = np.full(2 * len(strokes), -1, dtype=np.int64)
    over: dict[int, FloatArray] = {}
    if len(free) < 2:
        return list(strokes)
    points = np.array([(stroke[0], stroke[-1]) for stroke in strokes]).reshape(-1, 2)
    one, other = _neighbours(free, points, max(leaps.wide, leaps.through_air))
    if len(one):
        ways = list(_ways(strokes, ink, points, one, other, leaps))
        length, pair, place = (np.concatenate(column) for column in zip(*ways, strict=True))
        for index in np.lexsort((pair, np.round(length, 9))).tolist():
            a, b = int(one[pair[index]]), int(other[pair[index]])
            if partner[a] < 0 and partner[b] < 0:
                partner[a], partner[b] = b, a
                over[a] = over[b] = place[index]
    return chained(strokes, partner, over)


def _neighbours(free: IntArray, points: FloatArray, leap_mm: float) -> tuple[IntArray, IntArray]:
    """Pairs of ends, each once, that two leaps may join."""
    gaps, others = NearestPoints(points[free]).query(points[free], min(_CROWD, len(free)))
    is_near = gaps <= 2.0 * leap_mm * (1.0 + 1e-9)
    is_crowded = is_near.sum(axis=1) >= _CROWD
    is_near[is_crowded] = False
    rows, columns = np.nonzero(is_near[:, : _NEIGHBOURS + 1] & ~is_crowded[others[:, : _NEIGHBOURS + 1]])
    one, other = np.sort((free[rows], free[others[rows, columns]]), axis=0)
    keys = np.sort((one * len(points) + other)[one != other])
    one, other = np.divmod(keys[np.diff(keys, prepend=-1) > 0], len(points))  # np.unique loads masked arrays
    return one, other


def _ways(
    strokes: Sequence[FloatArray], ink: Ink, points: FloatArray, one: IntArray, other: IntArray, leaps: Leaps
) -> Iterator[tuple[FloatArray, IntArray, FloatArray]]:
    """Lengths of the ways that are allowed, for which pair each is, and the points (n, 2) that they go over."""
    import shapely  # heavy, and where ends are far from each other none of it is needed

    is_line = ~ink.gaps_of(strokes)
    begins, ends = (
        np.concatenate([stroke[part] for stroke in strokes])[is_line] for part in (slice(None, -1), slice(1, None))
    )
    owner = np.repeat(np.arange(len(strokes)), [len(stroke) - 1 for stroke in strokes])[is_line]
    leap_mm = max(leaps.wide, leaps.through_air) * (1.0 + 1e-9)
    is_way_round = np.array([polyline_length(stroke) > LEAST_ROUND * leap_mm for stroke in strokes])
    pieces = np.asarray(shapely.linestrings(np.stack((begins, ends), axis=1)))
    asked, row = np.unique(one, return_inverse=True)
    found = shapely.STRtree(pieces).query(shapely.points(points[asked]), predicate="dwithin", distance=leap_mm)
    # The pieces near the first end of each pair, one after the other.
    count = np.bincount(found[0], minlength=len(asked))
    first = np.cumsum(count) - count
    near = found[1][np.argsort(found[0], kind="stable")]
    for begin, end in _blocks(count[row]):
        pair = np.repeat(np.arange(begin, end), count[row[begin:end]])
        within = np.arange(len(pair)) - np.repeat(
            np.cumsum(count[row[begin:end]]) - count[row[begin:end]], count[row[begin:end]]
        )
        piece = near[first[row[pair]] + within]
        # The ends of one stroke need another one to be joined over, and a way round that is longer than the way over.
        stroke = one[pair] // 2
        is_other = (stroke != other[pair] // 2) | ((owner[piece] != stroke) & is_way_round[stroke])
        pair, piece = pair[is_other], piece[is_other]
        a, b = points[one[pair]], points[other[pair]]
        place, is_near = _over(a, b, begins[piece], ends[piece], leaps)
        length = np.hypot(*(place - a).T) + np.hypot(*(place - b).T)
        yield length[is_near], pair[is_near], place[is_near]


def _blocks(counts: IntArray) -> Iterator[tuple[int, int]]:
    """Ranges of what has so many parts each, of a bounded number of parts."""
    begin, total = 0, np.concatenate(([0], np.cumsum(counts)))
    while begin < len(counts):
        end = max(int(np.searchsorted(total, total[begin] + _AT_ONCE, side="right")) - 1, begin + 1)
        yield begin, end
        begin = end


def _over(
    one: FloatArray, other: FloatArray, begin: FloatArray, end: FloatArray, leaps: Leaps
) -> tuple[FloatArray, BoolArray]:
    """For each piece of line from `begin` to `end`, all (n, 2): its point on the shortest way over it, and whether both
    leaps are allowed."""
    along = end - begin
    size: FloatArray = np.hypot(*along.T)
    along = along / np.where(size > 0.0, size, 1.0)[:, None]
    across = np.stack((-along[:, 1], along[:, 0]), axis=1)
    at, off = (np.stack([((point - begin) * unit).sum(axis=1) for point in (one, other)]) for unit in (along, across))
    # As light is reflected: the ways there and back are as steep as each other.
    height = np.abs(off)
    total = height.sum(axis=0)
    share = np.where(total > 0.0, height[0] / np.where(total > 0.0, total, 1.0), 0.5)
    turn = np.clip(at[0] + share * (at[1] - at[0]), 0.0, size)
    leap = np.hypot(at - turn, height)
    beside = np.hypot(at - np.clip(at, 0.0, size), height)
    most = np.where(beside <= leaps.on_line, max(leaps.wide, leaps.through_air), leaps.through_air)
    return begin + turn[:, None] * along, (leap <= most * (1.0 + 1e-9)).all(axis=0)
