"""How much ink a picture wants, where: its tones on a grid of the paper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.affine import inverse
from planner.arrays import FloatArray
from planner.drawing.image.seen import SeenPicture
from planner.drawing.raster import Darkness, block_means

MOST_CELLS = 4_000_000
_BLUR = 0.4
"""Of the finest detail: what a pen's line does to it anyway."""
LIGHTEST = 0.03
"""Tones that are as good as paper, as with fills."""


@dataclass(frozen=True, eq=False, slots=True)
class Tones:
    """values: (n_x, n_y), the share of the paper that ink is to cover; low_mm: (2,) the middle of the first cell;
    pitch_mm: from one to the next, along both axes."""

    values: NDArray[np.float32]
    low_mm: FloatArray
    pitch_mm: float

    def at(self, points_mm: FloatArray) -> FloatArray:
        """The tones at points (n, 2), between cells in proportion, nothing beyond."""
        from scipy.ndimage import map_coordinates

        index = (points_mm - self.low_mm) / self.pitch_mm
        found: FloatArray = map_coordinates(self.values, index.T, output=np.float64, order=1, mode="nearest")
        return found


def ink_share(darkness: Darkness) -> Darkness:
    """The share of black ink on white paper that sends back as much light as a grey of that darkness (IEC
    61966-2-1)."""
    grey = 1.0 - darkness
    light = np.where(grey <= 0.04045, grey / 12.92, ((grey + 0.055) / 1.055) ** 2.4)
    return np.asarray(1.0 - light, dtype=np.float32)


def tones(picture: SeenPicture, least_mm: float, cells: int, ink: float) -> Tones:
    """On a grid of so many cells to the finest detail, or fewer where there would be too many in all; what is finer is
    blurred. ink: the share for black."""
    from scipy.ndimage import gaussian_filter, map_coordinates

    pitch_mm = least_mm / cells
    left, low, right, high = picture.shape.bounds
    pitch_mm = max(pitch_mm, float(np.sqrt((right - left) * (high - low) / MOST_CELLS)))
    # Light is what adds up: the mean of a block is taken of shares of ink.
    shares = ink_share(picture.darkness)
    factor = min(max(int(pitch_mm / picture.pixel_mm), 1), *shares.shape)
    if factor > 1:
        shares = block_means(shares, factor)
    counts = [max(int(np.ceil((end - begin) / pitch_mm)), 1) for begin, end in ((left, right), (low, high))]
    corner = np.array([left + right, low + high]) / 2.0 - pitch_mm * (np.array(counts) - 1) / 2.0
    x, y = (corner[axis] + pitch_mm * np.arange(counts[axis]) for axis in (0, 1))
    back = inverse(picture.to_mm) / factor
    column = back[0, 0] * x[:, None] + back[0, 1] * y + back[0, 2] - 0.5
    row = back[1, 0] * x[:, None] + back[1, 1] * y + back[1, 2] - 0.5
    values = map_coordinates(shares, [row, column], order=1, mode="nearest")
    values = np.clip(gaussian_filter(values, _BLUR * least_mm / pitch_mm, mode="nearest", truncate=3.0), 0.0, 1.0)
    values[values < LIGHTEST] = 0.0
    return Tones(np.float32(ink) * values, corner, pitch_mm)
