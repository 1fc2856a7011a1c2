"""Tone by parallel lines: the darker, the more of them."""

from __future__ import annotations

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray, IntArray
from planner.drawing.image.chains import chained
from planner.drawing.image.tones import Tones
from planner.errors import PlanError

_MOST_SAMPLES = 20_000_000
_BITS = 16
_JOINED_FROM = 0.5
"""The tone from which on the short ways between neighbouring lines are drawn: they hardly show there."""


def hatching(tones: Tones, shape: BaseGeometry, line_mm: float, least_mm: float, angle_rad: float) -> list[FloatArray]:
    """Lines (n, 2), mm, on rows a line's width apart, of which each is drawn where it is darker than its own threshold.

    The thresholds run through van der Corput's sequence: of any rows in a row, a share as large as the tone is drawn,
    as evenly spread as can be. Lines stop short by half the width of the pen's line, which is what their round ends
    add. least_mm: shorter lines are not drawn, and shorter gaps are not left. Errors: PlanError for too many lines.
    """
    turn = np.array([[np.cos(angle_rad), np.sin(angle_rad)], [-np.sin(angle_rad), np.cos(angle_rad)]])
    level = shapely.transform(shape, lambda points: points @ turn.T)
    left, low, right, high = level.bounds
    rows = np.arange(np.ceil(low / line_mm - 0.5), np.floor(high / line_mm - 0.5) + 1)
    n_across = int(np.ceil((right - left) / tones.pitch_mm)) + 1
    if len(rows) * n_across > _MOST_SAMPLES:
        raise PlanError("a picture would take too many lines: choose a wider --image-line")
    if not len(rows):
        return []
    heights, across = (rows + 0.5) * line_mm, np.linspace(left, right, n_across)
    grid = np.stack(np.broadcast_arrays(across, heights[:, None]), axis=-1).reshape(-1, 2)
    excess = tones.at(grid @ turn).reshape(len(rows), n_across) - _thresholds(rows.astype(np.int64))[:, None]
    row, begin, end = _runs(excess, left, across[1] - left if n_across > 1 else 1.0, least_mm)
    begin, end = begin + line_mm / 2, end - line_mm / 2
    ends = np.stack((np.stack((begin, heights[row]), axis=1), np.stack((end, heights[row]), axis=1)), axis=1)
    parts, owner = shapely.get_parts(shapely.intersection(shapely.linestrings(ends), level), return_index=True)
    is_line = shapely.length(parts) > max(least_mm - line_mm, 0.0)
    spans = [np.sort(np.asarray(part.coords)[[0, -1], 0]) for part in parts[is_line]]
    segments = list(zip(row[owner[is_line]].tolist(), spans, strict=True))
    shapely.prepare(level)

    def may_draw(way: shapely.LineString) -> bool:
        middle = np.asarray(way.coords).mean(axis=0, keepdims=True) @ turn
        return bool(tones.at(middle)[0] >= _JOINED_FROM and level.covers(way))

    return [chain @ turn for chain in chained(segments, heights, may_draw, line_mm)]


def _thresholds(rows: IntArray) -> FloatArray:
    """(n,) between 0 and 1: the bits of a row's number the other way round."""
    found = np.zeros(len(rows))
    for bit in range(_BITS):
        found += ((rows >> bit) & 1) * 0.5 ** (bit + 1)
    return found + 0.5 ** (_BITS + 1)


def _runs(excess: FloatArray, left: float, step_mm: float, least_mm: float) -> tuple[IntArray, FloatArray, FloatArray]:
    """Row, begin and end of where values on rows are above 0; shorter gaps than `least_mm` are drawn over, and what is
    then as short itself is left out."""
    n_rows, n_across = excess.shape
    is_in = np.zeros((n_rows, n_across + 2), dtype=np.int8)
    is_in[:, 1:-1] = excess > 0.0
    row, at = np.nonzero(np.diff(is_in, axis=1))
    # Where the value passes 0 between the samples before and at an edge.
    before, after = excess[row, np.maximum(at - 1, 0)], excess[row, np.minimum(at, n_across - 1)]
    is_inner = (at > 0) & (at < n_across)
    share = np.where(is_inner, -before / np.where(is_inner, after - before, 1.0), 1.0)
    place = left + step_mm * np.clip(at - 1 + share, 0.0, n_across - 1)
    row, begin, end = row[0::2], place[0::2], place[1::2]
    is_joined = (row[1:] == row[:-1]) & (begin[1:] - end[:-1] < least_mm)
    row, begin, end = (
        row[np.append(True, ~is_joined)[: len(row)]],
        begin[np.append(True, ~is_joined)[: len(row)]],
        end[np.append(~is_joined, True)[: len(row)]],
    )
    is_long = end - begin >= least_mm
    return row[is_long], begin[is_long], end[is_long]
