"""What the file of an arm that nobody has calibrated leaves open: errors of its tips, and how its pen is set."""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.error_model.calibration.parameters import Parameters

_PRESSED_MM = (0.2, 1.5)
"""So deep is a pen that is set on the paper before it draws: it leaves a dot."""
_AT_ONCE = 2000


def errors_by(parameters: Parameters, vectors: FloatArray, joints: FloatArray) -> FloatArray:
    """(k, n, 3) errors in mm, to first order, of tips at joints (n, n_joints) by vectors (k, n_parameters)."""
    parts = [
        np.einsum("nip,kp->kni", parameters.jacobian_at(joints[begin : begin + _AT_ONCE]), vectors)
        for begin in range(0, len(joints), _AT_ONCE)
    ]
    errors: FloatArray = np.concatenate(parts, axis=1)
    return errors


def too_high_mm(tips_mm: FloatArray, drawn: BoolArray, random: np.random.Generator) -> FloatArray:
    """(k,) how much lower pens have to be set whose tips go along (k, n, 3): whoever draws has set the pen on the paper
    in the middle of what is drawn. drawn: (n,) samples with the pen on the paper, one at least."""
    inked = tips_mm[:, drawn]
    places = inked[..., :2].mean(axis=0)
    middle = int(np.argmin(np.hypot(*(places - places.mean(axis=0)).T)))
    heights: FloatArray = inked[:, middle, 2] + random.uniform(*_PRESSED_MM, len(inked))
    return heights
