"""Spots of ink: all that could be the stroke of a mark, which is where the pen rested and blotted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.error_model.photo.ink import InkMap
from planner.error_model.vision import cv2

_SKIP_MM = 0.6  # a pen may leave out that much within a stroke
_LEAST_INK_MM2 = 0.02  # a dot of 0.16 mm
_UNLIKE = 40.0
_BLOT_MM = 0.2  # sd of what ink is smoothed by, to find where most of it is
_NEARLY = 0.95
_BLOT_LENGTH_MM = 0.3  # over which a blot has nearly the most ink
_NEAR_MM = 0.4
_TANGLE_MM = 4.0
_MUCH = 0.9  # of what blots usually have: enough for one
_AROUND_MM, _BESIDE_MM = 1.0, 1.5
_LONGER_MM = 5.0
_ASIDE_MM = 2.5
_ASKEW = 1.2  # slack that is taken up on the way turns strokes by up to 50 degrees
_DOT_MM = 2.2
_LONG = 6.0  # of its variance the way along over that across


@dataclass(frozen=True, eq=False, slots=True)
class Spots:
    """points_mm: of each spot (p, 2) places all over it, in page coordinates; soaked: (p,) how much ink is round them.
    blots_mm: (m, 2) where most is. is_whole: (m,) whether it has run into no other."""

    points_mm: tuple[FloatArray, ...]
    soaked: tuple[FloatArray, ...]
    blots_mm: FloatArray
    is_whole: BoolArray

    def rest_mm(self, index: int, way: FloatArray) -> tuple[FloatArray, float]:
        """(2,) where the pen rested on its way, and the sd that other places with nearly as much ink leave.

        The furthest of those is taken: where a lifted pen is dragged back, there is more ink just before.
        """
        points, soaked = self.points_mm[index], self.soaked[index]
        much = points[soaked > _NEARLY * soaked.max()]
        along = much @ way
        rest: FloatArray = much[along > along.max() - _BLOT_LENGTH_MM].mean(axis=0)
        return rest, max(float(along.std()) - _BLOT_LENGTH_MM / 2, 0.0)

    def axis(self, index: int, way: FloatArray) -> FloatArray:
        """(2,): the direction that a spot extends in, `way` where it is no longer than wide."""
        away = self.points_mm[index] - self.points_mm[index].mean(axis=0)
        (narrow, wide), axes = np.linalg.eigh(away.T @ away / len(away))
        if wide < _LONG * narrow:
            return way
        axis: FloatArray = axes[:, 1] * np.sign(axes[:, 1] @ way)
        return axis

    def could_be_strokes(self, way: FloatArray, length_mm: float) -> BoolArray:
        """(m,): whether they are long and narrow enough for a stroke that way, of up to that length, and what is
        dragged beyond."""
        along, aside = self._extents(way)
        return (along < 2 * length_mm + _LONGER_MM) & (aside < np.maximum(_ASIDE_MM, _ASKEW * along))

    def could_be_dots(self) -> BoolArray:
        """(m,)"""
        return np.maximum(*self._extents(np.array([1.0, 0.0]))) < _DOT_MM

    def _extents(self, way: FloatArray) -> tuple[FloatArray, FloatArray]:
        across = np.array([-way[1], way[0]])
        along, aside = (np.array([np.ptp(points @ each) for points in self.points_mm]) for each in (way, across))
        return along, aside


def find_spots(ink: InkMap) -> Spots:
    """The spots of ink, but those that reach the rim, and specks beside which others are large. Where strokes have run
    into each other, each blot is a spot by itself."""
    gap = max(round(_SKIP_MM * ink.px_per_mm), 1)
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (gap, gap))
    dark = (ink.excess >= 1).astype(np.uint8)
    _, labels, boxes, _ = cv2.connectedComponentsWithStats(cv2.morphologyEx(dark, cv2.MORPH_CLOSE, kernel))
    soaked = cv2.GaussianBlur(ink.darkness, (0, 0), _BLOT_MM * ink.px_per_mm)
    rows, columns = labels.shape
    whole, amounts = [], []
    for number, (left, top, width, height, _) in enumerate(boxes[1:].tolist(), 1):
        if left == 0 or top == 0 or left + width == columns or top + height == rows:
            continue
        part = np.s_[top : top + height, left : left + width]
        down, right = np.nonzero((labels[part] == number) & (dark[part] > 0))
        amount = float(ink.darkness[part][down, right].sum()) / ink.px_per_mm**2
        if amount >= _LEAST_INK_MM2:
            points = ink.to_page_mm(np.stack((right + left, down + top), axis=-1).astype(np.float64))
            whole.append((points, soaked[part][down, right].astype(np.float64)))
            amounts.append(amount)
    whole = [each for each, amount in zip(whole, amounts, strict=True) if amount > np.median(amounts) / _UNLIKE]
    usual = float(np.median([values.max() for _, values in whole])) if whole else 0.0
    tangled = [each for each in whole if _is_tangle(each[0])]
    spots = [each for each in whole if not _is_tangle(each[0])]
    n_whole = len(spots)
    spots += [blot for each in tangled for blot in _blots(*each, _MUCH * usual)]
    return Spots(
        tuple(points for points, _ in spots),
        tuple(values for _, values in spots),
        np.array([_middle(*spot) for spot in spots]).reshape(-1, 2),
        np.arange(len(spots)) < n_whole,
    )


def _is_tangle(points: FloatArray) -> bool:
    """Whether a spot is too wide for the stroke of one mark."""
    _, (width, height), _ = cv2.minAreaRect(points.astype(np.float32))
    return bool(min(width, height) > _TANGLE_MM)


def _blots(points: FloatArray, soaked: FloatArray, least: float) -> list[tuple[FloatArray, FloatArray]]:
    """The surroundings of all places (p, 2) that have the most ink far and wide, and at least so much."""
    found = []
    left = soaked.copy()
    while left.max() > least:
        away = np.hypot(*(points - points[np.argmax(left)]).T)
        near = away < _AROUND_MM
        found.append((points[near], soaked[near]))
        left[away < _BESIDE_MM] = 0.0
    return found


def _middle(points: FloatArray, soaked: FloatArray) -> FloatArray:
    """(2,) of the ink about where most is."""
    near = np.hypot(*(points - points[np.argmax(soaked)]).T) < _NEAR_MM
    middle: FloatArray = soaked[near] @ points[near] / soaked[near].sum()
    return middle
