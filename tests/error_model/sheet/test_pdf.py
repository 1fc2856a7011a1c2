"""The printed page: true size, tags where the layout has them, nothing where marks come."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pypdfium2
import pytest

from planner.error_model.sheet.layout import PaperSize
from planner.error_model.sheet.marks import Mark
from planner.error_model.sheet.pdf import write_sheet
from planner.errors import OutputError
from tests.error_model.photo.drawn import pattern

PX_PER_MM = 10.0
PATTERNS = {
    "before the base": pattern(),
    "upright": pattern(5, 11),
    "close to the base": pattern(6, 4, x_mm=18.0),
    "far from the base": pattern(8, 5, x_mm=215.0),
}


def grey_page(pdf: Path) -> np.ndarray:
    with pypdfium2.PdfDocument(pdf) as document:
        assert len(document) == 1
        picture = document[0].render(scale=PX_PER_MM * 25.4 / 72 * (1 - 1e-5)).to_numpy()
    return np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY))


@pytest.mark.parametrize("name", PATTERNS)
def test_the_page_is_as_the_layout_says(name: str, tmp_path: Path) -> None:
    marks = PATTERNS[name]
    layout = write_sheet(tmp_path / "sheet.pdf", "drawing_arm_2022", marks)
    page = grey_page(tmp_path / "sheet.pdf")
    width, height = layout.page.extent_mm
    assert page.shape == (round(height * PX_PER_MM), round(width * PX_PER_MM))
    family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
    corners, ids, _ = cv2.aruco.ArucoDetector(family, cv2.aruco.DetectorParameters()).detectMarkers(page)
    seen = dict(zip(np.ravel(ids).tolist(), corners, strict=True))
    assert set(seen) == set(layout.tag_ids)
    for place, number in zip(layout.tag_places, layout.tag_ids, strict=True):
        middle = seen[number].reshape(4, 2).mean(axis=0) + 0.5
        np.testing.assert_allclose(
            [middle[0] / PX_PER_MM, height - middle[1] / PX_PER_MM], layout.tag_centre_page_mm(place), atol=0.05
        )
    for mark in marks:
        u, v = layout.to_page_mm(np.array(mark.place_mm))
        row, column = round((height - v) * PX_PER_MM), round(u * PX_PER_MM)
        assert page[row - 40 : row + 40, column - 40 : column + 40].min() == 255, "nothing is printed round a mark"


def test_the_bars_are_150_mm_long_to_a_ruler(tmp_path: Path) -> None:
    layout = write_sheet(tmp_path / "sheet.pdf", "arm", pattern())
    page = grey_page(tmp_path / "sheet.pdf")
    (start, end), _ = layout.bars_page_mm
    row = round((layout.page.extent_mm[1] - start[1] + 1.0) * PX_PER_MM)  # through the ticks
    dark = np.flatnonzero(page[row, round((start[0] - 2) * PX_PER_MM) : round((end[0] + 2) * PX_PER_MM)] < 128)
    first, last = dark[dark < 100].mean(), dark[dark > 100].mean()
    assert (last - first) / PX_PER_MM == pytest.approx(150.0, abs=0.15)


def test_the_same_marks_make_the_same_file_and_any_name_of_an_arm_will_do(tmp_path: Path) -> None:
    for name in ("one.pdf", "two.pdf"):
        write_sheet(tmp_path / name, "腕 \N{GREEK SMALL LETTER ALPHA} " + 60 * "w", pattern(), PaperSize.LETTER)
    content = (tmp_path / "one.pdf").read_bytes()
    assert content == (tmp_path / "two.pdf").read_bytes()
    assert b"/PrintScaling /None" in content


def test_a_sheet_without_a_place_to_go_is_refused(tmp_path: Path) -> None:
    with pytest.raises(OutputError):
        write_sheet(tmp_path / "nowhere" / "sheet.pdf", "arm", [Mark(0, 0.0, (80.0, 0.0))])
