"""Timings of any strokes beside the third-order optimum of the same paths."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.targets.fine_nlp import least_time_s
from benchmarks.targets.row import Row
from benchmarks.targets.strokes import lines, placed_strokes, timed
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.settings import PlanSettings
from tests.timing.slp import least_time_s as least_time_slp_s

_COMPARED_CELLS = 200
_COMPARED_OF_EACH = 1
_SMALL_CELLS = 120
_SMALL = 4
_FINER = 8
"""Cells of the rivals for each of the planner's: with 2 their optimum of a stroke full of corners is 4 % slower."""


def against_optimum(files: Sequence[Path], settings: PlanSettings) -> list[Row]:
    arm = load_arm(settings.arm)
    fine: list[float] = []
    small: list[float] = []
    gave_up = 0
    for drawing in files:
        paths = timed(arm, _spread(lines(placed_strokes(drawing, arm, settings)), 12 * _COMPARED_OF_EACH), settings)
        order = np.flatnonzero(paths.joints.n_cells <= _COMPARED_CELLS)[:_COMPARED_OF_EACH]
        for path in order.tolist():
            single = paths.single(path)
            least = least_time_s(single, _FINER)
            gave_up += not np.isfinite(least)
            if np.isfinite(least):
                fine.append(single.time_s / least)
            if single.n_cells <= _SMALL_CELLS and len(small) < _SMALL:
                least = least_time_slp_s(single.derivative, single.n_cells, single.limits, single.cap_at, _FINER)
                small.append(single.time_s / least)
    return [
        _share(
            f"any stroke against the third-order optimum: nonlinear program on {_FINER} times finer cells, Ipopt"
            + (f" (which gave up on {gave_up})" if gave_up else ""),
            fine,
        ),
        _share(f"the same by sequential linear programs on {_FINER} times finer cells, HiGHS (small strokes)", small),
    ]


def _share(what: str, ratios: list[float]) -> Row:
    if not ratios:
        return Row(what, "≤ 1.01", "no stroke small enough")
    return Row(
        what,
        "≤ 1.01",
        f"of {len(ratios)} strokes median {np.median(ratios):.4f}, worst {max(ratios):.4f}",
        max(ratios) <= 1.01,
    )


def _spread(strokes: list[FloatArray], most: int) -> list[FloatArray]:
    """So many of them, evenly chosen."""
    return [strokes[index] for index in np.unique(np.linspace(0, len(strokes) - 1, most).astype(int)).tolist()]
