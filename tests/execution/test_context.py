"""A context goes to another process as arm and settings, and is built there once."""

from __future__ import annotations

import pickle

import numpy as np

from planner.execution.context import PlanContext
from planner.execution.work_chunks import StrokeChunk
from planner.settings import Method, PlanSettings
from tests.arms.chains import load_once


def test_chunks_of_one_plan_share_one_context_wherever_they_come() -> None:
    context = PlanContext.of(load_once("three_joint"), PlanSettings(arm="three_joint", method=Method.CLOSED_FORM))
    chunks = [StrokeChunk(context, [np.array([[150.0, side], [160.0, side]])]) for side in (0.0, 10.0)]
    one, other = (pickle.loads(pickle.dumps(chunk)).context for chunk in chunks)
    assert one is other is not context
    assert (one.model.arm, one.settings) == (context.model.arm, context.settings)
    assert one.references is other.references


def test_what_is_built_stays_at_home() -> None:
    context = PlanContext.of(load_once("scara"), PlanSettings(arm="scara"))
    before = len(pickle.dumps(context))
    context.make_ready()
    assert context.references is context.references
    assert context.model.arm.minimum is not None
    assert len(pickle.dumps(context)) < before + 2000  # columns of the arm, no models
