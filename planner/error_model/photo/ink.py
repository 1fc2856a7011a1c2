"""What is dark on the paper, seen from straight above and freed of the light that fell on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.arrays import BoolArray, FloatArray
from planner.error_model.photo.camera import Camera
from planner.error_model.photo.picture import LINEAR_LIGHT, Picture
from planner.error_model.vision import cv2

Singles = NDArray[np.float32]

_PX_PER_MM = (8.0, 16.0)  # of the view from above: least and most
_COARSE_PX_PER_MM = 2.5
_PAPER_KERNEL = 15  # 6 mm: more than half of it is paper wherever the ink is dots and lines
_SMOOTHED_MM = 0.12
_PRINTED_MM = 1.2  # wide enough for a printed line with its blur
_FAINTEST = 0.05
_NOISE_SD = 6.0
_NOISE_BOX_MM = 10.0


@dataclass(frozen=True, eq=False, slots=True)
class InkMap:
    """darkness: (rows, columns), 0 for paper, 1 for black, in linear light. excess: how much more than noise it is, at
    least 1 where there is ink. low_mm (2,): page coordinates of the lower left corner; the first row is the upper
    one."""

    darkness: Singles
    excess: Singles
    low_mm: FloatArray
    px_per_mm: float

    def to_page_mm(self, pixels: FloatArray) -> FloatArray:
        """(..., 2) page coordinates of (column, row), whole numbers being the middles of pixels."""
        up = len(self.darkness) - 0.5 - pixels[..., 1]
        page_mm: FloatArray = self.low_mm + np.stack((pixels[..., 0] + 0.5, up), axis=-1) / self.px_per_mm
        return page_mm

    def to_pixels(self, page_mm: FloatArray) -> FloatArray:
        """(..., 2): the inverse."""
        return _pixels(page_mm, len(self.darkness), self.low_mm, self.px_per_mm)

    def sampled(self, page_mm: FloatArray) -> Singles:
        """(...): darkness at points (..., 2); paper outside."""
        return self._at(self.darkness, page_mm)

    def is_ink(self, page_mm: FloatArray) -> BoolArray:
        """(...): whether there is ink at points (..., 2)."""
        inked: BoolArray = self._at(self.excess, page_mm) >= 1
        return inked

    def _at(self, values: Singles, page_mm: FloatArray) -> Singles:
        pixels = self.to_pixels(page_mm).astype(np.float32)
        found = cv2.remap(
            values, pixels[..., 0], pixels[..., 1], cv2.INTER_LINEAR, borderMode=cv2.BORDER_CONSTANT, borderValue=0.0
        )
        return np.asarray(found, dtype=np.float32)


def from_above(
    picture: Picture, camera: Camera, low_mm: FloatArray, high_mm: FloatArray, px_per_mm: float
) -> NDArray[np.uint8]:
    """(rows, columns, 3): a box of the page, from page coordinates low to high, as if seen from straight above."""
    columns, rows = np.maximum(np.round((high_mm - low_mm) * px_per_mm).astype(int), 1)
    right, down = np.meshgrid((np.arange(columns) + 0.5) / px_per_mm, (np.arange(rows) + 0.5) / px_per_mm)
    page = np.stack((low_mm[0] + right, low_mm[1] + rows / px_per_mm - down), axis=-1)
    seen = camera.to_picture_px(page).astype(np.float32)
    return np.asarray(
        cv2.remap(picture, seen[..., 0], seen[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE), dtype=np.uint8
    )


def ink_map(
    picture: Picture, camera: Camera, low_mm: FloatArray, high_mm: FloatArray, printed_mm: FloatArray
) -> InkMap:
    """The ink in a box of the page, of any colour: the darkest of three channels beside the paper round it.

    printed_mm: (n, 2, 2) ends of lines that were there before the ink.
    """
    corners = np.array([low_mm, [high_mm[0], low_mm[1]], high_mm, [low_mm[0], high_mm[1]]])
    px_per_mm = float(np.clip(np.ceil(camera.px_per_mm(corners).max()), *_PX_PER_MM))
    view = from_above(picture, camera, low_mm, high_mm, px_per_mm)
    rows, columns = view.shape[:2]
    coarse = _COARSE_PX_PER_MM / px_per_mm
    small = cv2.resize(
        view, (max(round(columns * coarse), 1), max(round(rows * coarse), 1)), interpolation=cv2.INTER_AREA
    )
    paper = cv2.resize(cv2.medianBlur(small, _PAPER_KERNEL), (columns, rows), interpolation=cv2.INTER_LINEAR)
    light = LINEAR_LIGHT.astype(np.float32)
    darkness = 1 - (cv2.LUT(view, light) / np.maximum(cv2.LUT(paper, light), light[8])).min(axis=-1)
    darkness -= np.median(darkness)
    darkness = darkness.astype(np.float32)
    for start, end in np.round(_pixels(printed_mm, rows, low_mm, px_per_mm)).astype(int).tolist():
        cv2.line(darkness, start, end, 0.0, thickness=round(_PRINTED_MM * px_per_mm))
    return InkMap(darkness, _excess(darkness, px_per_mm), low_mm, px_per_mm)


def _excess(darkness: Singles, px_per_mm: float) -> Singles:
    """Darkness, blurred by a part of a dot, over the least that is no noise: paper in the shade has more of that."""
    smooth = cv2.GaussianBlur(darkness, (0, 0), _SMOOTHED_MM * px_per_mm)
    away = np.abs(smooth)
    usual = float(np.median(away))  # of a normal distribution 0.67 sd, while the mean is 0.80
    box = (round(_NOISE_BOX_MM * px_per_mm),) * 2
    noise = 1.25 * cv2.blur(np.minimum(away, np.float32(4 * usual)), box, borderType=cv2.BORDER_REFLECT)
    return np.asarray(smooth / np.maximum(_NOISE_SD * noise, _FAINTEST), dtype=np.float32)


def _pixels(page_mm: FloatArray, rows: int, low_mm: FloatArray, px_per_mm: float) -> FloatArray:
    right, up = np.moveaxis((page_mm - low_mm) * px_per_mm, -1, 0)
    pixels: FloatArray = np.stack((right - 0.5, rows - 0.5 - up), axis=-1)
    return pixels
