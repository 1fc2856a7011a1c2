"""What a trajectory is doing when: lowering the pen, drawing, lifting it, travelling, or resting."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.trajectory import Trajectory

REST_MM_S = 1e-3
"""What is slower than this stands still."""


class Phase(IntEnum):
    """Phases in the order in which a stroke goes through them."""

    LOWERING = 0
    RESTING = 1
    DRAWING = 2
    LIFTING = 3
    TRAVELLING = 4


def phases_of(trajectory: Trajectory, tip_mm: FloatArray, clearance_mm: float) -> IntArray:
    """(n_samples - 1,) the phase from each sample to the next. tip_mm: (n_samples, 3).

    Whatever stands still rests. With the pen on the paper at both ends it draws, below the clearance height it
    lifts or is lowered, and the rest is travel.
    """
    steps = np.diff(tip_mm, axis=0)
    rests = np.linalg.norm(steps, axis=1) * trajectory.rate_hz < REST_MM_S
    draws = trajectory.pen[:-1] & trajectory.pen[1:]
    low = (tip_mm[:-1, 2] + tip_mm[1:, 2]) / 2 < clearance_mm
    found: IntArray = np.select(
        [rests, draws, low & (steps[:, 2] > 0), low & (steps[:, 2] < 0)],
        [Phase.RESTING, Phase.DRAWING, Phase.LIFTING, Phase.LOWERING],
        Phase.TRAVELLING,
    )
    return found


def seconds_in(phases: IntArray, rate_hz: float) -> FloatArray:
    """(5,) the time spent in each phase; it all adds up to the duration."""
    seconds: FloatArray = np.bincount(phases, minlength=len(Phase)) / rate_hz
    return seconds
