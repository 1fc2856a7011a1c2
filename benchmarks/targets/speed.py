"""How long configurations take, by the closed form and by the nonlinear program."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

from benchmarks.targets.row import Row
from benchmarks.targets.strokes import lines, placed_strokes
from planner.arms.arm_file import load_arm
from planner.inverse_kinematics import nlp
from planner.inverse_kinematics.closed_forms import family_of
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings

_CLOSED_TARGETS = 500_000
_NLP_RUNS = 10
_NLP_TARGETS = 2000
"""At most, of one stroke: the next is warm only where the last is near."""


def configurations(drawing: Path, settings: PlanSettings) -> list[Row]:
    """Targets are the points of the drawing's strokes, repeated as often as needed."""
    arm = load_arm(settings.arm)
    model = ArmModel(arm, cache=False)
    points = np.concatenate(lines(placed_strokes(drawing, arm, settings)))
    tips = np.column_stack((points, np.zeros(len(points))))
    many = np.resize(tips, (_CLOSED_TARGETS, 3))
    pitch = arm.complete(model.configuration_map().reference(many))[:, 1:4].sum(axis=1)
    at_tip = family_of(arm).at_tip
    at_tip(arm, many, pitch)
    began = time.perf_counter()
    at_tip(arm, many, pitch)
    closed_us = (time.perf_counter() - began) / len(many) * 1e6
    longest = max(lines(placed_strokes(drawing, arm, settings)), key=len)[:_NLP_TARGETS]
    few = np.column_stack((longest, np.zeros(len(longest))))
    home, solver = model.configuration_map().home, nlp.NlpSolver(model.kinematics)
    runs_s = []
    for _ in range(_NLP_RUNS):
        began = time.perf_counter()
        solver.solve_sequence(few, home)
        runs_s.append(time.perf_counter() - began)
    warm_us = min(runs_s) / len(few) * 1e6
    return [
        Row("closed form, all branches, a point", "≤ 1 µs", f"{closed_us:.2f} µs", closed_us <= 1.0),
        Row("NLP, a warm point", "≤ 110 µs", f"{warm_us:.0f} µs", warm_us <= 110.0),
    ]
