"""Sheets hold all of a drawing, and nothing of it twice; their marks lie on each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from planner.arrays import FloatArray
from planner.drawing.drawing import Drawing, Outline
from planner.errors import DoesNotFit, UsageError
from planner.paper_size import paper_size
from planner.placement.tiling import Tiling, held_by, placed_whole
from planner.polyline_length import polyline_length
from planner.settings import CanvasKind, PlanSettings
from planner.tile import MARK_MM, Tile
from planner.workspace.canvas import Canvas

CANVAS = Canvas(CanvasKind.USABLE, 40.0, 120.0, -75.0, 75.0)
PAGE = (300.0, 200.0)
SEAMS = ([0.0, 100.0, 200.0, 300.0], [0.0, 50.0, 100.0, 150.0, 200.0])
"""Of that page at its true size, of which 134 x 64 mm go on a sheet: three columns and four rows."""
_OVER_MM = 0.04

HOW = [
    PlanSettings(),
    PlanSettings(scale=0.7, mirror=True),
    PlanSettings(rotate_deg=90.0),
    PlanSettings(rotate_deg=33.0, margin_mm=1.0),
    PlanSettings(paper=paper_size("a3"), copies=(2, 1)),
    PlanSettings(paper=paper_size("500x150"), scale=0.3, at_mm=(200.0, 40.0)),
]


@st.composite
def lines_made(draw: st.DrawFn) -> FloatArray:
    """(n, 2) on the page: a tap, a line or a closed one, with corners on and along seams more often than by chance."""
    x, y = (
        st.one_of(
            st.sampled_from(seams), st.floats(0.0, seams[-1]), st.sampled_from(seams[1:]).map(lambda at: at - 1e-9)
        )
        for seams in SEAMS
    )
    points = draw(st.lists(st.tuples(x, y), min_size=1, max_size=8))
    if len(points) > 2 and draw(st.booleans()):
        points.append(points[0])
    line = np.array(points)
    is_new = np.concatenate(([True], np.hypot(*np.diff(line, axis=0).T) > 1e-6))
    return line[is_new]


def drawing_of(lines: list[FloatArray]) -> Drawing:
    outlines = tuple(Outline(np.repeat(line[:1], 4, axis=0)[None]) for line in lines)
    return Drawing("drawn", outlines, np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), PAGE)


def tiles_of(tiling: Tiling) -> list[Tile]:
    return [tiling.tile(column, row) for row in range(1, tiling.rows + 1) for column in range(1, tiling.columns + 1)]


@hypothesis_settings(max_examples=150)
@given(st.lists(lines_made(), min_size=1, max_size=4), st.sampled_from(HOW))
def test_all_sheets_together_are_the_drawing_and_hold_nothing_twice(lines: list[FloatArray], how: PlanSettings) -> None:
    place, tiling = placed_whole(drawing_of(lines), CANVAS, how)
    whole = [line @ place.svg_to_arm[:, :2].T + place.svg_to_arm[:, 2] for line in lines]
    held = tiling.cut(whole)
    everything: list[FloatArray] = []
    for tile in tiles_of(tiling):
        pieces = held.pop((tile.column, tile.row), [])
        everything += [piece - tile.shift_mm for piece in pieces]
        near, far, right, left = tile.window_mm
        for piece in pieces:
            assert (piece >= (near - _OVER_MM, right - _OVER_MM)).all()
            assert (piece <= (far + _OVER_MM, left + _OVER_MM)).all()
            assert len(piece) == 1 or (np.hypot(*np.diff(piece, axis=0).T) > 0).all()
        # What a reader of the window finds there is the same, but for a hair.
        length_mm = sum(map(polyline_length, held_by(tile, [line + tile.shift_mm for line in whole])))
        assert abs(length_mm - sum(map(polyline_length, pieces))) < _OVER_MM * (1 + sum(map(len, lines)))
    assert not held
    assert sum(map(polyline_length, everything)) == pytest.approx(sum(map(polyline_length, whole)), abs=1e-6)
    assert sum(len(piece) == 1 for piece in everything) == sum(len(line) == 1 for line in lines)
    for line in whole:
        assert max(_off_mm(point, everything) for point in line) < 1e-6
    for piece in everything:
        assert max(_off_mm(point, whole) for point in piece) < 1e-6


def _off_mm(point: FloatArray, lines: list[FloatArray]) -> float:
    """From a point to the nearest of lines (n, 2)."""
    nearest = np.inf
    for line in lines:
        starts, along = line[: max(len(line) - 1, 1)], np.diff(line, axis=0) if len(line) > 1 else np.zeros((1, 2))
        length = np.maximum((along**2).sum(axis=1), 1e-300)
        share = np.clip(((point - starts) * along).sum(axis=1) / length, 0.0, 1.0)
        nearest = min(nearest, float(np.hypot(*(point - starts - share[:, None] * along).T).min()))
    return nearest


@pytest.mark.parametrize("how", HOW)
def test_marks_are_at_the_corners_that_sheets_share_and_lie_on_each_other(how: PlanSettings) -> None:
    _, tiling = placed_whole(drawing_of([np.array([[1.0, 1.0], [290.0, 190.0]])]), CANVAS, how)
    sheets: dict[tuple[float, ...], int] = {}
    for tile in tiles_of(tiling):
        marks = np.array(tile.marks_mm).reshape(-1, 2)
        for mark in np.round(marks - tile.shift_mm, 6) + 0.0:
            sheets[tuple(mark)] = sheets.get(tuple(mark), 0) + 1
        for line in tile.mark_lines():  # which keep to the margin
            assert (line >= (40.0 + how.margin_mm - 1e-9, -75.0 + how.margin_mm - 1e-9)).all()
            assert (line <= (120.0 - how.margin_mm + 1e-9, 75.0 - how.margin_mm + 1e-9)).all()
            assert np.hypot(*np.diff(line, axis=0).T) == pytest.approx(2 * MARK_MM)
    inner = (tiling.columns - 1) * (tiling.rows - 1)
    outer = 2 * (tiling.columns - 1) + 2 * (tiling.rows - 1)
    assert sorted(sheets.values()) == [2] * outer + [4] * inner


def test_lines_along_a_seam_are_on_one_sheet_and_whole() -> None:
    along = [np.array([(100.0, 10.0), (100.0, 40.0)]), np.array([(100.0 - 1e-12, 40.0), (100.0 + 1e-12, 10.0)])]
    place, tiling = placed_whole(drawing_of(along), CANVAS, PlanSettings())
    held = tiling.cut([line @ place.svg_to_arm[:, :2].T + place.svg_to_arm[:, 2] for line in along])
    assert [(cell, len(pieces)) for cell, pieces in held.items()] == [((2, 1), 2)]


@pytest.mark.parametrize(("beyond_mm", "sheets"), [(0.001, 1), (0.05, 2)])
def test_less_than_a_hair_beyond_a_seam_stays_on_its_sheet(beyond_mm: float, sheets: int) -> None:
    line = np.array([(90.0, 10.0), (100.0 + beyond_mm, 10.0)])
    place, tiling = placed_whole(drawing_of([line]), CANVAS, PlanSettings())
    assert len(tiling.cut([line @ place.svg_to_arm[:, :2].T + place.svg_to_arm[:, 2]])) == sheets


@pytest.mark.parametrize(
    ("settings", "fault"),
    [
        ({"margin_mm": 37.0}, "a margin of 37 mm, and 3 mm for register marks, leave nothing of the canvas"),
        ({"scale": 30.0}, "take 68 x 94 sheets, and 1000 are the most"),
        ({"scale": 300.0}, "paper of 90000 x 60000 mm: sides are 1 mm to 10 m"),
    ],
)
def test_sheets_have_to_have_room_and_an_end(settings: dict[str, float], fault: str) -> None:
    with pytest.raises(UsageError, match=fault):
        placed_whole(drawing_of([np.array([(1.0, 1.0)])]), CANVAS, PlanSettings(**settings))  # type: ignore[arg-type]


def test_ink_beyond_the_paper_that_is_cut_is_refused() -> None:
    drawing = drawing_of([np.array([(20.0, 1.0)]), np.array([(310.0, 1.0)])])
    with pytest.raises(
        DoesNotFit, match=r"10\.0 mm over the right side, though the page .* sheet has .*larger --paper"
    ):
        placed_whole(drawing, CANVAS, replace(PlanSettings(), skip_unreachable=True))
