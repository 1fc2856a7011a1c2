"""Outlines of what is dark, and the middle of drawn lines."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image, ImageDraw

from planner.drawing.image_options import ImageOptions, ImageStyle
from tests.drawing.image.pictures import PX_MM, lines_of

TRACE = ImageOptions(ImageStyle.TRACE)
CENTRELINE = ImageOptions(ImageStyle.CENTRELINE)


def disc(n: int, x: float, y: float, radius: float, sub: int) -> np.ndarray:
    """Grey by the share of each pixel that the disc covers, told by sub x sub points of it."""
    at = (np.arange(n * sub) + 0.5) / sub
    inside = np.hypot(at[None, :] - x, at[:, None] - y) <= radius
    share = inside.reshape(n, sub, n, sub).mean(axis=(1, 3))
    return np.round(255.0 * (1.0 - share)).astype(np.uint8)


@settings(deadline=None, max_examples=15)
@given(st.floats(55, 65), st.floats(55, 65), st.floats(8, 50), st.sampled_from([1, 6]))
def test_the_outline_of_a_disc_is_a_circle_within_half_a_pixel(x: float, y: float, radius: float, sub: int) -> None:
    (line,) = lines_of(disc(120, x, y, radius, sub), TRACE)
    assert np.all(line[0] == line[-1])
    assert np.abs(np.hypot(*(line / PX_MM - (x, y)).T) - radius).max() < 0.5


def test_what_is_dark_up_to_the_edge_of_the_picture_ends_there() -> None:
    picture = np.full((50, 80), 255, dtype=np.uint8)
    picture[:, 30:] = 0
    (line,) = lines_of(picture, TRACE)
    frame = shapely.box(30 * PX_MM, 0.0, 80 * PX_MM, 50 * PX_MM)
    assert shapely.Polygon(line).symmetric_difference(frame).area < 0.02 * frame.area


def test_levels_are_outlines_of_tones_and_share_no_edge() -> None:
    y, x = np.mgrid[0:200, 0:200]
    cone = np.clip(np.hypot(x - 99.5, y - 99.5) * 2.8, 0, 255).astype(np.uint8)
    lines = lines_of(cone, ImageOptions(ImageStyle.TRACE, levels=3))
    radii = sorted(float(np.hypot(*(line / PX_MM - 100.0).T).mean()) for line in lines)
    assert radii == pytest.approx([255 / 2.8 * share for share in (0.25, 0.5, 0.75)], abs=0.6)
    square = np.full((100, 100), 255, dtype=np.uint8)
    square[20:80, 20:80] = 0
    assert len(lines_of(square, ImageOptions(ImageStyle.TRACE, levels=5))) == 1


def test_specks_have_no_outline() -> None:
    picture = np.full((100, 100), 255, dtype=np.uint8)
    picture[10:12, 10:12] = 0  # 0.4 mm
    picture[50:80, 50:80] = 0
    assert len(lines_of(picture, TRACE)) == 1


def drawn(*lines: list[tuple[float, float]], width: int, size: int = 300) -> Image.Image:
    """Lines with round ends and joins, smooth edges."""
    fine = Image.new("L", (4 * size, 4 * size), 255)
    pen = ImageDraw.Draw(fine)
    for line in lines:
        pen.line([(4 * x, 4 * y) for x, y in line], fill=0, width=4 * width)
        for x, y in line:
            pen.ellipse([4 * x - 2 * width, 4 * y - 2 * width, 4 * x + 2 * width, 4 * y + 2 * width], fill=0)
    return fine.resize((size, size), Image.Resampling.BOX)


turns = st.lists(st.floats(-1.3, 1.3), min_size=1, max_size=4)


@settings(deadline=None, max_examples=15)
@given(turns, st.floats(0, 6.28), st.integers(3, 6))
def test_the_middle_of_a_drawn_polyline_is_that_within_a_pixel(turns: list[float], start: float, width: int) -> None:
    headings = start + np.cumsum([0.0, *turns])
    line = np.cumsum([[0.0, 0.0], *(50.0 * np.stack((np.cos(headings), np.sin(headings)), axis=1))], axis=0)
    line += 150.0 - (line.max(axis=0) + line.min(axis=0)) / 2.0
    if not shapely.LineString(line).is_simple or _nearest_others(line) < 2 * width:
        return
    (found,) = lines_of(drawn([(x, y) for x, y in line.tolist()], width=width), CENTRELINE)  # no spurs: it is one
    middle, truth = shapely.LineString(found / PX_MM), shapely.LineString(line)
    assert middle.hausdorff_distance(truth) < 1.5 + width / 2  # at its ends
    spread = [middle.interpolate(share, normalized=True).distance(truth) for share in np.linspace(0.0, 1.0, 200)]
    assert np.percentile(spread, 95) < 1.1


def _nearest_others(line: np.ndarray) -> float:
    edges = [shapely.LineString(edge) for edge in pairwise(line)]
    apart = [one.distance(other) for k, one in enumerate(edges) for other in edges[k + 2 :]]
    return min(apart, default=np.inf)


def test_lines_that_cross_are_led_on() -> None:
    lines = lines_of(drawn([(20, 40), (280, 260)], [(30, 250), (270, 60)], width=5), CENTRELINE)
    assert len(lines) == 2
    for line in lines:
        ends = shapely.LineString(line[[0, -1]])
        assert shapely.LineString(line).hausdorff_distance(ends) < 1.0 * PX_MM


def test_a_ring_is_closed_and_a_blot_is_a_dot() -> None:
    picture = Image.new("L", (300, 300), 255)
    pen = ImageDraw.Draw(picture)
    pen.ellipse([50, 50, 200, 200], outline=0, width=5)
    pen.ellipse([240, 240, 247, 247], fill=0)
    ring, dot = sorted(lines_of(picture, CENTRELINE), key=len, reverse=True)
    assert np.all(ring[0] == ring[-1])
    assert np.abs(np.hypot(*(ring / PX_MM - 125.5).T) - 73.0).max() < 1.0
    assert len(dot) == 1 and np.abs(dot / PX_MM - 244.0).max() < 1.0


def test_without_its_library_a_style_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    import sys

    from planner.errors import UsageError

    monkeypatch.setitem(sys.modules, "skimage.morphology", None)
    with pytest.raises(UsageError, match=r"pip install 'drawing-arm-planner\[image\]'"):
        lines_of(np.zeros((50, 50), dtype=np.uint8), CENTRELINE)
