"""What a plan amounts to, for people."""

from __future__ import annotations

from dataclasses import dataclass, field

from planner.account import Account
from planner.counted import clock, counted


@dataclass(frozen=True, slots=True)
class PlanSummary(Account):
    """The account of the planned trajectory, and what else is to be said. size_mm: of the ink, width and height.
    scale: millimetres on paper for one on the SVG's page. where: to lay the paper, in words. hints: what might be asked
    for instead, the most useful first. pens: in their order. won: what the place of the drawing wins. remarks: on
    what it was planned with."""

    size_mm: tuple[float, float] = (0.0, 0.0)
    scale: float = 1.0
    warnings: list[str] = field(default_factory=list)
    where: str = ""
    hints: tuple[str, ...] = ()
    pens: tuple[str, ...] = ()
    won: str = ""
    remarks: tuple[str, ...] = ()

    def lines(self) -> list[str]:
        """A few lines to read."""
        shares = ", ".join(
            f"{name} {clock(seconds)} ({100 * share:.0f} %)" for name, seconds, share in self.phases.shares()
        )
        return [
            self.amount(),
            f"{self.size_mm[0]:.1f} x {self.size_mm[1]:.1f} mm on paper, {self.scale:.3g} times its size on the page",
            f"takes {clock(self.duration_s)} ({shares}); {self.mean_speed()}",
            f"{counted(self.n_samples, 'sample')} at {self.rate_hz:g} Hz",
            *([f"pens: {', '.join(self.pens)}"] if self.pens else []),
            *filter(None, [self.won, self.where]),
            *self.remarks,
            *(f"hint: {hint}" for hint in self.hints[:1]),
        ]
