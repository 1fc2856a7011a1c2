"""Rendered photos and scans of drawn sheets are read to a fraction of the ink's width."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from planner.error_model.photo.reading import Reading, read_sheet
from planner.error_model.sheet.layout import PaperSize
from tests.error_model.photo.drawn import Drawn, draw, pattern
from tests.error_model.photo.rendering import BLUE_INK, RED_INK, Camera, Ink, Pixels, photograph, scan

PHOTOS = {
    "thirty degrees": Camera(azimuth_deg=20),
    "thirty degrees, from the side, in shade": Camera(azimuth_deg=100, roll_deg=40, shadows=3),
    "forty-five degrees": Camera(tilt_deg=45, azimuth_deg=200, roll_deg=-70, shadows=1),
    "upside down": Camera(tilt_deg=12, roll_deg=180, gradient=0.6),
}


def read(drawn: Drawn, picture: Pixels, **options: tuple[float, float]) -> Reading:
    return read_sheet("photo", picture, drawn.marks, **options)


def place_errors_mm(drawn: Drawn, reading: Reading) -> np.ndarray:
    index = {mark.number: k for k, mark in enumerate(drawn.marks)}
    return np.array([each.place_mm - drawn.places_mm[index[each.mark.number]] for each in reading.measured])


def height_errors_mm(drawn: Drawn, reading: Reading) -> np.ndarray:
    index = {mark.number: k for k, mark in enumerate(drawn.marks)}
    return np.array(
        [
            each.contact.height_mm - drawn.heights_mm[index[each.mark.number]]
            for each in reading.measured
            if each.contact
        ]
    )


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.square(values).mean()))


def assert_exact(drawn: Drawn, reading: Reading, lost: Sequence[int] = ()) -> None:
    """No mark lost or taken for another; places far within 0.15 mm and heights within 0.2 mm rms."""
    assert [mark.number for mark in reading.missing] == list(lost)
    errors = np.linalg.norm(place_errors_mm(drawn, reading), axis=1)
    assert rms(errors) < 0.13 and errors.max() < 0.5
    heights = height_errors_mm(drawn, reading)
    assert len(heights) >= len(errors) - 2
    assert rms(heights) < 0.1


@pytest.mark.parametrize("name", PHOTOS)
def test_photos_are_read_exactly(name: str, tmp_path: Path) -> None:
    seed = list(PHOTOS).index(name)
    drawn = draw(tmp_path, pattern(), seed, colour=BLUE_INK if seed == 1 else RED_INK if seed == 2 else (0, 0, 0))
    reading = read(drawn, photograph(drawn.sheet(), PHOTOS[name], seed))
    assert_exact(drawn, reading)
    assert not reading.warnings


def test_a_scan_is_read_exactly(tmp_path: Path) -> None:
    drawn = draw(tmp_path, pattern(), 5)
    assert_exact(drawn, read(drawn, scan(drawn.sheet(), dpi=200)))


def test_marks_without_ink_are_missed_and_specks_are_not_taken_for_them(tmp_path: Path) -> None:
    lost = [3, 11, 12, 13, 28, 49]
    drawn = draw(tmp_path, pattern(), 6, without=lost, dirt=25)
    assert_exact(drawn, read(drawn, photograph(drawn.sheet(), Camera(azimuth_deg=-40), 6)), lost)


def test_narrow_letter_paper_and_marks_close_together(tmp_path: Path) -> None:
    """Neighbours nearer to a mark's place than the mark itself; a jagged grid would fit shifted by one."""
    drawn = draw(tmp_path, pattern(11, 5, spacing_mm=13.0, x_mm=70.0), 7, size=PaperSize.LETTER)
    reading = read(drawn, photograph(drawn.sheet(), Camera(azimuth_deg=10), 7))
    assert not reading.missing
    assert rms(place_errors_mm(drawn, reading)) < 0.1
    assert np.abs(height_errors_mm(drawn, reading)).max() < 0.5  # none rather than a wrong one


def test_strokes_that_ran_into_each_other_are_told_apart_and_tell_no_height(tmp_path: Path) -> None:
    """A pen that is too low where it travels drags ink from one mark to the next."""
    drawn = draw(tmp_path, pattern(8, 4), 12)
    dragged = (9, 18, 11)
    drawn.ink.append(Ink(drawn.places_mm[list(dragged)], 0.35))
    reading = read(drawn, photograph(drawn.sheet(), Camera(azimuth_deg=50), 12))
    assert not reading.missing
    errors = np.linalg.norm(place_errors_mm(drawn, reading), axis=1)
    assert errors.max() < 0.6
    for each in reading.measured:
        if each.mark.number in dragged:
            assert each.contact is None and each.sd_mm > 0.3


def test_marks_that_are_plain_dots_are_read_without_heights(tmp_path: Path) -> None:
    drawn = draw(tmp_path, [replace(mark, touch_down=None) for mark in pattern(8, 4)], 11)
    reading = read(drawn, photograph(drawn.sheet(), Camera(azimuth_deg=80), 11))
    assert not reading.missing and not any(each.contact for each in reading.measured)
    assert rms(place_errors_mm(drawn, reading)) < 0.08


def test_what_a_ruler_says_of_the_bars_corrects_the_printers_scale(tmp_path: Path) -> None:
    drawn = draw(tmp_path, pattern(), 8)
    picture = scan(drawn.sheet(printed_at=0.97), dpi=200)
    at_true_size = read(drawn, picture)
    corrected = read(drawn, picture, bars_mm=(145.5, 145.5))
    for one, other in zip(at_true_size.measured, corrected.measured, strict=True):
        np.testing.assert_allclose(other.place_mm, 0.97 * one.place_mm)
    across = read(drawn, picture, bars_mm=(150.0, 145.5)).measured[0].place_mm
    np.testing.assert_allclose(across, at_true_size.measured[0].place_mm * [0.97, 1.0])


def test_standard_deviations_are_about_as_large_as_the_errors(tmp_path: Path) -> None:
    drawn = draw(tmp_path, pattern(), 9)
    reading = read(drawn, photograph(drawn.sheet(), Camera(azimuth_deg=60), 9))
    normalised = place_errors_mm(drawn, reading) / np.array([[each.sd_mm] for each in reading.measured])
    assert 0.25 < rms(normalised) < 2.0
