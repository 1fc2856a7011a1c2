"""Rows over whole drawings: limits between the cell ends, stopping at every point, phases, order, tolerance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np

from benchmarks.targets.row import Row
from benchmarks.targets.strokes import TimedPaths, drawings, length_mm, lines, placed_strokes, timed_in_chunks
from planner import pipeline
from planner.account import PhaseTimes
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.drawing.order import ordered
from planner.errors import PlannerError
from planner.inverse_kinematics.references import references_of
from planner.inverse_kinematics.stroke_configurations import exact_configurations
from planner.kinematics.limits import Limits
from planner.motion.speed_limit import pen_speed_mm_s
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings
from planner.travel.ruckig_profile import rest_to_rest

_SAMPLES_PER_CELL = 20
_CELLS_AT_ONCE = 20_000
_TOLERANCES_MM = (0.01, 0.05, 0.1, 0.2)


def limits_and_stopping(folder: Path, settings: PlanSettings) -> list[Row]:
    """Both from one timing of all strokes."""
    arm = load_arm(settings.arm)
    speed_mm_s = pen_speed_mm_s(arm, settings)
    worst, flowing_s, halting_s, least_s, n_points = np.zeros(3), 0.0, 0.0, 0.0, 0
    by_drawing = []
    for drawing in drawings(folder):
        strokes = lines(placed_strokes(drawing, arm, settings))
        chunks = timed_in_chunks(arm, strokes, settings)
        flows_s = sum(float(paths.time_s.sum()) for paths in chunks)
        halts_s = stopping_s(arm, strokes, settings)
        worst = np.max([worst, *(shares_of_limits(paths) for paths in chunks)], axis=0)
        flowing_s, halting_s = flowing_s + flows_s, halting_s + halts_s
        least_s += sum(map(length_mm, strokes)) / speed_mm_s
        n_points += sum(map(len, strokes))
        by_drawing.append(f"{drawing.stem} {halts_s / flows_s:.1f}")
    return [
        Row(
            f"limits at {_SAMPLES_PER_CELL} samples a cell, all drawings: velocity, acceleration, jerk",
            "≤ 1.000 of each",
            ", ".join(f"{share:.4f}" for share in worst),
            bool((worst <= 1.0005).all()),
        ),
        Row(
            f"pen-down time against stopping at each of {n_points} points (Ruckig from rest to rest, same limits)",
            "at least 10 x shorter",
            f"{flowing_s:.0f} s, stopping {halting_s:.0f} s: {halting_s / flowing_s:.1f} x ("
            + ", ".join(by_drawing)
            + f"); at {speed_mm_s:g} mm/s all along, round every corner, it would be"
            f" {halting_s / least_s:.1f} x",
            halting_s >= 10 * flowing_s,
        ),
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


def stopping_s(arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings) -> float:
    """Sum of the fastest moves from point to point, straight in the joints, at rest at each."""
    limits = Limits.of(arm)
    points = np.concatenate(strokes)
    tips = np.column_stack((points, np.zeros(len(points))))
    model = ArmModel(arm, cache=False)
    references = references_of(model, settings.method, settings.weights).at(tips)
    independent, _ = exact_configurations(model.kinematics, references, tips)
    steps = np.maximum(np.abs(np.diff(arm.complete(independent), axis=0)), 1e-12)
    way_mm = np.maximum(np.hypot(*np.diff(points, axis=0).T), 1e-12)
    inside = np.ones(len(steps), dtype=bool)
    inside[np.cumsum([len(stroke) for stroke in strokes])[:-1] - 1] = False
    velocity = np.minimum((limits.velocity / steps).min(axis=1), pen_speed_mm_s(arm, settings) / way_mm)[inside]
    acceleration, jerk = ((limit / steps).min(axis=1)[inside] for limit in (limits.acceleration, limits.jerk))
    return sum(
        rest_to_rest(1.0, v, a, j).duration_s
        for v, a, j in zip(velocity.tolist(), acceleration.tolist(), jerk.tolist(), strict=True)
    )


def phases_and_order(folder: Path, settings: PlanSettings) -> list[Row]:
    """Whole drawings: time by phase, and pen-up time against strokes in the order of least pen-up way."""
    rows = []
    total, straight_total = 0.0, 0.0

    def shortest_way(
        strokes: Sequence[FloatArray], start_mm: FloatArray, *_: object, **__: object
    ) -> tuple[list[FloatArray], bool]:
        return ordered(strokes, start_mm)

    for drawing in drawings(folder):
        try:
            phases = _phases(drawing, settings)
            with patch.object(pipeline, "ordered", shortest_way):
                straight = _phases(drawing, settings)
        except PlannerError as error:
            rows.append(Row(f"whole drawing, {drawing.stem}", "report", str(error)))
            continue
        total, straight_total = total + _pen_up_s(phases), straight_total + _pen_up_s(straight)
        rows.append(
            Row(
                f"whole drawing, {drawing.stem}",
                "report",
                f"{phases.total_s:.1f} s: drawing {phases.drawing_s:.1f},"
                f" lowering {phases.lowering_s:.1f}, lifting {phases.lifting_s:.1f},"
                f" travelling {phases.travelling_s:.1f},"
                f" resting {phases.resting_s:.1f}; pen up {_pen_up_s(straight):.1f} s in Euclidean order",
            )
        )
    rows.append(
        Row(
            "pen-up time of all drawings against strokes in Euclidean order",
            "never longer",
            f"{total:.1f} s against {straight_total:.1f} s: {total / max(straight_total, 1e-9):.4f}",
            total <= straight_total * (1 + 1e-9),
        )
    )
    return rows


def _phases(drawing: Path, settings: PlanSettings) -> PhaseTimes:
    return pipeline.plan(drawing, settings, lambda *_: None).summary.phases


def _pen_up_s(phases: PhaseTimes) -> float:
    return phases.lowering_s + phases.lifting_s + phases.travelling_s


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
