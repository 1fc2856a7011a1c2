"""What makes an arm draw worse than it could, and what a person can do about it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Cause:
    """mm: what the error would be less by, in quadrature, without it. cure: in the imperative."""

    name: str
    mm: float
    cure: str

    def text(self) -> str:
        return f"{self.name} costs {self.mm:.2f} mm: {self.cure}"


def unmeasured(mm: float) -> Cause:
    """Of an arm that was never calibrated: curves of servos, lengths, the paper's place."""
    cure = "calibrate it (plan pattern, plan measure, plan calibrate)"
    return Cause("what nobody has measured of this arm", mm, cure)


def left_open(mm: float, marks: int) -> Cause:
    """Of a calibrated arm: what `marks` marks could not tell."""
    cure = "draw a second sheet with this arm (plan pattern --seed 1), and calibrate from both"
    return Cause(f"what {marks} marks left open", mm, cure)


def differing_lags(mm: float) -> Cause:
    return Cause("that servos lag by different times", mm, "draw more slowly (--speed)")


def slack_of(joint: str, mm: float) -> Cause:
    return Cause(f"slack of {joint}", mm, "preload it with a rubber band")
