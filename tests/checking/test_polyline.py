"""Dense lines keep their length and shape, and distances to them are those of brute force."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from planner.checking.polyline import NEAR_MM, dense_lines

SPACING_MM = 0.02


@given(seed=st.integers(0, 2**32 - 1), n=st.integers(1, 8))
def test_distances_are_those_of_brute_force(seed: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    points = np.round(rng.uniform(0, 2, (n, 2)), int(rng.integers(0, 4)))
    joined = rng.random(n) < 0.7
    joined[-1] = False
    dense = dense_lines(points, joined, SPACING_MM)
    length = np.linalg.norm(np.diff(points, axis=0), axis=1)[joined[:-1]].sum()
    assert abs(dense.length_at_points_mm().sum() - length) < 1e-9
    asked = rng.uniform(-1, 3, (50, 2))
    wanted = np.full(50, np.inf)
    for index in range(n):
        begin, end = points[index], points[index + 1] if joined[index] else points[index]
        along = end - begin
        share = np.clip((asked - begin) @ along / max(along @ along, 1e-300), 0, 1)
        wanted = np.minimum(wanted, np.linalg.norm(asked - begin - share[:, np.newaxis] * along, axis=1))
    measured = dense.distance_mm(asked)
    assert np.all(measured >= wanted - 1e-9)
    near = wanted < NEAR_MM - SPACING_MM
    assert np.all(measured[near] <= np.hypot(wanted, SPACING_MM / 2)[near] + 1e-9)
    assert np.all(measured <= wanted + 25 * SPACING_MM / 2 + 1e-9)
    gaps = np.linalg.norm(np.diff(dense.points_mm, axis=0), axis=1)[dense.joined[:-1]]
    assert np.all(gaps <= SPACING_MM * (1 + 1e-9))
    np.testing.assert_array_equal(np.unique(dense.source[~dense.joined]), np.flatnonzero(~joined))


def test_resting_takes_no_room() -> None:
    points = np.repeat([[0.0, 0.0], [1.0, 0.0]], 10_000, axis=0)
    joined = np.ones(20_000, dtype=bool)
    joined[-1] = False
    assert len(dense_lines(points, joined, SPACING_MM).points_mm) < 60
