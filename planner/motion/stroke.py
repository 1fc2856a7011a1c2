"""How strokes become joint samples: lines by way of a smooth path and its timing, taps at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import FloatArray
from planner.inverse_kinematics.references import References
from planner.inverse_kinematics.stroke_configurations import InfeasiblePath
from planner.motion.line import timed_lines
from planner.motion.tap import timed_taps
from planner.motion.timed_stroke import TimedStroke
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings


def samples_of_strokes(
    model: ArmModel, references: References, settings: PlanSettings, strokes: Sequence[FloatArray]
) -> list[TimedStroke | InfeasiblePath]:
    """Joint samples of each stroke (n, 2), arm mm, or why it cannot be drawn."""
    lines = [index for index, stroke in enumerate(strokes) if len(stroke) > 1]
    taps = [index for index, stroke in enumerate(strokes) if len(stroke) == 1]
    made: dict[int, TimedStroke | InfeasiblePath] = {}
    if lines:
        timed = timed_lines(model, references, settings, [strokes[index] for index in lines])
        made.update(zip(lines, timed, strict=True))
    if taps:
        tips_mm = np.concatenate([strokes[index] for index in taps])
        made.update(zip(taps, timed_taps(model, references, settings, tips_mm), strict=True))
    return [made[index] for index in range(len(strokes))]
