"""Hatches, scribbles and stipples carry the tone of a picture."""

from __future__ import annotations

import numpy as np
import pytest

from planner.drawing.image_options import ImageOptions, ImageStyle
from planner.drawing.options import ReadingOptions
from planner.drawing.source import SvgInMemory
from planner.drawing.svg import read_drawing
from planner.errors import PlanError
from tests.drawing.image.pictures import PX_MM, covered, file_of, lines_of

TONES = [ImageStyle.HATCH, ImageStyle.SCRIBBLE, ImageStyle.STIPPLE]
LINE_MM = 0.4


def light(grey: float) -> float:
    """Of an sRGB value from 0 to 1 (IEC 61966-2-1)."""
    return grey / 12.92 if grey <= 0.04045 else ((grey + 0.055) / 1.055) ** 2.4


@pytest.mark.parametrize("style", TONES)
def test_ink_covers_each_patch_of_a_ramp_as_its_tone_says(style: ImageStyle) -> None:
    steps, side = 8, 60
    greys = np.linspace(235, 15, steps).astype(np.uint8)
    lines = lines_of(np.tile(np.repeat(greys, side), (side, 1)), ImageOptions(style, LINE_MM))
    inner = np.arange(1.2, side * PX_MM - 1.2, 0.07)
    for number, grey in enumerate(greys):
        x, y = np.meshgrid(inner + number * side * PX_MM, inner)
        share = covered(lines, np.column_stack((x.ravel(), y.ravel())), LINE_MM).mean()
        assert share == pytest.approx(min(1.0 - light(grey / 255.0), 0.96), abs=0.05)


@pytest.mark.parametrize("style", TONES)
def test_no_ink_leaves_the_picture_and_none_lies_on_its_white(style: ImageStyle) -> None:
    picture = np.full((150, 200), 255, dtype=np.uint8)
    picture[:, 60:] = 90
    lines = lines_of(picture, ImageOptions(style, LINE_MM))
    points = np.concatenate(lines)
    assert points.min() >= LINE_MM / 2 - 1e-6
    assert np.all(points.max(axis=0) <= np.array([40.0, 30.0]) - LINE_MM / 2 + 1e-6)
    assert points[:, 0].min() > 12.0 - LINE_MM


def test_a_scribble_is_one_line_and_stipples_are_dots() -> None:
    picture = np.tile(np.linspace(0, 240, 100).astype(np.uint8), (80, 1))
    (line,) = lines_of(picture, ImageOptions(ImageStyle.SCRIBBLE, LINE_MM))
    assert len(line) > 100
    assert {len(dot) for dot in lines_of(picture, ImageOptions(ImageStyle.STIPPLE, LINE_MM))} == {1}


@pytest.mark.parametrize("style", TONES)
def test_less_ink_is_less_ink(style: ImageStyle) -> None:
    black = np.zeros((100, 100), dtype=np.uint8)
    inner = np.arange(2.0, 18.0, 0.07)
    places = np.stack(np.meshgrid(inner, inner), axis=-1).reshape(-1, 2)
    share = covered(lines_of(black, ImageOptions(style, LINE_MM, ink=0.5)), places, LINE_MM).mean()
    assert share == pytest.approx(0.5, abs=0.04)


def test_hatches_lie_at_their_angle() -> None:
    grey = np.full((100, 100), 150, dtype=np.uint8)
    for angle_deg in (0.0, 30.0, 90.0):
        lines = lines_of(grey, ImageOptions(ImageStyle.HATCH, LINE_MM, angle_deg=angle_deg))
        ways = np.concatenate([np.diff(line, axis=0) for line in lines])
        longest = ways[np.argmax(np.hypot(*ways.T))]
        # On a page, which is the frame here, x and y are not the arm's: its x points up the page.
        turned = np.degrees(np.arctan2(longest[1], longest[0])) - 90.0
        assert np.mod(turned - angle_deg + 1e-6, 180.0) == pytest.approx(0.0, abs=1e-3)


def test_no_stroke_is_shorter_than_the_finest_detail() -> None:
    noise = np.random.default_rng(7).integers(0, 256, (150, 150)).astype(np.uint8)
    lines = lines_of(noise, ImageOptions(ImageStyle.HATCH, LINE_MM, detail_mm=2.0))
    assert min(float(np.hypot(*np.diff(line, axis=0).T).sum()) for line in lines) >= 2.0 - LINE_MM - 0.01


def test_dots_beyond_all_measure_are_refused() -> None:
    source = SvgInMemory("black.png", file_of(np.zeros((400, 400), dtype=np.uint8), dpi=(60, 60)))
    drawing = read_drawing(source, options=ReadingOptions(image=ImageOptions(ImageStyle.STIPPLE, 0.1)))
    from planner.drawing.image.lines import with_images

    with pytest.raises(PlanError, match="--image-line, or a lower --image-ink"):
        with_images(drawing, drawing.user_to_page)
