"""What a plan amounts to, for people: counts, lengths, and where the time goes."""

from __future__ import annotations

from dataclasses import dataclass, field

from planner.arrays import IntArray
from planner.counted import counted
from planner.phases import Phase, seconds_in


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
class PlanSummary:
    """Results of one plan. scale: millimetres on paper for one on the SVG's page. drawn_mm: of the line between the
    samples. where: to lay the paper, in words. hints: what might be asked for instead. pens: in their order."""

    n_strokes: int
    n_taps: int
    drawn_mm: float
    travelled_mm: float
    size_mm: tuple[float, float]
    scale: float
    phases: PhaseTimes
    duration_s: float
    n_samples: int
    rate_hz: float
    warnings: list[str] = field(default_factory=list)
    where: str = ""
    hints: tuple[str, ...] = ()
    pens: tuple[str, ...] = ()

    @property
    def mean_speed_mm_s(self) -> float:
        """Of the pen on the paper; 0 where it draws no line."""
        return self.drawn_mm / self.phases.drawing_s if self.phases.drawing_s > 0 else 0.0

    def lines(self) -> list[str]:
        """A few lines to read."""
        shares = ", ".join(
            f"{name} {seconds:.1f} s ({100 * share:.0f} %)" for name, seconds, share in self.phases.shares()
        )
        taps = f", {self.n_taps} of them {'a tap' if self.n_taps == 1 else 'taps'}" if self.n_taps else ""
        return [
            f"{counted(self.n_strokes, 'stroke')}{taps}: {self.drawn_mm / 1000:.2f} m drawn,"
            f" {self.travelled_mm / 1000:.2f} m travelled pen up",
            f"{self.size_mm[0]:.1f} x {self.size_mm[1]:.1f} mm on paper, {self.scale:.3g} times its size on the page",
            f"takes {clock(self.duration_s)} ({shares}); {self.mean_speed_mm_s:.0f} mm/s on paper in the mean",
            f"{counted(self.n_samples, 'sample')} at {self.rate_hz:g} Hz",
            *([f"pens: {', '.join(self.pens)}"] if self.pens else []),
            *filter(None, [self.where]),
            *(f"hint: {hint}" for hint in self.hints),
        ]


def clock(seconds: float) -> str:
    """A duration for people: seconds, or minutes and seconds, or hours and minutes."""
    minutes, rest = divmod(seconds, 60)
    hours, minutes = divmod(int(minutes), 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest:.0f} s" if minutes else f"{rest:.1f} s"
