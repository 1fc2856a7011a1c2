"""What rivals take for the ink of a drawing: all strokes, on the planner's own paths, with the same limits and cap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain

import numpy as np

from benchmarks.targets import toppra_ruckig, toppra_slowed
from benchmarks.targets.strokes import untimed
from benchmarks.targets.toppra_profile import profile_of
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.execution.context import PlanContext
from planner.execution.work_chunks import StrokeChunk, pieces_of, stroke_chunks
from planner.execution.workers import Workers, executor_of
from planner.settings import PlanSettings


@dataclass(frozen=True, slots=True)
class InkTimes:
    """Seconds with the pen down, of all strokes together. bound_s: TOPP-RA without jerk limits; slowed_s: the same,
    slowed until its samples keep all limits; smoothed_s: with Ruckig from state to state. unsolved: pieces of strokes
    that a rival could not do, for which it is let have the time of the bound."""

    bound_s: float
    slowed_s: float
    smoothed_s: float
    unsolved: int


def ink_times(strokes: Sequence[FloatArray], settings: PlanSettings, workers: Workers) -> InkTimes:
    """Of strokes (n > 1, 2), arm mm."""
    context = PlanContext.of(load_arm(settings.arm), settings)
    chunks = stroke_chunks(context, list(chain.from_iterable(pieces_of(context, strokes))))
    with executor_of(workers, context.make_ready) as executor:
        rows = np.concatenate(list(executor(_of_chunk, chunks)))
    unsolved = ~np.isfinite(rows).all(axis=1)
    rows = np.where(np.isfinite(rows), rows, rows[:, :1])
    bound_s, slowed_s, smoothed_s = np.nansum(rows, axis=0).tolist()
    return InkTimes(bound_s, slowed_s, smoothed_s, int(unsolved.sum()))


def _of_chunk(chunk: StrokeChunk) -> FloatArray:
    """(n_strokes, 3) seconds of each, NaN where there are none."""
    context, strokes = chunk.context, list(chunk.strokes)
    settings = context.settings
    found = np.full((len(strokes), 3), np.nan)
    for index, path in enumerate(untimed(context, strokes)):
        profile = profile_of(path)
        if profile is None:
            continue
        samples = toppra_slowed.slowed(profile, settings.rate_hz)
        way = toppra_ruckig.smoothed(profile, strokes[index], context.model.kinematics, settings.tolerance_mm)
        found[index] = profile.duration_s, (len(samples) - 1) / settings.rate_hz, way.duration_s
    return found
