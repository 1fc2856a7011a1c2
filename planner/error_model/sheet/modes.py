"""How an arm that was never calibrated may move its marks: a few modes that come with them, so that marks which stand
close together can be told apart on a photo by how they are off together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from planner.arrays import FloatArray
from planner.error_model.sheet.marks import Mark

_N_MODES = 24


def with_modes(marks: Sequence[Mark], draws_mm: FloatArray) -> list[Mark]:
    """The marks with the modes of an arm's errors.

    draws_mm: (m, n, 2) where n marks would come, less where they are meant, for m arms drawn at random from all that
    the arm at hand may be, 60 or more. The modes are the principal ones of these (their second moments about nothing,
    for an arm as it should be moves no mark), each with the length of one standard deviation.
    """
    m, n, _ = draws_mm.shape
    _, sizes, directions = np.linalg.svd(draws_mm.reshape(m, 2 * n) / np.sqrt(m), full_matrices=False)
    modes = (sizes[:, None] * directions)[:_N_MODES].reshape(-1, n, 2)
    return [
        replace(mark, modes_mm=tuple((float(x), float(y)) for x, y in modes[:, index]))
        for index, mark in enumerate(marks)
    ]


def modes_mm(marks: Sequence[Mark]) -> FloatArray | None:
    """(k, n, 2): the modes that came with the marks; None where there are none."""
    if not marks[0].modes_mm:
        return None
    return np.array([mark.modes_mm for mark in marks]).transpose(1, 0, 2)
