"""Gaps that the pen crosses on the paper, where strokes were joined: whether it stays within the tolerance there.

The middle of a gap is as far from the drawing as half the gap. What the pen strays there adds to that, so gaps of
nearly twice the tolerance are crossed where it hardly strays, and else left open.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.kinematics.chain import Kinematics
from planner.motion.between_samples import tips_between
from planner.motion.tolerance import JOIN_SHARE, NARROW_SHARE

_FINE = np.arange(16) / 16
"""Fractions of the way between points of the tip's curve: a fast pen crosses a gap in less than a step."""


class Gaps:
    """The gaps that may be crossed between the ends of strokes (n, 2), as these were before they were joined."""

    def __init__(self, strokes: Sequence[FloatArray]) -> None:
        self.strokes = lines = [stroke for stroke in strokes if len(stroke) > 1]
        self._ends = {end.tobytes() for stroke in lines for end in stroke[[0, -1]]}
        self._lines = {way.tobytes() for stroke in lines if len(stroke) == 2 for way in (stroke, stroke[::-1])}

    def crossed_by(self, stroke: FloatArray, least_mm: float, most_mm: float) -> IntArray:
        """The points of a stroke (n, 2) after which it crosses a gap of such a width."""
        width = np.hypot(*np.diff(stroke, axis=0).T)
        return np.array(
            [
                index
                for index in np.flatnonzero((width > least_mm) & (width <= most_mm * (1.0 + 1e-9))).tolist()
                if stroke[index].tobytes() in self._ends
                and stroke[index + 1].tobytes() in self._ends
                and np.ascontiguousarray(stroke[index : index + 2]).tobytes() not in self._lines
            ],
            dtype=np.int64,
        )


def left_open(
    kinematics: Kinematics, gaps: Gaps, stroke: FloatArray, samples: FloatArray, tolerance_mm: float
) -> list[FloatArray]:
    """The parts of a stroke (n, 2) between gaps that its samples (n, n_joints) do not cross within the tolerance of
    what is drawn on both sides; the stroke alone where they cross all."""
    crossed = gaps.crossed_by(stroke, NARROW_SHARE * tolerance_mm, JOIN_SHARE * tolerance_mm)
    if not len(crossed):
        return [stroke]
    steps = _steps_of_tips(kinematics, samples)
    is_line = np.ones(len(stroke) - 1, dtype=np.bool_)
    is_line[crossed] = False  # every time that it is crossed: another pass over a gap makes no line of it
    pieces = np.stack((stroke[:-1], stroke[1:]), axis=1)[is_line]
    open_ = [index for index in crossed.tolist() if _strays(stroke[index : index + 2], pieces, steps, tolerance_mm)]
    cuts = [index + 1 for index, before in zip(open_, [-1, *open_], strict=False) if index - before > 1]
    if cuts and len(stroke) - cuts[-1] < 2:
        cuts.pop()
    return np.split(stroke, cuts)


def _steps_of_tips(kinematics: Kinematics, samples: FloatArray) -> FloatArray:
    """(n, 2, 2) short straight ways of the tip, at and between the samples (n, n_joints), by both ways in which
    controllers join them."""
    at = kinematics.tip_mm(kinematics.independent_of(samples))[:, :2]
    between = tips_between(kinematics, [samples])[0][..., :2]
    curves = [
        np.concatenate((np.concatenate((at[:-1, None], way), axis=1).reshape(-1, 2), at[-1:]))
        for way in np.split(between, 2, axis=1)
    ]
    return np.concatenate([np.stack((curve[:-1], curve[1:]), axis=1) for curve in curves])


def _strays(gap: FloatArray, pieces: FloatArray, steps: FloatArray, tolerance_mm: float) -> bool:
    """Whether a tip about a gap (2, 2) is off all straight pieces (n, 2, 2) of the stroke that crosses it."""
    middle = gap.mean(axis=0)
    reach_mm = 0.5 * np.hypot(*(gap[1] - gap[0])) + tolerance_mm
    lengths_mm = np.hypot(*(steps[:, 1] - steps[:, 0]).T)
    about = steps[np.hypot(*(steps[:, 0] - middle).T) <= reach_mm + lengths_mm]
    across = (about[:, :1] + _FINE[:, None] * (about[:, 1:] - about[:, :1])).reshape(-1, 2)
    across = across[np.hypot(*(across - middle).T) <= reach_mm]
    near = pieces[_distance(middle[None], pieces)[0] <= reach_mm + tolerance_mm]
    return bool((_distance(across, near) > tolerance_mm).all(axis=1).any())


def _distance(points: FloatArray, pieces: FloatArray) -> FloatArray:
    """(n, m) from points (n, 2) to straight pieces (m, 2, 2)."""
    start, along = pieces[:, 0], pieces[:, 1] - pieces[:, 0]
    offset = points[:, None] - start
    share = np.clip((offset * along).sum(axis=2) / np.maximum((along * along).sum(axis=1), 1e-18), 0.0, 1.0)
    distance: FloatArray = np.linalg.norm(offset - share[..., None] * along, axis=2)
    return distance
