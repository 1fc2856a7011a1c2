"""Drawings as programs write them: what is drawn of them is what Chromium shows of them.

What it shows is kept beside each drawing, in pixels of CSS; `python -m benchmarks.browser.stored FILE ...` paints it
again, and one test holds it against a browser.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from benchmarks.browser.chromium import Chromium, executable
from benchmarks.browser.compare import compare, without_background
from benchmarks.browser.reference import reference
from benchmarks.browser.stored import read
from benchmarks.browser.text import compare_text
from planner.arrays import FloatArray
from planner.drawing.flatten import flatten_all
from planner.drawing.options import ReadingOptions, TextMode
from planner.drawing.svg import read_drawing

PAGES = sorted((Path(__file__).parent / "pages").glob("*.svg"))
WITH_TEXT = [page for page in PAGES if b"<text" in page.read_bytes()]
MM_PER_PX = 25.4 / 96.0


def lines_mm(page: Path, text: TextMode) -> list[FloatArray]:
    drawing = read_drawing(page, options=ReadingOptions(text=text))
    return flatten_all(drawing.outlines, drawing.user_to_page, 0.01)


def in_mm(lines: list[FloatArray]) -> list[FloatArray]:
    return [line * MM_PER_PX for line in lines]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_lines_are_those_that_a_browser_paints(page: Path) -> None:
    shown = read(page.with_suffix(".json"))
    drawing = read_drawing(page, options=ReadingOptions(text="skip"))
    assert np.allclose(drawing.page_mm, np.array(shown.size_px) * MM_PER_PX, rtol=1e-4)
    sure = in_mm(shown.sure)
    if "background" in drawing.skipped:
        sure = without_background(sure, drawing.page_mm)
    verdict = compare(in_mm(shown.lines), sure, lines_mm(page, "skip"), drawing.page_mm)
    assert verdict.kind == "agree", verdict


@pytest.mark.parametrize("page", WITH_TEXT, ids=lambda page: page.stem)
def test_text_is_drawn_where_a_browser_writes_it(page: Path) -> None:
    shown = read(page.with_suffix(".json"))
    without = {line.tobytes() for line in lines_mm(page, "skip")}
    ink = [line for line in lines_mm(page, "single") if line.tobytes() not in without]
    assert compare_text(in_mm(shown.text_boxes), ink) == "agree"


def test_a_browser_paints_the_lines_that_are_kept() -> None:
    """Text is left out: its boxes follow the fonts of the machine."""
    if executable() is None and not os.environ.get("CI"):
        pytest.skip("chromium is not installed")
    with Chromium() as browser:
        for page in PAGES:
            kept, painted = read(page.with_suffix(".json")), reference(browser, page.read_bytes())
            assert np.allclose(kept.size_px, painted.size_px, atol=0.01), page.name
            page_px = kept.size_px
            assert compare(kept.lines, kept.sure, painted.lines, page_px).kind == "agree", page.name
            assert compare(painted.lines, painted.sure, kept.lines, page_px).kind == "agree", page.name
