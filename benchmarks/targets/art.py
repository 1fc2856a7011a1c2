"""Whole drawings and their ink, all strokes, beside plotters and beside TOPP-RA's followers, at two sample rates."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from pathlib import Path

from benchmarks.targets.axidraw import GAP_MM, axidraw
from benchmarks.targets.ink import InkTimes, ink_times
from benchmarks.targets.row import Row, Table, missing
from benchmarks.targets.saxi import saxi
from benchmarks.targets.strokes import lines, placed_strokes
from planner import pipeline
from planner.account import PhaseTimes
from planner.arms.arm_file import load_arm
from planner.errors import PlannerError
from planner.execution.workers import Workers
from planner.motion.speed_limit import pen_speed_mm_s
from planner.settings import PlanSettings

TOLERANCE_MM = 0.05
_RATES_HZ = (100.0, 250.0)
_WORKERS = Workers(2)
_COLUMNS = (
    *("drawing", "Hz", "whole s", "draw", "lower", "lift", "travel"),
    *("whole: AxiDraw", "saxi"),
    *("ink: AxiDraw", "saxi", "TOPP-RA slowed", "TOPP-RA + Ruckig", "no jerk"),
)
_OF_AXIDRAW = 0.75
_WHOLE_S = {"prague": 215.0, "multi_skull": 1400.0, "plant": 64.0, "voronoi": 140.0}
_PEN_DOWN_S = {100.0: 165.0, 250.0: 150.0}


@dataclass(frozen=True, slots=True)
class Beside:
    """One drawing at one rate: ours by phase, (ink, whole) of the plotters, and the ink of TOPP-RA's followers, None
    where that is not installed."""

    drawing: str
    rate_hz: float
    ours: PhaseTimes
    axidraw_s: tuple[float, float]
    saxi_s: tuple[float, float]
    ink: InkTimes | None

    def line(self) -> tuple[str, ...]:
        ours, ink = self.ours, self.ink
        others = (
            [ours.drawing_s / rival for rival in (ink.slowed_s, ink.smoothed_s, ink.bound_s)] if ink else 3 * [None]
        )
        ratios = [
            ours.total_s / self.axidraw_s[1],
            ours.total_s / self.saxi_s[1],
            ours.drawing_s / self.axidraw_s[0],
            ours.drawing_s / self.saxi_s[0],
            *others,
        ]
        phases = (ours.total_s, ours.drawing_s, ours.lowering_s, ours.lifting_s, ours.travelling_s)
        return (
            self.drawing,
            f"{self.rate_hz:g}",
            *(f"{seconds:.1f}" for seconds in phases),
            *("–" if ratio is None else f"{ratio:.2f}" for ratio in ratios),
        )


def art(files: Sequence[Path], settings: PlanSettings) -> list[Row | Table]:
    """Of all drawings, with gaps joined that AxiDraw joins."""
    found, rows = [], []
    for drawing, rate_hz in product(files, _RATES_HZ):
        asked = replace(settings, tolerance_mm=TOLERANCE_MM, rate_hz=rate_hz, join_mm=GAP_MM)
        try:
            found.append(_beside(drawing, asked))
        except PlannerError as error:
            rows.append(Row(f"{drawing.stem} at {rate_hz:g} Hz", "", f"not planned: {error}"))
    if absent := missing("toppra", "ink beside TOPP-RA", "report"):
        rows.append(absent)
    for one in found:
        if one.rate_hz == max(_RATES_HZ) and one.drawing in _WHOLE_S:
            target_s = _WHOLE_S[one.drawing]
            what = f"whole {one.drawing}, `--rate {one.rate_hz:g} --tolerance {TOLERANCE_MM:g} --join {GAP_MM:g}`"
            whole_s = one.ours.total_s
            rows.append(Row(what, f"≤ {target_s:g} s", f"{whole_s:.1f} s", whole_s <= target_s))
    return [*rows, *_against_axidraw(found), _table(found)] if found else rows


def _beside(drawing: Path, settings: PlanSettings) -> Beside:
    arm = load_arm(settings.arm)
    phases = pipeline.plan(drawing, settings, lambda *_: None, _WORKERS).summary.phases
    strokes, cap_mm_s = placed_strokes(drawing, arm, settings), pen_speed_mm_s(arm, settings)
    return Beside(
        drawing.stem,
        settings.rate_hz,
        phases,
        axidraw(cap_mm_s).ink_and_whole_s(strokes),
        saxi(cap_mm_s).ink_and_whole_s(strokes),
        None if missing("toppra", "", "") else ink_times(lines(strokes), settings, _WORKERS),
    )


def _against_axidraw(found: Sequence[Beside]) -> list[Row]:
    rows = []
    for rate_hz in _RATES_HZ:
        ratios = {one.drawing: one.ours.total_s / one.axidraw_s[1] for one in found if one.rate_hz == rate_hz}
        if not ratios:
            continue
        beaten = [name for name, ratio in ratios.items() if ratio > _OF_AXIDRAW]
        told = "" if not beaten else "; over it: " + ", ".join(f"{name} {ratios[name]:.2f}" for name in beaten)
        rows.append(
            Row(
                f"whole drawings against AxiDraw as modelled, all {len(ratios)}, at {rate_hz:g} Hz",
                f"≤ {_OF_AXIDRAW:g} of each",
                f"best {min(ratios.values()):.2f}, worst {max(ratios.values()):.2f}{told}",
                not beaten,
            )
        )
    return rows


def _table(found: Sequence[Beside]) -> Table:
    unsolved = sum(one.ink.unsolved for one in found if one.ink)
    return Table(
        "Whole drawings and their ink",
        f"Tolerance {TOLERANCE_MM:g} mm, gaps up to {GAP_MM:g} mm joined. Seconds by phase; then our time over the"
        " rival's, of the whole and of the ink of all strokes: less than 1 is sooner. AxiDraw: its own planner as"
        " modelled, in full acceleration, with the arm's cap on the pen's speed. saxi: its fast profile as modelled."
        " Neither limits jerk. TOPP-RA slowed: evenly, until its samples keep velocity, acceleration and jerk limits."
        " TOPP-RA + Ruckig: from state to state within all limits and the tolerance. Both are given the planner's own"
        " paths, joint curves and caps. No jerk: TOPP-RA without jerk limits on the same, which is a bound and no"
        " rival." + (f" Of all pieces of strokes a rival found no way for {unsolved}." if unsolved else ""),
        _COLUMNS,
        [one.line() for one in found],
    )


def pen_down(drawing: Path, settings: PlanSettings) -> list[Row | Table]:
    """Pen-down time of one drawing with the usual joins."""
    rows: list[Row | Table] = []
    for rate_hz, target_s in _PEN_DOWN_S.items():
        asked = replace(settings, tolerance_mm=TOLERANCE_MM, rate_hz=rate_hz)
        drawn_s = pipeline.plan(drawing, asked, lambda *_: None, _WORKERS).summary.phases.drawing_s
        what = f"pen-down time of {drawing.stem}, `--tolerance {TOLERANCE_MM:g} --rate {rate_hz:g}`"
        known = drawing.stem == "prague"
        rows.append(
            Row(
                what,
                f"≤ {target_s:g} s" if known else "report",
                f"{drawn_s:.1f} s",
                drawn_s <= target_s if known else None,
            )
        )
    return rows
