"""Strokes of a drawing beside an independent optimum of path and timing together, one nonlinear program a stroke."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.joint_optimum import joint_optimum
from benchmarks.targets.row import Row
from benchmarks.targets.strokes import lines, placed_strokes
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.execution.context import PlanContext
from planner.execution.work_chunks import StrokeChunk, timed_strokes
from planner.execution.workers import Workers, executor_of
from planner.motion.timed_stroke import TimedStroke
from planner.settings import PlanSettings

_STROKES = 8
_LONGER_THAN_MM, _MOST_POINTS = 2.0, 12
_RATE_HZ = 1000.0
"""At which rounding to whole samples is little."""
_WORKERS = Workers(2)


def against_joint_optimum(drawing: Path, settings: PlanSettings) -> list[Row]:
    asked = replace(settings, tolerance_mm=0.05, rate_hz=_RATE_HZ)
    arm = load_arm(asked.arm)
    context = PlanContext.of(arm, asked)
    some = [one for one in lines(placed_strokes(drawing, arm, asked), _LONGER_THAN_MM) if len(one) <= _MOST_POINTS]
    spread = [some[index] for index in np.unique(np.linspace(0, len(some) - 1, _STROKES).astype(int)).tolist()]
    chunks = [StrokeChunk(context, [stroke]) for stroke in spread]
    with executor_of(_WORKERS, context.make_ready) as executor:
        found = [times for times in executor(_times, chunks) if np.isfinite(times).all()]
    what = (
        f"strokes of {drawing.stem} (of up to {_MOST_POINTS} points, `--rate {_RATE_HZ:g}`) against an independent"
        " optimum of path and timing together"
    )
    if not found:
        return [Row(what, "≤ 1.03", f"none found for {len(chunks)}")]
    stuck = sum(one < other for one, other in found)
    ours_s = sum(one for one, _ in found)
    least_s = sum(min(one, other) for one, other in found)
    each = sorted(max(one / other, 1.0) for one, other in found)
    return [
        Row(
            what,
            "≤ 1.03",
            f"{len(found)} of {len(chunks)} solved: together {ours_s / least_s:.3f}, each "
            + ", ".join(f"{ratio:.3f}" for ratio in each)
            + (f"; {stuck} of them ended slower than the planner, whose time stands for theirs" if stuck else ""),
            ours_s <= 1.03 * least_s,
        )
    ]


def _times(chunk: StrokeChunk) -> FloatArray:
    """(2,) seconds of the planner and of the optimum, NaN where there is none."""
    (planned,) = timed_strokes(chunk)
    least_s = joint_optimum(chunk.context, chunk.strokes[0], planned) if isinstance(planned, TimedStroke) else None
    if least_s is None or not isinstance(planned, TimedStroke):
        return np.full(2, np.nan)
    return np.array([(len(planned.joints) - 1) / chunk.context.settings.rate_hz, least_s])
