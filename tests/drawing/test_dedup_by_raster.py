"""Lines that are drawn once in place of twice, judged by pixels: no ink is lost, and none is left twice."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image, ImageDraw
from scipy.spatial import KDTree

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.drawing.path_work import without_doubles

PX_MM = 0.02
WITHIN_MM = 0.2
SIZE_MM = 30.0
_RIM_MM = 2.0


def pixels(strokes: Sequence[FloatArray]) -> BoolArray:
    """Where there is ink of the thinnest pen."""
    side = int((SIZE_MM + 2 * _RIM_MM) / PX_MM)
    picture = Image.new("1", (side, side))
    draw = ImageDraw.Draw(picture)
    for stroke in strokes:
        draw.line([tuple(point) for point in ((stroke + _RIM_MM) / PX_MM).tolist()], fill=1)
    return np.array(picture)


def from_ink_mm(places_px: IntArray, ink: BoolArray) -> FloatArray:
    """How far pixels (n, 2) are from the nearest one with ink: (n,), infinite where there is none. Asked of the few
    pixels of lines: a map of all distances takes a hundred times as long."""
    inked = np.argwhere(ink)
    if not len(inked):
        return np.full(len(places_px), np.inf)
    distances: FloatArray = KDTree(inked).query(places_px)[0] * PX_MM
    return distances


def lost_mm(before: Sequence[FloatArray], after: Sequence[FloatArray]) -> float:
    """How far the ink of `before` is at most from that of `after`."""
    return float(from_ink_mm(np.argwhere(pixels(before)), pixels(after)).max(initial=0.0))


def twice_mm(strokes: Sequence[FloatArray]) -> float:
    """The longest way that a stroke runs beside others, on one side within what was asked for, in mm."""
    longest = 0.0
    for index, stroke in enumerate(strokes):
        others = pixels([other for number, other in enumerate(strokes) if number != index])
        arc = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))))
        along = np.arange(0.0, arc[-1], PX_MM)
        places = np.stack([np.interp(along, arc, column) for column in stroke.T], axis=1)
        at = np.round((places + _RIM_MM) / PX_MM).astype(int)
        beside = from_ink_mm(at[:, ::-1], others) <= 0.8 * WITHIN_MM
        edges = np.flatnonzero(np.diff(np.concatenate(([0], beside.astype(np.int8), [0]))))
        longest = max([longest, *((edges[1::2] - edges[0::2]) * PX_MM).tolist()])
    return longest


def wave(seed: int) -> FloatArray:
    """A smooth line across the sheet."""
    rng = np.random.default_rng(seed)
    x = np.linspace(2.0, 28.0, 300)
    y = 15.0 + sum(rng.uniform(-2.0, 2.0) * np.sin(k * x / 8.0 + rng.uniform(0, 6)) for k in (1, 2, 3))
    return np.column_stack((x, y))


def beside(line: FloatArray, by_mm: float) -> FloatArray:
    heading = np.gradient(line, axis=0)
    heading /= np.hypot(*heading.T)[:, None]
    return line + by_mm * np.column_stack((-heading[:, 1], heading[:, 0]))


@settings(deadline=None, max_examples=15)
@given(
    seed=st.integers(0, 10**6),
    by_mm=st.floats(-0.14, 0.14),
    part=st.tuples(st.integers(0, 120), st.integers(180, 299)),
    backwards=st.booleans(),
    strays=st.booleans(),
)
def test_no_ink_is_lost_and_none_left_twice(
    seed: int, by_mm: float, part: tuple[int, int], backwards: bool, strays: bool
) -> None:
    line = wave(seed)
    other = beside(line, by_mm)[part[0] : part[1]]
    if strays:  # and leaves the first line for a place of its own
        other = np.concatenate((other, other[-1] + np.linspace(0.05, 4.0, 50)[:, None] * np.array([0.0, 1.0])))
    strokes = [line, other[::-1] if backwards else other]
    assert twice_mm(strokes) > 3.0
    kept, dropped_mm = without_doubles(strokes, WITHIN_MM)
    assert dropped_mm > 1.0
    assert lost_mm(strokes, kept) <= WITHIN_MM + 2 * PX_MM
    assert lost_mm(kept, strokes) <= 2 * PX_MM
    assert twice_mm(kept) <= 4 * WITHIN_MM


def test_what_is_further_apart_stays() -> None:
    strokes = [wave(3), beside(wave(3), 1.5 * WITHIN_MM)]
    kept, dropped_mm = without_doubles(strokes, WITHIN_MM)
    assert dropped_mm == 0.0 and lost_mm(strokes, kept) == 0.0


@pytest.mark.parametrize("part", [slice(0, 150), slice(150, 300)])
def test_the_judge_sees_what_is_lost_and_what_is_twice(part: slice) -> None:
    line = wave(7)
    assert lost_mm([line], [line[part]]) > 5.0
    assert twice_mm([line, line[part]]) > 5.0
    assert twice_mm([line]) == 0.0
