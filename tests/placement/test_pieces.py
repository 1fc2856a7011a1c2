"""Pieces are their stroke, cut at its sharpest vertices into parts of bounded work."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.placement import pieces
from planner.placement.pen_path import smooth_paths
from planner.placement.pieces import in_pieces
from planner.placement.rounded_path import expected_cells

TOLERANCE_MM = 0.025


def wandering(seed: int, count: int, step_mm: float) -> FloatArray:
    """A polyline of points that lie a step apart and turn as they like."""
    heading = np.cumsum(np.random.default_rng(seed).normal(0.0, 0.8, count - 1))
    steps = step_mm * np.column_stack((np.cos(heading), np.sin(heading)))
    return np.concatenate((np.zeros((1, 2)), np.cumsum(steps, axis=0)))


@given(st.integers(0, 1000), st.integers(2, 400), st.floats(0.01, 5.0))
def test_pieces_are_the_stroke_and_of_bounded_size(seed: int, count: int, step_mm: float) -> None:
    stroke, tap = wandering(seed, count, step_mm), np.zeros((1, 2))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pieces, "_WORK", 100)
        (alone,), made, (other,) = in_pieces([tap, stroke, tap], TOLERANCE_MM)
    assert len(alone.points_mm) == len(other.points_mm) == 1 and alone.work == 0.0
    joined = np.concatenate([made[0].points_mm, *(piece.points_mm[1:] for piece in made[1:])])
    assert np.array_equal(joined, stroke)
    assert all(np.array_equal(one.points_mm[-1], next_one.points_mm[0]) for one, next_one in pairwise(made))
    assert all(len(piece.points_mm) > 1 for piece in made)
    (undivided,) = next(in_pieces([stroke], TOLERANCE_MM, whole=True))
    longest_step = float(np.diff(expected_cells([stroke], TOLERANCE_MM)[0]).max()) + 1.0
    assert max(piece.work for piece in made) <= 150 * 1.4 + 2 * longest_step
    assert sum(piece.work for piece in made) == pytest.approx(undivided.work)


def test_strokes_are_looked_at_together_or_part_by_part_to_the_same_effect(monkeypatch: pytest.MonkeyPatch) -> None:
    strokes = [wandering(seed, count, 1.0) for seed, count in enumerate((5, 300, 2, 40, 101, 7))]
    at_once = [made[0].work for made in in_pieces(strokes, TOLERANCE_MM, whole=True)]
    monkeypatch.setattr(pieces, "_POINTS_AT_ONCE", 50)
    bit_by_bit = [made[0].work for made in in_pieces(strokes, TOLERANCE_MM, whole=True)]
    np.testing.assert_allclose(bit_by_bit, at_once, rtol=0.02)
    assert at_once[0] == bit_by_bit[0]


def test_the_pen_rests_at_the_sharpest_vertex_near_the_middle(monkeypatch: pytest.MonkeyPatch) -> None:
    slow = np.column_stack((np.linspace(0, 100, 101), 0.02 * np.cos(np.pi * np.arange(101))))
    corner = np.column_stack((np.full(100, 100.0), np.linspace(1, 100, 100) + slow[-1, 1]))
    stroke = np.concatenate((slow, corner))
    (undivided,) = next(in_pieces([stroke], TOLERANCE_MM, whole=True))
    monkeypatch.setattr(pieces, "_WORK", undivided.work / 2)
    ((one, _),) = in_pieces([stroke], TOLERANCE_MM)
    assert np.array_equal(one.points_mm[-1], slow[-1])
    assert len(next(in_pieces([stroke], TOLERANCE_MM, whole=True))) == 1
    assert list(in_pieces([], TOLERANCE_MM)) == []


@given(st.integers(0, 1000), st.integers(2, 60), st.floats(0.05, 20.0))
def test_cells_are_expected_before_the_path_is_made(seed: int, count: int, step_mm: float) -> None:
    """Lone corners tell most of them; ramps at both ends and bends add to that, and nothing takes away."""
    strokes = [wandering(seed, count, step_mm), wandering(seed + 1, count, step_mm)]
    for expected, made in zip(
        expected_cells(strokes, TOLERANCE_MM), smooth_paths(strokes, TOLERANCE_MM).n_cells.tolist(), strict=True
    ):
        assert expected[0] == 0.0 and (np.diff(expected) > 0.0).all()
        assert 0.3 * (made - 20) <= expected[-1] <= made
