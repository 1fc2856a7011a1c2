"""Whole drawings beside a model of AxiDraw's planner: the plotter's own way with the same strokes, at the same pen cap.

What its software does, with the constants of its configuration: one acceleration, a junction speed at each vertex from
the deviation that a rounded corner would have, look-ahead so that each of them can be braked for, and no lift where a
gap is short. Its acceleration is taken in full, where the software takes three quarters unless told otherwise.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from benchmarks.targets.row import Row
from benchmarks.targets.strokes import drawings, placed_strokes
from planner import pipeline
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.errors import PlannerError
from planner.motion.speed_limit import pen_speed_mm_s
from planner.settings import PlanSettings

_INCH_MM = 25.4
DOWN_MM_S2, UP_MM_S2 = 40.0 * _INCH_MM, 60.0 * _INCH_MM
UP_MM_S = 0.75 * 8.6979 * _INCH_MM
DEVIATION_MM = 10.0 / 5000.0 * _INCH_MM
GAP_MM = 0.2
SERVO_S = 0.045 + 0.00269 * 30.0
"""To raise or lower the pen by 30 % of the servo's range, as its ends stand by default."""


def against_axidraw(folder: Path, settings: PlanSettings) -> list[Row]:
    """A row for each drawing: ours joins the same gaps, and says so."""
    arm = load_arm(settings.arm)
    asked = replace(settings, join_mm=GAP_MM)
    rows = []
    for drawing in drawings(folder):
        try:
            made = pipeline.plan(drawing, asked, lambda *_: None)
        except PlannerError as error:
            rows.append(Row(f"{drawing.stem} against AxiDraw as modelled", "≤ 0.75", f"not planned: {error}"))
            continue
        theirs_s = plotter_s(placed_strokes(drawing, arm, asked), pen_speed_mm_s(arm, asked))
        ours_s = made.summary.duration_s
        rows.append(
            Row(
                f"{drawing.stem} against AxiDraw as modelled: full acceleration, gaps up to {GAP_MM} mm joined,"
                " same cap of the pen",
                "≤ 0.75",
                f"{ours_s:.1f} s, AxiDraw {theirs_s:.1f} s: {ours_s / theirs_s:.2f}",
                ours_s <= 0.75 * theirs_s,
            )
        )
    return rows


def plotter_s(strokes: Sequence[FloatArray], cap_mm_s: float) -> float:
    """How long strokes (n, 2) take in their order: pen up to the first, and back up after the last."""
    chains = [strokes[0]]
    total_s = 2 * SERVO_S
    for before, after in pairwise(strokes):
        gap_mm = float(np.hypot(*(after[0] - before[-1])))
        if gap_mm < GAP_MM:
            chains[-1] = np.concatenate((chains[-1], after))
        else:
            chains.append(after)
            total_s += 2 * SERVO_S + way_s(np.stack((before[-1], after[0])), UP_MM_S, UP_MM_S2)
    return total_s + sum(way_s(chain, cap_mm_s, DOWN_MM_S2) for chain in chains)


def way_s(points: FloatArray, cap_mm_s: float, acceleration: float) -> float:
    """How long a polyline (n, 2) takes from rest to rest by trapezia of speed between junctions."""
    steps = np.diff(points, axis=0)
    length = np.hypot(*steps.T)
    steps, length = steps[length > 0.0], length[length > 0.0]
    if not len(length):
        return 0.0
    direction = steps / length[:, None]
    # The half of the angle between two lines, as it is where a circle that touches both passes the vertex.
    half = np.sqrt(np.clip((1.0 + np.sum(direction[1:] * direction[:-1], axis=1)) / 2, 0.0, 1.0))
    with np.errstate(divide="ignore"):
        junction = np.sqrt(acceleration * DEVIATION_MM * half / np.maximum(1.0 - half, 1e-12))
    speed = np.concatenate(([0.0], np.minimum(junction, cap_mm_s), [0.0]))
    for index in range(len(length)):
        speed[index + 1] = min(speed[index + 1], np.sqrt(speed[index] ** 2 + 2 * acceleration * length[index]))
    for index in range(len(length) - 1, -1, -1):
        speed[index] = min(speed[index], np.sqrt(speed[index + 1] ** 2 + 2 * acceleration * length[index]))
    one, other = speed[:-1], speed[1:]
    top = np.minimum(np.sqrt(acceleration * length + (one**2 + other**2) / 2), cap_mm_s)
    ramps_mm = (2 * top**2 - one**2 - other**2) / (2 * acceleration)
    return float(np.sum((2 * top - one - other) / acceleration + (length - ramps_mm) / top))
