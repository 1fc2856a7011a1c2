"""A stroke that no speed keeps within the tolerance as a whole is drawn in pieces, and held."""

from __future__ import annotations

import numpy as np
import pytest

from planner.drawing.pen_groups import PLAIN, PenGroup
from planner.execution.context import PlanContext
from planner.execution.workers import ALONE, executor_of
from planner.pen_drawing import PenDrawing
from planner.progress import unreported
from planner.settings import PlanSettings
from tests.arms.chains import load_once

# Tiny strokes of multi_skull that were joined over lines: to and fro within fractions of a millimetre.
KNOT = np.array(
    [
        (90.7601, 32.3988), (90.7571, 32.4018), (90.8521, 32.4694), (90.2839, 33.0376), (90.1857, 32.9732),
        (90.4613, 32.6976), (90.533, 32.7886), (90.6046, 32.8795), (90.5512, 32.9329), (90.4127, 33.0714),
        (90.3821, 33.102), (90.2839, 33.0376), (87.4438, 35.8777),
    ]
)  # fmt: skip


def moved() -> PenDrawing:
    context = PlanContext.of(load_once("drawing_arm"), PlanSettings(rate_hz=250.0, tolerance_mm=0.05))
    drawing = PenDrawing(PenGroup(PLAIN, ()), context, [np.array([(100.0, 0.0), (110.0, 5.0)]), KNOT])
    with executor_of(ALONE) as executor:
        drawing.move(executor, unreported, 0)
    return drawing


def test_a_knot_is_held_in_pieces_and_still_one_stroke(monkeypatch: pytest.MonkeyPatch) -> None:
    drawing = moved()
    assert [motion.held for motion in drawing.timed] == [True, True] and not drawing.notes
    joints = drawing.timed[1].joints * 250.0
    assert (np.abs(np.diff(joints, axis=0)) <= drawing.context.model.limits.velocity).all()
    monkeypatch.setattr("planner.pen_drawing._HALVINGS", 0)
    assert [motion.held for motion in moved().timed] == [True, False]
