"""What people who plot do to paths before they are drawn: doubled lines and points dropped, lines drawn again.

Strokes are polylines (n, 2) in mm on the paper; a tap is one of a single point.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.drawing.join import is_closed
from planner.polyline_length import polyline_length

_PARALLEL = 0.98
"""Cosine of the largest angle between lines that are the same one."""
_FEWEST = 8
"""Points in a row that have to be doubled for that to count: less is a crossing."""
_MOST_POINTS = 2_000_000
_AT_ONCE = 20_000


def simplified(strokes: Sequence[FloatArray], within_mm: float) -> list[FloatArray]:
    """Strokes with as few of their points as keep them within `within_mm` (Douglas and Peucker, 1973)."""
    import shapely

    found = list(strokes)
    lines = [index for index, stroke in enumerate(strokes) if len(stroke) > 2]
    shapes = shapely.simplify(
        [shapely.LineString(strokes[index]) for index in lines], within_mm, preserve_topology=False
    )
    for index, shape in zip(lines, shapes, strict=True):
        found[index] = np.asarray(shape.coords)[:, :2]
    return found


def longer(strokes: Sequence[FloatArray], least_mm: float) -> tuple[list[FloatArray], list[FloatArray]]:
    """Strokes that are at least so long, and those that are not; taps are no short strokes."""
    is_kept = [len(stroke) == 1 or polyline_length(stroke) >= least_mm for stroke in strokes]
    return (
        [stroke for stroke, kept in zip(strokes, is_kept, strict=True) if kept],
        [stroke for stroke, kept in zip(strokes, is_kept, strict=True) if not kept],
    )


def repeated(strokes: Sequence[FloatArray], passes: int) -> list[FloatArray]:
    """Each stroke so many times without a lift: closed ones round and round, others to and fro."""
    if passes == 1:
        return list(strokes)
    found = []
    for stroke in strokes:
        again = stroke if is_closed(stroke) else stroke[::-1]
        ways = [stroke, *((again if number % 2 else stroke)[1:] for number in range(1, passes))]
        found.append(stroke if len(stroke) == 1 else np.concatenate(ways))
    return found


def without_doubles(strokes: Sequence[FloatArray], within_mm: float) -> tuple[list[FloatArray], float]:
    """Strokes without what runs within `within_mm` beside what is kept already, the same way or the other, and how many
    mm that was. Taps stay, but for those upon each other."""
    dense = _Dense.of(strokes, within_mm)
    is_double = _doubled(dense, within_mm)
    kept: list[FloatArray] = []
    dropped_mm = 0.0
    for index, stroke in enumerate(strokes):
        part = slice(dense.first[index], dense.first[index + 1])
        doubled = is_double[part]
        if not doubled.any():
            kept.append(stroke)
        elif len(stroke) > 1:
            pieces = _pieces(stroke, dense.along_mm[part], doubled)
            kept += pieces
            dropped_mm += polyline_length(stroke) - sum(map(polyline_length, pieces))
    return kept, dropped_mm


@dataclass(frozen=True, eq=False, slots=True)
class _Dense:
    """Points evenly spaced along all strokes. first: where each stroke's begin, and the end of all. along_mm: arc
    length in its stroke. direction: unit vectors, zero for taps. spacing_mm: between neighbours, at most."""

    points_mm: FloatArray
    first: IntArray
    along_mm: FloatArray
    direction: FloatArray
    spacing_mm: float

    @staticmethod
    def of(strokes: Sequence[FloatArray], spacing_mm: float) -> _Dense:
        total_mm = sum(map(polyline_length, strokes))
        spacing_mm = max(spacing_mm, total_mm / _MOST_POINTS)
        points, alongs, directions, counts = [], [], [], []
        for stroke in strokes:
            steps = np.hypot(*np.diff(stroke, axis=0).T)
            arc = np.concatenate(([0.0], np.cumsum(steps)))
            along = np.linspace(0.0, arc[-1], max(int(np.ceil(arc[-1] / spacing_mm)), 1) + (len(stroke) > 1))
            place = np.stack([np.interp(along, arc, column) for column in stroke.T], axis=1)
            heading = np.gradient(place, axis=0) if len(place) > 1 else np.zeros_like(place)
            norm: FloatArray = np.linalg.norm(heading, axis=1, keepdims=True)
            points.append(place)
            alongs.append(along)
            directions.append(heading / np.where(norm > 0.0, norm, 1.0))
            counts.append(len(along))
        first = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
        return _Dense(np.concatenate(points), first, np.concatenate(alongs), np.concatenate(directions), spacing_mm)


def _doubled(dense: _Dense, within_mm: float) -> BoolArray:
    """(n,) whether each point lies beside one that comes before and is kept."""
    owner = np.repeat(np.arange(len(dense.first) - 1), np.diff(dense.first))
    from scipy.spatial import cKDTree  # heavy, and few ask for it

    tree = cKDTree(dense.points_mm)
    reach_mm = float(np.hypot(within_mm, 0.5 * dense.spacing_mm))
    is_double = np.zeros(len(dense.points_mm), dtype=np.bool_)
    for begin in range(0, len(is_double), _AT_ONCE):
        block = cKDTree(dense.points_mm[begin : begin + _AT_ONCE])
        near = block.sparse_distance_matrix(tree, reach_mm, output_type="ndarray")
        near = near[near["j"] < begin + near["i"]]
        near = near[np.argsort(near["i"], kind="stable")]  # what is dropped drops nothing after it
        point, other = begin + near["i"], near["j"]
        same = owner[point] == owner[other]
        apart = np.abs(dense.along_mm[point] - dense.along_mm[other]) > 2.0 * _FEWEST * within_mm
        parallel = np.abs((dense.direction[point] * dense.direction[other]).sum(axis=1)) >= _PARALLEL
        both_taps = ~dense.direction[point].any(axis=1) & ~dense.direction[other].any(axis=1)
        # Between two points the other line is nearer than to either of them: what counts is how far it passes by.
        gone = dense.points_mm[point] - dense.points_mm[other]
        gone_by = np.hypot(*(gone - (gone * dense.direction[other]).sum(axis=1)[:, None] * dense.direction[other]).T)
        is_earlier = (~same | apart) & (parallel | both_taps) & (gone_by <= within_mm)
        for at, before in zip(point[is_earlier].tolist(), other[is_earlier].tolist(), strict=True):
            if not is_double[before]:
                is_double[at] = True
    return _long_runs(is_double, dense.first)


def _long_runs(is_double: BoolArray, first: IntArray) -> BoolArray:
    """Runs of at least some points, or of a whole stroke: shorter ones are crossings."""
    found = np.zeros_like(is_double)
    for begin, end in zip(first[:-1].tolist(), first[1:].tolist(), strict=True):
        part = is_double[begin:end]
        edges = np.flatnonzero(np.diff(np.concatenate(([0], part.astype(np.int8), [0]))))
        for start, stop in zip(edges[0::2].tolist(), edges[1::2].tolist(), strict=True):
            if stop - start >= min(_FEWEST, end - begin):
                found[begin + start : begin + stop] = True
    return found


def _pieces(stroke: FloatArray, along_mm: FloatArray, doubled: BoolArray) -> list[FloatArray]:
    """What of a stroke is not doubled, with its own points."""
    arc = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))))
    edges = np.flatnonzero(np.diff(np.concatenate(([0], (~doubled).astype(np.int8), [0]))))
    pieces = []
    for start, stop in zip(edges[0::2].tolist(), edges[1::2].tolist(), strict=True):
        low, high = along_mm[max(start - 1, 0)], along_mm[min(stop, len(along_mm) - 1)]
        inside = (arc > low) & (arc < high)
        ends = [np.array([np.interp(at, arc, column) for column in stroke.T]) for at in (low, high)]
        pieces.append(np.concatenate((ends[0][None], stroke[inside], ends[1][None])))
    return [piece for piece in pieces if polyline_length(piece) > 0.0]
