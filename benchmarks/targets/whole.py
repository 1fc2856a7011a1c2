"""Rows over whole drawings: limits between the cell ends, and what the tolerance is worth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.targets.row import Row
from benchmarks.targets.strokes import TimedPaths, lines, placed_strokes, timed_in_chunks
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.settings import PlanSettings

_SAMPLES_PER_CELL = 20
_CELLS_AT_ONCE = 20_000
_STROKES = 40
_TOLERANCES_MM = (0.01, 0.05, 0.1, 0.2)


def limits_between(files: Sequence[Path], settings: PlanSettings) -> list[Row]:
    """Limits between the cell ends."""
    arm = load_arm(settings.arm)
    worst = np.zeros(3)
    for drawing in files:
        strokes = lines(placed_strokes(drawing, arm, settings))
        chunks = timed_in_chunks(arm, strokes[:: max(len(strokes) // _STROKES, 1)], settings)
        worst = np.max([worst, *(shares_of_limits(paths) for paths in chunks)], axis=0)
    return [
        Row(
            f"limits at {_SAMPLES_PER_CELL} samples a cell, about {_STROKES} strokes of each drawing: velocity,"
            " acceleration, jerk",
            "≤ 1.000 of each",
            ", ".join(f"{share:.4f}" for share in worst),
            bool((worst <= 1.0005).all()),
        )
    ]


def shares_of_limits(paths: TimedPaths) -> FloatArray:
    """(3,) largest shares of the velocity, acceleration and jerk limits, by the chain rule."""
    worst = np.zeros(3)
    joints, limits = paths.joints, paths.limits
    for begin in range(0, len(paths.motion.rates), _CELLS_AT_ONCE):
        cells = np.arange(begin, min(begin + _CELLS_AT_ONCE, len(paths.motion.rates)))
        c0, c1, c2, c3 = (column[:, None] for column in paths.motion.rates[cells].T)
        for f in np.linspace(0.0, 1.0, _SAMPLES_PER_CELL + 1).tolist():
            q1, q2, q3 = (joints.at(cells, np.full(len(cells), f), order) for order in (1, 2, 3))
            b, slope, bend = c0 + f * (c1 + f * (c2 + f * c3)), c1 + f * (2 * c2 + 3 * f * c3), 2 * c2 + 6 * f * c3
            for k, (rate, limit) in enumerate(
                (
                    (q1 * np.sqrt(b), limits.velocity),
                    (q2 * b + 0.5 * q1 * slope, limits.acceleration),
                    ((q3 * b + 1.5 * q2 * slope + 0.5 * q1 * bend) * np.sqrt(b), limits.jerk),
                )
            ):
                worst[k] = max(worst[k], float((np.abs(rate) / limit).max()))
    return worst


def tolerances(drawing: Path, settings: PlanSettings) -> list[Row]:
    """Pen-down time over the tolerance of the pen path."""
    arm = load_arm(settings.arm)
    times = []
    for tolerance_mm in _TOLERANCES_MM:
        coarser = replace(settings, tolerance_mm=tolerance_mm)
        chunks = timed_in_chunks(arm, lines(placed_strokes(drawing, arm, coarser)), coarser)
        times.append(sum(float(paths.time_s.sum()) for paths in chunks))
    asked = ", ".join(f"{tolerance_mm:g}" for tolerance_mm in _TOLERANCES_MM)
    return [
        Row(
            f"pen-down time of {drawing.stem} at tolerance {asked} mm",
            "report",
            ", ".join(f"{time_s:.1f} s" for time_s in times),
        )
    ]
