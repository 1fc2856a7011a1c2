"""Work chunks are bounded, hold every piece once, and say of each stroke by itself what became of it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.execution.context import PlanContext
from planner.execution.work_chunks import StrokeChunk, pieces_of, stroke_chunks, timed_strokes
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath
from planner.motion.timed_stroke import TimedStroke
from planner.placement.pieces import Piece
from planner.settings import Method, PlanSettings
from tests.arms.chains import load_once

_CONTEXT = PlanContext.of(load_once("drawing_arm"), PlanSettings())


def test_chunks_are_bounded_and_hold_every_piece_once() -> None:
    sizes = [1500.0, 800.0, 0.0, 4500.0, 3000.0, 900.0, 0.0]
    pieces = [Piece(np.full((2, 2), float(index)), size) for index, size in enumerate(sizes)]
    cut = list(stroke_chunks(_CONTEXT, pieces))
    assert [[int(points[0, 0]) for points in chunk.strokes] for chunk in cut] == [[0, 1, 2], [3], [4, 5, 6]]
    assert list(stroke_chunks(_CONTEXT, [])) == []


def test_the_stroke_that_cannot_be_drawn_is_the_one_that_is_told() -> None:
    strokes = [np.array([[distance, -20.0], [distance, 20.0]]) for distance in (120.0, 130.0, 900.0, 140.0)]
    made = timed_strokes(StrokeChunk(_CONTEXT, strokes))
    assert [isinstance(one, InfeasiblePath) for one in made] == [False, False, True, False]
    assert isinstance(made[2], InfeasiblePath) and made[2].tip_mm[0] == pytest.approx(900.0)


@pytest.mark.parametrize("method", [Method.PATH, Method.CLOSED_FORM])
def test_pieces_join_to_one_stroke_at_rest_where_they_meet(method: Method, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("planner.placement.pieces._WORK", 100)
    x = np.linspace(-30.0, 30.0, 200)
    stroke = np.column_stack((130.0 + 4.0 * np.abs((x + 30.0) % 8.0 - 4.0), x))
    context = PlanContext.of(load_once("drawing_arm"), PlanSettings(method=method))
    (pieces,) = pieces_of(context, [stroke])
    timed = [
        one
        for one in timed_strokes(StrokeChunk(context, [piece.points_mm for piece in pieces]))
        if isinstance(one, TimedStroke)
    ]
    assert len(timed) == len(pieces) > 3
    for before, after in pairwise(timed):
        np.testing.assert_allclose(before.joints[-1], after.joints[0], rtol=0, atol=1e-9)
    whole = TimedStroke.of(timed)
    assert len(whole.joints) == sum(len(piece.joints) - 1 for piece in timed) + 1
    assert np.array_equal(whole.first.tip_mm, stroke[0]) and np.array_equal(whole.last.tip_mm, stroke[-1])


@pytest.mark.parametrize("method", [Method.DLS, Method.NLP])
def test_methods_that_go_from_configuration_to_configuration_get_strokes_whole(method: Method) -> None:
    stroke = np.column_stack((np.arange(20000.0), np.arange(20000.0) % 2.0))
    sequential, by_place = (
        PlanContext.of(load_once("drawing_arm"), PlanSettings(method=one)) for one in (method, Method.PATH)
    )
    assert [len(pieces) for pieces in pieces_of(sequential, [stroke, stroke[:1]])] == [1, 1]
    assert len(pieces_of(by_place, [stroke])[0]) > 1


@given(st.lists(st.floats(0.0, 1500.0), min_size=1, max_size=400))
def test_work_is_shared_out_evenly(sizes: list[float]) -> None:
    """No chunk is more than its share, and none that could have taken the next piece too is left short: workers that
    each take the next chunk end within one chunk of each other."""
    pieces = [Piece(np.full((2, 2), float(index)), size) for index, size in enumerate(sizes)]
    chunks = list(stroke_chunks(_CONTEXT, pieces))
    works = [sum(sizes[int(points[0, 0])] for points in chunk.strokes) for chunk in chunks]
    assert sum(len(chunk.strokes) for chunk in chunks) == len(pieces)
    assert max(works) <= 4000.0
    weights = [work + 10.0 * len(chunk.strokes) for work, chunk in zip(works, chunks, strict=True)]
    assert all(weight > 4000.0 - 1500.0 for weight in weights[:-1])
