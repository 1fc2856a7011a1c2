"""Drawings beyond what a machine can hold, or numbers can say, are refused in one sentence that says what to do."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from planner.drawing import flatten, path_data
from planner.drawing.scene import place
from planner.drawing.svg import read_drawing
from planner.errors import DrawingError, PlanError

LINE = '<path stroke="red" d="M1 2L3 4"/>'


def drawn(folder: Path, body: str, root: str = 'viewBox="0 0 100 100"') -> Path:
    path = folder / "drawing.svg"
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {root}>{body}</svg>')
    return path


@pytest.mark.parametrize(
    "root",
    [
        'viewBox="1e308 0 100 100"',
        'viewBox="0 0 1e308 1e308"',
        'viewBox="0 0 1e-30 1e30"',
        'viewBox="0 0 1e10 1"',
        'viewBox="0 0 9 9" width="1e308" height="9"',
        'viewBox="0 0 9 9" width="1e30"',
    ],
)
def test_a_page_of_impossible_size_is_refused(tmp_path: Path, root: str) -> None:
    with pytest.raises(DrawingError, match="viewBox"):
        read_drawing(drawn(tmp_path, LINE, root))


@pytest.mark.parametrize(
    "transform",
    [
        "scale(1e308) scale(1e308)",
        "translate(1e308) translate(1e308)",
        "skewX(90)",
        "matrix(1e200 0 0 1e200 1e200 1e200)",
        "scale(1e-300) scale(1e300)",
    ],
)
@pytest.mark.parametrize("clip", ["", 'clip-path="url(#c)"'])
def test_transforms_that_overflow_cost_only_what_they_move(tmp_path: Path, transform: str, clip: str) -> None:
    found = read_drawing(
        drawn(
            tmp_path,
            f'<clipPath id="c"><rect width="5" height="5"/></clipPath>{LINE}'
            f'<g transform="{transform}"><g {clip}>{LINE}</g></g>',
        )
    )
    assert all(np.isfinite(outline.beziers).all() for outline in found.outlines)
    np.testing.assert_allclose(found.outlines[0].beziers[0, [0, 3]], [[1, 2], [3, 4]])


def test_counts_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(place, "CURVE_LIMIT", 50)
    monkeypatch.setattr(place, "SUBPATH_LIMIT", 20)
    read_drawing(drawn(tmp_path, '<path fill="none" stroke="red" d="M0 0' + "l1 1" * 50 + '"/>'))
    with pytest.raises(DrawingError, match="more than 50 lines and curves"):
        read_drawing(drawn(tmp_path, '<path fill="none" stroke="red" d="M0 0' + "l1 1" * 51 + '"/>'))
    with pytest.raises(DrawingError, match="more than 20 subpaths"):
        read_drawing(drawn(tmp_path, "".join(f'<path stroke="red" d="M0 {y}h9"/>' for y in range(21))))


def test_arcs_do_not_multiply_without_bound(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(path_data, "CURVE_LIMIT", 100)
    with pytest.raises(DrawingError, match="lines and curves"):
        read_drawing(drawn(tmp_path, '<path fill="none" stroke="red" d="M0 0' + "a1 1 0 0 1 5 5" * 50 + '"/>'))


def test_copies_that_lie_on_each_other_are_drawn_ten_times_at_most(tmp_path: Path) -> None:
    levels = "".join(
        f'<g id="{after}">' + f'<use href="#{before}"/>' * 3 + "</g>" for before, after in pairwise("abcdef")
    )
    found = read_drawing(drawn(tmp_path, f'<g id="a">{LINE}</g>{levels}<path stroke="red" d="M9 9h1"/>'))
    n_copies = sum(3**level for level in range(6))
    assert len(found.outlines) == 11 and set(found.skipped.values()) == {n_copies - 10}
    beside = "".join(f'<path stroke="red" d="M{x} 0h1"/>' for x in range(50))
    assert len(read_drawing(drawn(tmp_path, beside)).outlines) == 50


def test_a_curve_that_needs_too_many_points_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(flatten, "POINT_LIMIT", 1000)
    outlines = read_drawing(drawn(tmp_path, '<circle cx="50" cy="50" r="40"/>')).outlines
    with pytest.raises(PlanError, match="more than 1000 points"):
        flatten.flatten_all(outlines, np.array([[1e6, 0.0, 0.0], [0.0, 1e6, 0.0]]), 0.01)


@pytest.mark.parametrize(
    ("body", "advice"),
    [
        ("", "draw lines or shapes"),
        ("<image width='9' height='9' href='data:image/png;base64,AAAA'/>", "draw pictures with --image"),
        ('<rect width="0" height="5"/>', "a size, and a fill or a stroke"),
        ('<path d="M0 0L1e12 5"/>', "below 1e9"),
    ],
)
def test_a_drawing_of_nothing_says_what_to_do(tmp_path: Path, body: str, advice: str) -> None:
    with pytest.raises(DrawingError, match=f"nothing to draw: .*{advice}"):
        read_drawing(drawn(tmp_path, body))
