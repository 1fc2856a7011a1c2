"""How long the strokes of a drawing take with the postures of a method, timed as `plan` times them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain, islice

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.inverse_kinematics.stroke_postures import Obstacle
from planner.portions import Kit, pieces_of, stroke_portions, timed_strokes
from planner.settings import PlanSettings


@dataclass(frozen=True, eq=False, slots=True)
class StrokeTimes:
    """seconds: (n_strokes,) with the pen down, NaN where the method is refused; obstacles: why, stroke by stroke."""

    seconds: FloatArray
    obstacles: Sequence[Obstacle]


def stroke_times(arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings) -> StrokeTimes:
    """Strokes (n, 2) in arm mm by the method of the settings, on the same pen paths whatever the method."""
    kit = Kit.of(arm, settings)
    pieces = pieces_of(kit, strokes)
    portions = stroke_portions(kit, list(chain.from_iterable(pieces)))
    results = chain.from_iterable(map(timed_strokes, portions))
    seconds = np.full(len(strokes), np.nan)
    obstacles: list[Obstacle] = []
    for index, stroke_pieces in enumerate(pieces):
        made = list(islice(results, len(stroke_pieces)))
        met = [result for result in made if isinstance(result, Obstacle)]
        obstacles += met[:1]
        if not met:
            seconds[index] = sum(len(result.joints) - 1 for result in made
                                 if not isinstance(result, Obstacle)) / settings.rate_hz
    return StrokeTimes(seconds, obstacles)
