"""How long the strokes of a drawing take with the configurations of a method, timed as `plan` times them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, islice

import numpy as np

from planner.arrays import FloatArray
from planner.execution.context import PlanContext
from planner.execution.work_chunks import pieces_of, stroke_chunks, timed_strokes
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings


@dataclass(frozen=True, eq=False, slots=True)
class StrokeTimes:
    """seconds: (n_strokes,) with the pen down, NaN where the method is refused; infeasible_paths: why, stroke by
    stroke."""

    seconds: FloatArray
    infeasible_paths: Sequence[InfeasiblePath]


def stroke_times(model: ArmModel, strokes: Sequence[FloatArray], settings: PlanSettings) -> StrokeTimes:
    """Strokes (n, 2) in arm mm by the method of the settings, on the same pen paths whatever the method."""
    context = PlanContext(model, settings)
    pieces = pieces_of(context, strokes)
    chunks = stroke_chunks(context, list(chain.from_iterable(pieces)))
    results = chain.from_iterable(map(timed_strokes, chunks))
    seconds = np.full(len(strokes), np.nan)
    infeasible_paths: list[InfeasiblePath] = []
    for index, stroke_pieces in enumerate(pieces):
        made = list(islice(results, len(stroke_pieces)))
        met = [result for result in made if isinstance(result, InfeasiblePath)]
        infeasible_paths += met[:1]
        if not met:
            seconds[index] = (
                sum(len(result.joints) - 1 for result in made if not isinstance(result, InfeasiblePath))
                / settings.rate_hz
            )
    return StrokeTimes(seconds, infeasible_paths)
