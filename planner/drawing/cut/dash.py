"""Dashed lines: their dashes as subpaths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from planner.arrays import FloatArray, frozen
from planner.drawing.cubics import part
from planner.drawing.cut.arc_length import ArcLength
from planner.drawing.subpath import Subpath, joined

MOST_DASHES = 100_000
"""Of the subpaths of one element together. A line with more is drawn solid: nobody would see its gaps."""
_SPECK = 1e-9
_SAME_PARAMETER = 1e-12


def dashed(
    subpaths: Sequence[Subpath], array: Sequence[float], offset: float, path_length: float | None = None
) -> list[Subpath]:
    """The dashes of all subpaths of one element, in its own units, before any transform.

    array: lengths of dashes and gaps in turn; an odd number of them counts twice over. offset: where in the pattern
    each subpath begins. path_length: the length that the author gives to all of the element, which array and offset
    are measured by; None for the true one. The pattern begins anew with each subpath, and a closed one has its last
    dash run on into its first where neither ends at the start point. A dash of no length is a dot. Each dash knows the
    gap after it. Subpaths come back as they are where there is no gap: an array that is empty, all zeros, or has a
    negative number; and where the dashes are too many.
    """
    if not array or min(array) < 0.0 or not sum(array) > 0.0 or not math.isfinite(sum(array)):
        return list(subpaths)
    lengths = [ArcLength.of(path.beziers) for path in subpaths]
    total = sum(length.total for length in lengths)
    pattern, shift = np.array(array if len(array) % 2 == 0 else [*array, *array], dtype=np.float64), offset
    if path_length is not None and path_length >= 0.0 and total > 0.0:
        # Of no length at all it makes whatever is in the pattern longer than any line.
        scale = total / path_length if path_length > 1e-12 * total else 1e12
        pattern, shift = scale * pattern, scale * offset
    if not math.isfinite(shift) or not total * len(pattern) / pattern.sum() < MOST_DASHES or not pattern[1::2].any():
        return list(subpaths)
    return [
        dash
        for path, length in zip(subpaths, lengths, strict=True)
        for dash in _dashes(path, length, pattern, shift % float(pattern.sum()))
    ]


def _dashes(path: Subpath, length: ArcLength, pattern: FloatArray, shift: float) -> list[Subpath]:
    """shift: where in the pattern the subpath begins, from 0 to less than the sum of the pattern."""
    total = length.total
    if total == 0.0:
        return [path]
    starts, ends = _seen(pattern, shift, total)
    if not len(starts):
        return []
    if starts[0] == 0.0 and ends[0] == total:
        return [path]
    dashes = _stretches(path, length, starts, ends)
    gaps = [gap.beziers for gap in _stretches(path, length, ends[:-1], starts[1:])]
    if not path.is_closed:
        return _with_gaps(dashes, gaps)
    if starts[0] == 0.0 and ends[-1] == total:
        first, *amid, last = dashes
        return _with_gaps([*amid, joined(last, first)], [*gaps[1:], gaps[0]])
    over_start = [
        stretch.beziers
        for stretch in _stretches(path, length, np.array([ends[-1], 0.0]), np.array([total, starts[0]]))
        if not stretch.is_dot
    ]
    return _with_gaps(dashes, [*gaps, np.concatenate(over_start)])


def _seen(pattern: FloatArray, shift: float, total: float) -> tuple[FloatArray, FloatArray]:
    """Where on a line of that length its dashes start and end; dashes without a gap between them are one."""
    n_periods = int((shift + total) // float(pattern.sum())) + 1
    borders = np.concatenate(([0.0], np.cumsum(np.tile(pattern, n_periods)))) - shift
    starts, ends = borders[:-1:2], borders[1::2]
    speck = _SPECK * total  # rounding must leave no speck of a dash at either end, and none of a gap
    is_dot = ends - starts <= speck
    is_seen = np.where(
        is_dot, (starts >= -speck) & (starts <= total + speck), (ends > speck) & (starts < total - speck)
    )
    starts, ends = np.maximum(starts[is_seen], 0.0), np.minimum(ends[is_seen], total)
    for borders in (starts, ends):  # both borders of a dot
        borders[borders <= speck] = 0.0
        borders[borders >= total - speck] = total
    has_gap = starts[1:] - ends[:-1] > speck
    return np.append(starts[:1], starts[1:][has_gap]), np.append(ends[:-1][has_gap], ends[-1:])


def _stretches(path: Subpath, length: ArcLength, starts: FloatArray, ends: FloatArray) -> list[Subpath]:
    """The parts of a subpath between lengths (n,) along it; one without a length is a dot."""
    if not len(starts):
        return []
    last = len(path.beziers) - 1
    first_curve, first_t = length.places(starts)
    last_curve, last_t = length.places(ends)
    is_next = (first_t >= 1.0 - _SAME_PARAMETER) & (first_curve < last)
    first_curve, first_t = first_curve + is_next, np.where(is_next, 0.0, first_t)
    is_before = (last_t <= _SAME_PARAMETER) & (last_curve > 0)
    last_curve, last_t = last_curve - is_before, np.where(is_before, 1.0, last_t)
    first_t[starts == 0.0], last_t[ends == length.total] = 0.0, 1.0
    counts = np.maximum(last_curve - first_curve + 1, 1)
    stretch = np.repeat(np.arange(len(starts)), counts)
    index = np.arange(len(stretch)) - np.repeat(np.cumsum(counts) - counts, counts)
    curve = first_curve[stretch] + index
    start = np.where(index == 0, first_t[stretch], 0.0)
    end = np.where(index == counts[stretch] - 1, last_t[stretch], 1.0)
    beziers = part(path.beziers[curve], start, end)
    is_dot = (ends <= starts)[stretch]
    beziers[is_dot] = beziers[is_dot, :1]
    is_vertex = path.is_vertex[curve] | (end < 1.0)
    breaks = np.cumsum(counts)[:-1]
    return [
        Subpath(frozen(one), False, vertices)
        for one, vertices in zip(np.split(beziers, breaks), np.split(is_vertex, breaks), strict=True)
    ]


def _with_gaps(dashes: Sequence[Subpath], gaps: Sequence[FloatArray]) -> list[Subpath]:
    """gaps: those after the dashes, in order; the last dash may have none. Each is made to end exactly where dashes
    do."""
    with_gaps = list(dashes)
    for index, gap in enumerate(gaps):
        exact = gap.copy()
        exact[0, 0], exact[-1, 3] = dashes[index].beziers[-1, 3], dashes[(index + 1) % len(dashes)].beziers[0, 0]
        with_gaps[index] = replace(dashes[index], gap=frozen(exact))
    return with_gaps
