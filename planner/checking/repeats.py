"""How often each place is drawn, against how often the drawing has it there.

Within the tolerance, what is drawn in a disc belongs to lines of the drawing in a disc that is larger by the tolerance:
in no disc is there more pen path than there is line in the larger one. Discs are put along the whole pen path. Small
ones, little larger than the tolerance, find what is drawn twice even close beside other lines; what the drawing has
several times needs larger ones. Strokes too short to fill a disc, taps above all, are counted instead: as many strokes
pass there as there are outlines.

A line that the drawing has twice need be drawn only once: the paper looks the same.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.checking.polyline import DenseLines

_RADII = (1.6, 4.0, 10.0)
"""Of discs, in tolerances. A line drawn k + 1 times fills a disc of radius R by 2 (k + 1) R, where the drawing fills
the larger one by 2 k (R + tolerance): the radii tell k of 1, 2 and up to 5."""
_BITS_PER_RADIUS = 16
_MOST_BITS = 2_000_000
_SLACK = 1.08
"""Lengths are counted in bits, of which one may be more or less on each piece of line in a disc; and pens wobble."""
_DISCS_AT_ONCE = 50_000


@dataclass(frozen=True, slots=True)
class Repeat:
    """The place where the pen path is most above what it may be there: `figure` of `limit`, in `unit`.

    point: index into the pen path. remark: what the figure is.
    """

    point: int
    figure: float
    limit: float
    unit: str
    remark: str


@dataclass(frozen=True, eq=False, slots=True)
class _Lines:
    """Lines by their ends: the first and the last point of each, and their lengths."""

    first: IntArray
    last: IntArray
    length_mm: FloatArray

    @staticmethod
    def of(lines: DenseLines) -> _Lines:
        last = np.flatnonzero(~lines.joined)
        first = np.concatenate(([0], last[:-1] + 1))
        along = _along_mm(lines)
        return _Lines(first, last, along[last] - along[first])


def most_repeated(wanted: DenseLines, pen: DenseLines, is_extra: BoolArray, tolerance_mm: float) -> Repeat:
    """The worst disc, or the worst short stroke where one is drawn too often. Both have at least one point.

    is_extra: for each point of the pen path, whether it is beyond the tolerance and so belongs to no line.
    """
    strokes, outlines = _Lines.of(pen), _Lines.of(wanted)
    total_mm = float(max(strokes.length_mm.sum(), outlines.length_mm.sum()))
    least_mm = _BITS_PER_RADIUS * total_mm / _MOST_BITS
    radii_mm = sorted({max(radius * tolerance_mm, least_mm) for radius in _RADII})
    found = [
        _short_strokes(wanted, outlines, pen, strokes, is_extra, radii_mm[0], tolerance_mm),
        *(_discs(wanted, outlines, pen, strokes, is_extra, radius_mm, tolerance_mm) for radius_mm in radii_mm),
    ]
    return max(found, key=lambda one: one.figure / one.limit)


def _discs(
    wanted: DenseLines,
    outlines: _Lines,
    pen: DenseLines,
    strokes: _Lines,
    is_extra: BoolArray,
    radius_mm: float,
    tolerance_mm: float,
) -> Repeat:
    """Where ends of outlines touch within the tolerance they may be joined, by half of it each."""
    bit_mm = radius_mm / _BITS_PER_RADIUS
    pen_bits, source = _bits(pen, strokes, bit_mm, whole=True)
    pen_bits, source = pen_bits[~is_extra[source]], source[~is_extra[source]]
    if not len(pen_bits):
        return Repeat(0, 0.0, 1.0, "mm", "of line")
    pen_tree, wanted_tree = cKDTree(pen_bits), cKDTree(_bits(wanted, outlines, bit_mm, whole=False)[0])
    is_open = outlines.length_mm > 0
    ends_tree = cKDTree(wanted.points_mm[np.concatenate((outlines.first[is_open], outlines.last[is_open]))])
    worst = Repeat(0, 0.0, 1.0, "mm", "of line")
    centres = np.arange(0, len(pen_bits), _BITS_PER_RADIUS // 2)
    for start in range(0, len(centres), _DISCS_AT_ONCE):
        block = centres[start : start + _DISCS_AT_ONCE]
        places = pen_bits[block]
        drawn = _count_within(pen_tree, places, radius_mm) * bit_mm
        there = _count_within(wanted_tree, places, radius_mm + tolerance_mm) * bit_mm
        ends = _count_within(ends_tree, places, radius_mm + tolerance_mm)
        limit = _SLACK * there + ends * tolerance_mm / 2 + 2 * bit_mm
        index = int(np.argmax(drawn / limit))
        if drawn[index] / limit[index] > worst.figure / worst.limit:
            worst = Repeat(
                int(source[block[index]]),
                float(drawn[index]),
                float(limit[index]),
                "mm",
                f"of line within {radius_mm:.2g} mm",
            )
    return worst


def _short_strokes(
    wanted: DenseLines,
    outlines: _Lines,
    pen: DenseLines,
    strokes: _Lines,
    is_extra: BoolArray,
    radius_mm: float,
    tolerance_mm: float,
) -> Repeat:
    """For each stroke that is short, the strokes that pass its middle against the outlines that do. A longer stroke
    that ends there may be another piece of one that had to be split."""
    middles = (strokes.first + strokes.last) // 2
    short = np.flatnonzero((strokes.length_mm < 2 * radius_mm) & ~is_extra[middles])
    middle = middles[short]
    worst = Repeat(0, 0.0, 1.0, "strokes", "")
    if not len(short):
        return worst
    near_mm = tolerance_mm + strokes.length_mm[short] / 2
    pen_tree, wanted_tree = cKDTree(pen.points_mm), cKDTree(wanted.points_mm)
    stroke_of, outline_of = _labels(pen), _labels(wanted)
    is_short = np.zeros(len(strokes.first), dtype=np.bool_)
    is_short[short] = True
    is_end = np.zeros(len(pen.points_mm), dtype=np.bool_)
    is_end[strokes.first] = is_end[strokes.last] = True
    is_end &= ~is_short[stroke_of]
    for start in range(0, len(short), _DISCS_AT_ONCE):
        block = slice(start, start + _DISCS_AT_ONCE)
        places = pen.points_mm[middle[block]]
        passing = pen_tree.query_ball_point(places, near_mm[block])
        there = wanted_tree.query_ball_point(places, near_mm[block] + tolerance_mm)
        for place, pens, lines in zip(middle[block].tolist(), passing, there, strict=True):
            drawn = len(np.unique(stroke_of[pens]))
            limit = len(np.unique(outline_of[lines])) + int(np.count_nonzero(is_end[pens]))
            if drawn / max(limit, 1) > worst.figure / worst.limit:
                worst = Repeat(place, float(drawn), float(max(limit, 1)), "strokes", "at this short one")
    return worst


def _count_within(tree: cKDTree, places: FloatArray, radius_mm: float) -> IntArray:
    count: IntArray = np.asarray(tree.query_ball_point(places, radius_mm, return_length=True))
    return count


def _bits(lines: DenseLines, ends: _Lines, bit_mm: float, *, whole: bool) -> tuple[FloatArray, IntArray]:
    """(n, 2) the middles of the bits of a length that lines are cut into, and the point at or before each.

    whole: whether the rest at the end of a line is no bit, or one.
    """
    counts = np.floor(ends.length_mm / bit_mm + 1e-6) if whole else np.ceil(ends.length_mm / bit_mm - 1e-6)
    counts = counts.astype(np.int64)
    line = np.repeat(np.arange(len(counts)), counts)
    rank = np.arange(len(line)) - np.repeat(np.cumsum(counts) - counts, counts)
    along = _along_mm(lines)
    at = along[ends.first[line]] + (rank + 0.5) * (ends.length_mm / np.maximum(counts, 1))[line]
    before = np.clip(
        np.searchsorted(along, at, side="right") - 1,
        ends.first[line],
        np.maximum(ends.last[line] - 1, ends.first[line]),
    )
    after = np.minimum(before + 1, ends.last[line])
    step = along[after] - along[before]
    share = np.clip((at - along[before]) / np.where(step > 0, step, 1.0), 0.0, 1.0)[:, np.newaxis]
    return lines.points_mm[before] + share * (lines.points_mm[after] - lines.points_mm[before]), before


def _along_mm(lines: DenseLines) -> FloatArray:
    """(n,) length of all lines up to each point; from the end of a line to the next one is no length."""
    step = np.zeros(len(lines.points_mm))
    step[1:] = np.linalg.norm(np.diff(lines.points_mm, axis=0), axis=1) * lines.joined[:-1]
    along: FloatArray = np.cumsum(step)
    return along


def _labels(lines: DenseLines) -> IntArray:
    """(n,) the line of each point."""
    labels: IntArray = np.cumsum(np.concatenate(([0], (~lines.joined[:-1]).astype(np.int64))))
    return labels
