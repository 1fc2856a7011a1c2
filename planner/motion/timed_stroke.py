"""A stroke in time: what of it becomes part of the trajectory, and where travel moves begin and end."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Contact:
    """Where a travel move leaves or meets the paper: the tip (2,) in mm and the independent joints (n_independent,)
    there."""

    tip_mm: FloatArray
    configuration: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class TimedStroke:
    """A stroke ready to be drawn: joint samples (n, n_joints) and where it touches down and lifts off.

    converged: whether its timing is near the least time, rather than the fallback. held: whether the pen stays within
    the tolerance between its samples.
    """

    joints: FloatArray
    first: Contact
    last: Contact
    dwell_samples: int
    converged: bool = True
    held: bool = True

    @staticmethod
    def of(pieces: Sequence[TimedStroke]) -> TimedStroke:
        """One stroke of pieces that each begin at rest where the one before ended."""
        if len(pieces) == 1:
            return pieces[0]
        joints = np.concatenate([pieces[0].joints, *(piece.joints[1:] for piece in pieces[1:])])
        return TimedStroke(
            joints,
            pieces[0].first,
            pieces[-1].last,
            pieces[0].dwell_samples,
            all(piece.converged for piece in pieces),
            all(piece.held for piece in pieces),
        )
