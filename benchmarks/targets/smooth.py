"""Pen-down time of smooth strokes beside TOPP-RA's bound, and of any strokes beside the third-order optimum."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.targets.fine_nlp import least_time_s
from benchmarks.targets.row import Row, missing
from benchmarks.targets.strokes import TimedPaths, drawings, lines, placed_strokes, sharpest_turn_deg, timed
from benchmarks.targets.toppra_bound import bound_s
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.motion.speed_limit import pen_speed_mm_s
from planner.settings import PlanSettings
from tests.timing.slp import least_time_s as least_time_slp_s

_SMOOTH_DEG = 15.0
"""A stroke is smooth where its polyline turns by no more than this at any vertex."""
_OF_EACH = 20
_JERKS_PER_S = (20.0, 50.0, 100.0)
"""Jerk limits as multiples of the acceleration limits."""
_UNCAPPED_MM_S = 1e4
_LONGEST_BOUNDED = 240
_FINER_BOUNDED = 4
"""Cells of the strokes whose third-order optimum is set beside the bound too, and how much finer it is found."""
_COMPARED_CELLS = 200
_COMPARED_OF_EACH = 1
_SMALL_CELLS = 120
_SMALL = 4
_FINER = 8
"""Cells of the rivals for each of the planner's: with 2 their optimum of a stroke full of corners is 4 % slower."""


def against_toppra(folder: Path, settings: PlanSettings) -> list[Row]:
    """Within the pen's speed, and without a cap on it: where a stroke is mostly drawn at the cap, planners differ in
    starting and stopping alone."""
    what = (
        f"pen-down time of smooth strokes over 20 mm (no vertex turns more than {_SMOOTH_DEG:g}°,"
        f" at most {_OF_EACH} a drawing) against TOPP-RA without jerk limits"
    )
    target = "≤ 1.05"
    if absent := missing("toppra", what, target):
        return [absent]
    usual_mm_s = pen_speed_mm_s(load_arm(settings.arm), settings)
    rows = []
    for capped in (settings, replace(settings, speed_mm_s=_UNCAPPED_MM_S)):
        groups = _smooth_strokes(folder, capped)
        if not groups:
            return [Row(what, target, "no such strokes")]
        speed = f"pen at most {usual_mm_s:g} mm/s" if capped is settings else "no cap on the pen's speed"
        for per_s in _JERKS_PER_S:
            timings = [group.within(replace(group.limits, jerk=per_s * group.limits.acceleration)) for group in groups]
            bounds = [bound_s(timing.single(path)) for timing in timings for path in range(len(timing.time_s))]
            rows.append(
                _beside_bound(
                    f"{what}: {speed}, jerk limit {per_s:g} /s times the acceleration limit",
                    target,
                    np.concatenate([timing.time_s for timing in timings]),
                    np.array(bounds),
                )
            )
            if per_s == _JERKS_PER_S[0]:
                rows.append(_optimum_beside_bound(speed, timings))
    return rows


def _smooth_strokes(folder: Path, settings: PlanSettings) -> list[TimedPaths]:
    arm = load_arm(settings.arm)
    groups = []
    for drawing in drawings(folder):
        strokes = [
            stroke
            for stroke in lines(placed_strokes(drawing, arm, settings), 20.0)
            if sharpest_turn_deg(stroke) <= _SMOOTH_DEG
        ]
        if strokes:
            groups.append(timed(arm, _spread(strokes, _OF_EACH), settings))
    return groups


def _beside_bound(what: str, target: str, times_s: FloatArray, bounds_s: FloatArray) -> Row:
    known = np.isfinite(bounds_s)
    times_s, bounds_s = times_s[known], bounds_s[known]
    total, ratios = float(times_s.sum() / bounds_s.sum()), times_s / bounds_s
    return Row(
        what,
        target,
        f"{total:.3f} of {len(ratios)} strokes together; by stroke median"
        f" {np.median(ratios):.3f}, worst {ratios.max():.3f}, within the target {(ratios <= 1.05).mean():.0%}",
        total <= 1.05,
    )


def _optimum_beside_bound(speed: str, timings: list[TimedPaths]) -> Row:
    """How much of the distance from the bound is the jerk limit's own: what the third-order optimum takes."""
    ours, optimum, bound = [], [], []
    for timing in timings:
        for path in np.flatnonzero(timing.joints.n_cells <= _LONGEST_BOUNDED)[:_COMPARED_OF_EACH].tolist():
            single = timing.single(path)
            least_s, bounded_s = least_time_s(single, _FINER_BOUNDED), bound_s(single)
            if np.isfinite(least_s) and np.isfinite(bounded_s):
                ours.append(single.time_s)
                optimum.append(least_s)
                bound.append(bounded_s)
    what = f"of these at {_JERKS_PER_S[0]:g} /s, {speed}: what the jerk limit itself costs"
    if not ours:
        return Row(what, "", "no stroke small enough")
    shares = np.sum((ours, optimum), axis=1) / np.sum(bound)
    return Row(
        what,
        "",
        f"of {len(ours)} strokes together the independent third-order optimum takes {shares[1]:.3f} of"
        f" TOPP-RA's bound, the planner {shares[0]:.3f}",
    )


def against_optimum(folder: Path, settings: PlanSettings) -> list[Row]:
    arm = load_arm(settings.arm)
    fine: list[float] = []
    small: list[float] = []
    gave_up = 0
    for drawing in drawings(folder):
        paths = timed(arm, _spread(lines(placed_strokes(drawing, arm, settings)), 12 * _COMPARED_OF_EACH), settings)
        order = np.flatnonzero(paths.joints.n_cells <= _COMPARED_CELLS)[:_COMPARED_OF_EACH]
        for path in order.tolist():
            single = paths.single(path)
            least = least_time_s(single, _FINER)
            gave_up += not np.isfinite(least)
            if np.isfinite(least):
                fine.append(single.time_s / least)
            if single.n_cells <= _SMALL_CELLS and len(small) < _SMALL:
                least = least_time_slp_s(single.derivative, single.n_cells, single.limits, single.cap_at, _FINER)
                small.append(single.time_s / least)
    return [
        _share(
            f"any stroke against the third-order optimum: nonlinear program on {_FINER} times finer cells, Ipopt"
            + (f" (which gave up on {gave_up})" if gave_up else ""),
            fine,
        ),
        _share(f"the same by sequential linear programs on {_FINER} times finer cells, HiGHS (small strokes)", small),
    ]


def _share(what: str, ratios: list[float]) -> Row:
    if not ratios:
        return Row(what, "≤ 1.01", "no stroke small enough")
    return Row(
        what,
        "≤ 1.01",
        f"of {len(ratios)} strokes median {np.median(ratios):.4f}, worst {max(ratios):.4f}",
        max(ratios) <= 1.01,
    )


def _spread(strokes: list[FloatArray], most: int) -> list[FloatArray]:
    """So many of them, evenly chosen."""
    return [strokes[index] for index in np.unique(np.linspace(0, len(strokes) - 1, most).astype(int)).tolist()]
