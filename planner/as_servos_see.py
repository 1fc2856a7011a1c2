"""What servos see of a trajectory that has more samples than they take set points."""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray


def samples_a_set_point(rate_hz: float, period_s: float | None) -> int:
    """Every how many samples the servos take one; 1 where they take all, or it is not known. Samples in between at a
    period that is not a whole number of them are counted as if they were one more."""
    return 1 if period_s is None else max(int(np.ceil(period_s * rate_hz - 1e-6)), 1)


def cut_corners_mm(tip_mm: FloatArray, down: BoolArray, every: int) -> tuple[float, int]:
    """How far the tip (n, 3) is from the straight lines that it goes along if only one in `every` samples is taken,
    whichever is the first, at most, and the sample where; counted where the pen is `down` (n,) all the while."""
    worst, where = 0.0, 0
    n = len(tip_mm) - every
    if every < 2 or n < 1:
        return worst, where
    begins, ends = tip_mm[:n], tip_mm[every:]
    along = ends - begins
    square = np.maximum(np.einsum("ij,ij->i", along, along), 1e-18)
    inside = np.convolve(down, np.ones(every + 1), mode="valid") > every
    for k in range(1, every):
        offset = tip_mm[k : n + k] - begins
        share = np.clip(np.einsum("ij,ij->i", offset, along) / square, 0.0, 1.0)
        away = np.where(inside[:n], np.linalg.norm(offset - share[:, None] * along, axis=1), 0.0)
        at = int(np.argmax(away))
        if away[at] > worst:
            worst, where = float(away[at]), at + k
    return worst, where
