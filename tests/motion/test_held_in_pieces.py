"""A stroke that no speed keeps within the tolerance as a whole is drawn in pieces, and held."""

from __future__ import annotations

import numpy as np
import pytest

from planner.arrays import FloatArray
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


WALK = np.array([100.0, 0.0]) + np.cumsum(np.random.default_rng(4).uniform(-2.0, 2.0, (25, 2)), axis=0)


def moved(stroke: FloatArray) -> PenDrawing:
    context = PlanContext.of(load_once("drawing_arm"), PlanSettings(rate_hz=250.0, tolerance_mm=0.05))
    drawing = PenDrawing(PenGroup(PLAIN, ()), context, [np.array([(100.0, 0.0), (110.0, 5.0)]), stroke])
    with executor_of(ALONE) as executor:
        drawing.move(executor, unreported, 0)
    return drawing


def test_a_knot_is_held_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("planner.pen_drawing._HALVINGS", 0)
    assert [motion.held for motion in moved(KNOT).timed] == [True, True]


def test_what_is_not_held_whole_is_held_in_pieces_and_still_one_stroke(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of the rounds by which a stroke is slowed where it strays, one is left here: few strokes need all of them."""
    monkeypatch.setattr("planner.motion.held_motion._ROUNDS", 1)
    drawing = moved(WALK)
    assert [motion.held for motion in drawing.timed] == [True, True] and not drawing.notes
    joints = drawing.timed[1].joints * 250.0
    assert (np.abs(np.diff(joints, axis=0)) <= drawing.context.model.limits.velocity).all()
    monkeypatch.setattr("planner.pen_drawing._HALVINGS", 0)
    assert [motion.held for motion in moved(WALK).timed] == [True, False]
