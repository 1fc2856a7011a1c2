"""The one account of a trajectory: how much, how long and how fast. Whatever tells of these takes them from here."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.counted import counted, metres
from planner.phases import Phase, phases_of, seconds_in
from planner.stroke_figures import stroke_figures
from planner.trajectory import Trajectory


@dataclass(frozen=True, slots=True)
class PhaseTimes:
    """Seconds spent in each phase of a trajectory, as `phases_of` tells them; together they are its duration."""

    drawing_s: float
    lowering_s: float
    lifting_s: float
    travelling_s: float
    resting_s: float

    @staticmethod
    def of(phases: IntArray, rate_hz: float) -> PhaseTimes:
        """Of the phases (n_samples - 1,) from sample to sample."""
        seconds = dict(zip(Phase, seconds_in(phases, rate_hz).tolist(), strict=True))
        return PhaseTimes(
            seconds[Phase.DRAWING],
            seconds[Phase.LOWERING],
            seconds[Phase.LIFTING],
            seconds[Phase.TRAVELLING],
            seconds[Phase.RESTING],
        )

    @property
    def total_s(self) -> float:
        return self.drawing_s + self.lowering_s + self.lifting_s + self.travelling_s + self.resting_s

    def shares(self) -> list[tuple[str, float, float]]:
        """The phases that take time: name, seconds, and share of the whole."""
        return [
            (name, seconds, seconds / self.total_s)
            for name, seconds in (
                ("drawing", self.drawing_s),
                ("lowering", self.lowering_s),
                ("lifting", self.lifting_s),
                ("travelling", self.travelling_s),
                ("resting", self.resting_s),
            )
            if seconds > 0
        ]


@dataclass(frozen=True, slots=True)
class Account:
    """What a trajectory amounts to. n_lifts: how often the pen leaves the paper. drawn_mm, travelled_mm: the way of the
    tip over the paper from sample to sample, within strokes, and all the rest."""

    n_strokes: int
    n_taps: int
    n_lifts: int
    drawn_mm: float
    travelled_mm: float
    phases: PhaseTimes
    duration_s: float
    n_samples: int
    rate_hz: float

    @property
    def mean_speed_mm_s(self) -> float:
        """Of the pen while it draws, rest left out; 0 where it draws no line."""
        return self.drawn_mm / self.phases.drawing_s if self.phases.drawing_s > 0 else 0.0

    def amount(self) -> str:
        """Strokes, taps, lifts and lengths in words."""
        taps = f", {self.n_taps} of them {'a tap' if self.n_taps == 1 else 'taps'}" if self.n_taps else ""
        return (
            f"{counted(self.n_strokes, 'stroke')}{taps}, {counted(self.n_lifts, 'pen lift')}:"
            f" {metres(self.drawn_mm)} drawn, {metres(self.travelled_mm)} travelled pen up"
        )

    def mean_speed(self) -> str:
        """In words."""
        return f"{self.mean_speed_mm_s:.0f} mm/s on paper in the mean"


def account_of(trajectory: Trajectory, tip_mm: FloatArray, clearance_mm: float) -> Account:
    """tip_mm: (n_samples, 3) the tip at each sample. clearance_mm: up to which the pen lifts and is lowered."""
    strokes = stroke_figures(trajectory, tip_mm)
    drawn_mm = float(strokes.length_mm.sum())
    way_mm = float(np.linalg.norm(np.diff(tip_mm[:, :2], axis=0), axis=1).sum())
    return Account(
        n_strokes=len(strokes.index),
        n_taps=int(np.count_nonzero(strokes.is_tap)),
        n_lifts=int(np.count_nonzero(trajectory.pen[:-1] & ~trajectory.pen[1:])),
        drawn_mm=drawn_mm,
        travelled_mm=max(way_mm - drawn_mm, 0.0),
        phases=PhaseTimes.of(phases_of(trajectory, tip_mm, clearance_mm), trajectory.rate_hz),
        duration_s=trajectory.duration_s,
        n_samples=trajectory.n_samples,
        rate_hz=trajectory.rate_hz,
    )
