"""Which dot is which mark, without a photo: an arm's own modes tell apart what no smooth warp of the sheet can."""

from __future__ import annotations

import numpy as np
import pytest

from planner.error_model.photo.assignment import assign, smooth_modes
from planner.error_model.sheet.marks import Mark
from planner.error_model.sheet.modes import modes_mm, with_modes


def crowd(rng: np.random.Generator) -> np.ndarray:
    """(49, 2) places 5 mm apart or more in a box of 50 x 100 mm."""
    places = [rng.uniform((60, -50), (110, 50))]
    while len(places) < 49:
        place = rng.uniform((60, -50), (110, 50))
        if np.linalg.norm(np.array(places) - place, axis=1).min() > 5.0:
            places.append(place)
    return np.array(places)


@pytest.mark.parametrize("seed", range(4))
def test_marks_closer_than_they_are_off_are_told_apart_by_the_modes(seed: int) -> None:
    """Neighbours are moved unlike, as by an arm that draws them in different configurations."""
    rng = np.random.default_rng(seed)
    meant = crowd(rng)
    sizes = 4.0 * 0.7 ** np.arange(10)
    axes = np.linalg.qr(rng.normal(size=(2 * len(meant), len(sizes))))[0].T * np.sqrt(len(meant))
    draws = (rng.normal(size=(90, len(sizes))) * sizes) @ axes
    marks = with_modes([Mark(k, float(k), tuple(place)) for k, place in enumerate(meant)], draws.reshape(90, -1, 2))
    off = ((rng.normal(size=len(sizes)) * sizes) @ axes).reshape(-1, 2) + rng.normal(0, 0.3, meant.shape)
    order = rng.permutation(len(meant))
    dots, any_may_be = (meant + off)[order], np.ones((len(meant), len(meant)), dtype=bool)
    modes = modes_mm(marks)
    assert modes is not None
    right = assign(meant, dots, any_may_be, modes) == np.argsort(order)
    assert right.mean() > 0.95
    assert np.mean(assign(meant, dots, any_may_be, smooth_modes(meant)) == np.argsort(order)) < right.mean()


def test_no_dots_are_no_marks() -> None:
    meant = np.array([[80.0, 0.0], [90.0, 0.0]])
    assert assign(meant, np.empty((0, 2)), np.empty((2, 0), dtype=bool), smooth_modes(meant)).tolist() == [-1, -1]


def test_a_spot_that_cannot_be_a_mark_is_left_alone() -> None:
    x, y = np.meshgrid(np.arange(60.0, 121.0, 20.0), np.arange(-40.0, 41.0, 20.0))
    meant = np.column_stack((x.ravel(), y.ravel()))
    spots = np.concatenate((meant[1:] + np.array([3.0, -2.0]), meant[:1] + np.array([3.1, -2.1])))
    may_be = np.ones((len(meant), len(spots)), dtype=bool)
    assert assign(meant, spots, may_be, smooth_modes(meant)).tolist() == [len(spots) - 1, *range(len(meant) - 1)]
    may_be[:, -1] = False
    assert assign(meant, spots, may_be, smooth_modes(meant)).tolist() == [-1, *range(len(meant) - 1)]
