"""What each stroke amounts to: its length, its time, and how fast the pen goes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray, IntArray
from planner.phases import REST_MM_S
from planner.trajectory import Trajectory

TAP_EXTENT_MM = 0.02
"""A stroke that stays within this is a dot."""


@dataclass(frozen=True, eq=False, slots=True)
class StrokeFigures:
    """One entry a stroke, in drawing order.

    index: the stroke's number. begins_s: when it begins. duration_s: time on the paper, rest before drawing
    included. drawing_s: the same without rest.
    length_mm: of the line between the samples; 0 of a tap. top_speed_mm_s: fastest step between two
    samples.
    """

    index: IntArray
    begins_s: FloatArray
    duration_s: FloatArray
    drawing_s: FloatArray
    length_mm: FloatArray
    top_speed_mm_s: FloatArray

    @property
    def is_tap(self) -> BoolArray:
        """Which strokes are dots."""
        taps: BoolArray = self.length_mm <= TAP_EXTENT_MM
        return taps

    @property
    def mean_speed_mm_s(self) -> FloatArray:
        """Length by the time in which the pen moves, as for the whole drawing; 0 of a tap."""
        mean: FloatArray = np.divide(
            self.length_mm, self.drawing_s, out=np.zeros_like(self.length_mm), where=self.drawing_s > 0
        )
        return mean

    def lost_s(self, speed_mm_s: float) -> FloatArray:
        """Time beyond what the length takes at a constant speed: what corners, limits and rest cost."""
        lost: FloatArray = self.duration_s - self.length_mm / speed_mm_s
        return lost


def stroke_figures(trajectory: Trajectory, tip_mm: FloatArray) -> StrokeFigures:
    """Figures of all strokes. tip_mm: (n_samples, 2 or more) the tip at each sample, arm mm."""
    drawn = np.flatnonzero(trajectory.stroke >= 0)
    index, first, n_samples = np.unique(trajectory.stroke[drawn], return_index=True, return_counts=True)
    steps = np.zeros(len(drawn))
    within = np.diff(trajectory.stroke[drawn]) == 0
    steps[1:][within] = np.linalg.norm(np.diff(tip_mm[drawn, :2], axis=0)[within], axis=1)
    length, top = (
        (np.add.reduceat(steps, first), np.maximum.reduceat(steps, first)) if len(drawn) else (np.zeros(0), np.zeros(0))
    )
    moves = steps * trajectory.rate_hz >= REST_MM_S
    moving = np.add.reduceat(moves.astype(np.int64), first) if len(drawn) else np.zeros(0)
    return StrokeFigures(
        index,
        drawn[first] / trajectory.rate_hz,
        (n_samples - 1) / trajectory.rate_hz,
        moving / trajectory.rate_hz,
        length,
        top * trajectory.rate_hz,
    )
