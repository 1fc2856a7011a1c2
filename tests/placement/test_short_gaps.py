"""Gaps that a pen cannot leave are drawn, those that it can stay."""

from __future__ import annotations

import numpy as np
import pytest

from planner.drawing.cut.cut import cut
from planner.drawing.cut.dash import dashed
from planner.drawing.drawing import Outline
from planner.drawing.flatten import flatten_all
from planner.drawing.join import join_strokes
from planner.drawing.subpath import Subpath, polyline
from planner.placement.short_gaps import SHORTEST_GAP_MM, gaps_to_draw

AS_IT_IS = np.eye(2, 3)
LINE = polyline(np.array([[0.0, 0.0], [100.0, 0.0]]))
SQUARE = polyline(np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]), is_closed=True)


def outlines(paths: list[Subpath]) -> list[Outline]:
    return [Outline(path.beziers, gap=path.gap) for path in paths]


@pytest.mark.parametrize(("scale", "n_drawn"), [(1.0, 0), (0.999, 33), (0.1, 33), (2.0, 0)])
def test_a_gap_counts_where_it_is_on_paper(scale: float, n_drawn: int) -> None:
    drawn = outlines(dashed([LINE], [2.5, SHORTEST_GAP_MM], 0.0))
    assert len(gaps_to_draw(drawn, scale * AS_IT_IS)) == n_drawn


def test_dashes_with_short_gaps_join_to_the_line_that_they_are_of() -> None:
    drawn = outlines(dashed([SQUARE], [1.7, 0.3], 0.9))
    together = [*drawn, *gaps_to_draw(drawn, AS_IT_IS)]
    (stroke,) = join_strokes(flatten_all(together, AS_IT_IS, 1e-3), 1e-3)
    assert np.hypot(*np.diff(stroke, axis=0).T).sum() == pytest.approx(40.0, abs=1e-3)


def test_a_gap_whose_next_dash_is_cut_off_stays() -> None:
    import shapely

    dashes = dashed([LINE], [2.0, 0.4], 0.0)
    left = [part for dash in dashes for part in cut(dash, shapely.box(-1.0, -1.0, 3.0, 1.0))]
    assert len(left) == 2
    assert len(gaps_to_draw(outlines(left), AS_IT_IS)) == 1
    assert not gaps_to_draw(outlines(left[:1]), AS_IT_IS)
