"""Laws of the cap on the pen's speed: chords between samples stay near the path, hairpins included."""

from __future__ import annotations

import numpy as np
import shapely
from hypothesis import given
from hypothesis import strategies as st

from planner.motion.speed_limit import rate_limit
from planner.placement.pen_path import smooth_paths

_SPEED_MM_S, _CHORD_ERROR_MM, _RATE_HZ = 80.0, 0.02, 100.0
_FINE = 8
_SLACK = 1.35
"""Speeds are tried in steps, and caps hold from cell to cell: between them a chord may cut a little more."""


@given(turns=st.lists(st.floats(-np.pi, np.pi), min_size=1, max_size=6), steps=st.integers(0, 2**32 - 1))
def test_a_chord_as_long_as_the_cap_allows_cuts_no_more_than_the_chord_error(turns: list[float], steps: int) -> None:
    heading = np.cumsum([0.0, *turns])
    lengths = np.random.default_rng(steps).uniform(0.3, 4.0, len(heading))
    corners = np.cumsum(lengths[:, None] * np.column_stack((np.cos(heading), np.sin(heading))), axis=0)
    paths = smooth_paths([np.vstack(([0.0, 0.0], corners))], 0.025)
    cap = rate_limit(paths, np.zeros(1), _SPEED_MM_S, _CHORD_ERROR_MM, _RATE_HZ)[:, 0]
    slope = np.hypot(*paths.positions(np.zeros(1), 1)[:, 0].T)
    way = paths.positions(np.linspace(0, 1, _FINE, endpoint=False)).reshape(-1, 2)
    along_mm = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))))
    line = shapely.LineString(way)
    for cell in np.flatnonzero(slope > 0.0).tolist():  # at the very start the pen rests
        half_mm, at_mm = 0.5 * cap[cell] * slope[cell] / _RATE_HZ, along_mm[_FINE * cell]
        chord = shapely.LineString([line.interpolate(max(at_mm - half_mm, 0.0)), line.interpolate(at_mm + half_mm)])
        assert chord.distance(shapely.Point(way[_FINE * cell])) <= _SLACK * _CHORD_ERROR_MM
