"""How dense dots and scribbles have to be for the ink to cover a share of the paper, overlaps and all."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_LAID = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.4)
_BY_DOTS = (0.0, 0.1, 0.2, 0.298, 0.4, 0.495, 0.584, 0.674, 0.746, 0.809, 0.859, 0.897, 0.935, 0.961)
_BY_SCRIBBLE = (0.0, 0.086, 0.174, 0.255, 0.343, 0.442, 0.51, 0.592, 0.668, 0.738, 0.822, 0.879, 0.942, 0.975)
"""Ink laid on a patch of paper of one tone, and the share of it that was then covered, measured. What is left of the
paper at the end would take far more ink."""


def dot_density(tone: NDArray[np.float32], line_mm: float) -> NDArray[np.float32]:
    """Dots of the width of a line to a square mm."""
    laid = _laid(tone, _BY_DOTS)
    return laid / np.float32(np.pi * line_mm**2 / 4.0)


def scribble_density(tone: NDArray[np.float32], line_mm: float) -> NDArray[np.float32]:
    """Points to a square mm of a short tour through them: its length grows as the square root of their number."""
    laid = _laid(tone, _BY_SCRIBBLE)
    return (laid / np.float32(line_mm)) ** 2


def _laid(tone: NDArray[np.float32], covered: tuple[float, ...]) -> NDArray[np.float32]:
    return np.interp(tone, covered, _LAID).astype(np.float32)
