"""Corners of tags to a camera, or to the word that there can be none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from planner.error_model.photo.camera import fit_camera
from planner.error_model.photo.errors import PhotoError
from planner.error_model.photo.tags import SeenTags
from planner.error_model.sheet.layout import sheet_for
from tests.error_model.photo.drawn import pattern

PICTURE = (1536, 2048, 3)


def tags_from_above() -> SeenTags:
    layout = sheet_for(pattern())
    page_mm = np.array([layout.tag_corners_page_mm(place) for place in layout.tag_places])
    return SeenTags(layout, np.array([20.0, 1500.0]) + 6.5 * page_mm * [1.0, -1.0], page_mm)


def test_a_page_from_above_is_a_scaling() -> None:
    tags = tags_from_above()
    camera = fit_camera("photo", tags, PICTURE)
    np.testing.assert_allclose(camera.to_picture_px(tags.page_mm), tags.picture_px, atol=1e-3)
    assert camera.residual_px < 1e-3


@pytest.mark.parametrize("seed", range(3))
def test_corners_of_no_page_are_refused(seed: int) -> None:
    tags = tags_from_above()
    scattered = np.random.default_rng(seed).uniform((0, 0), PICTURE[1::-1], tags.picture_px.shape)
    with pytest.raises(PhotoError, match="not where those of a flat sheet"):
        fit_camera("photo", replace(tags, picture_px=scattered), PICTURE)


def test_a_fit_that_does_not_come_to_an_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    from planner.error_model.photo import camera

    solve = camera.least_squares
    monkeypatch.setattr(camera, "least_squares", lambda *given, **options: solve(*given, **options, max_nfev=1))
    with pytest.raises(PhotoError, match="lay the sheet flat"):
        fit_camera("photo", replace(tags_from_above(), picture_px=tags_from_above().picture_px ** 1.05), PICTURE)
