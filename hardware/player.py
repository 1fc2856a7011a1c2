"""Streaming a trajectory: every set point at its own time, counted from the start so that nothing adds up."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hardware.clock import Clock
from hardware.driver import Driver
from hardware.stopping import brake, lift
from hardware.tip import tip_at
from planner.arms.arm import Arm
from planner.arrays import FloatArray

_STOPPING_RATE_HZ = 50.0
"""A stop is played at no fewer set points a second than this, however coarse the trajectory."""
_STALL_S = 0.1
"""After a stall longer than this the rest is played that much later: catching up would be a leap."""


@dataclass(frozen=True, slots=True)
class Played:
    """What became of a trajectory.

    sent: samples sent, of `total`. duration_s: from the first set point to the last, a stop included.
    worst_late_s, mean_late_s: how long after its time a sample was sent; late: samples later than a period;
    stalls: times that playing stood still for so long that everything after was put off.
    stopped: asked to stop before the end; pen_height_mm: where that left the tip above the paper.
    """

    sent: int
    total: int
    duration_s: float
    worst_late_s: float
    mean_late_s: float
    late: int
    stalls: int
    stopped: bool
    pen_height_mm: float

    def lines(self) -> list[str]:
        """The same in words."""
        end = "stopped" if self.stopped else "played"
        rests = f"the pen rests {round(self.pen_height_mm, 2) + 0.0:.2f} mm above the paper"
        worst = f"{self.worst_late_s * 1e3:.2f} ms at worst; {self.late} by more than a period"
        words = [f"{end} after {self.sent} of {self.total} samples and {self.duration_s:.2f} s; {rests}",
                 f"samples were late by {self.mean_late_s * 1e3:.2f} ms on average and {worst}"]
        if self.stalls:
            words.append(f"playing stalled {self.stalls} time(s) and went on later")
        return words


def play(set_points: FloatArray, rate_hz: float, arm: Arm, driver: Driver, clock: Clock, *,
         stop_requested: Callable[[], bool] = lambda: False,
         report: Callable[[int, int], None] = lambda sent, total: None) -> Played:
    """Send sample k of `set_points` (n, n_joints; rad or mm) at k / rate_hz after the start, later only by stalls.

    When `stop_requested()` turns true the arm brakes along the path, the pen goes straight up, and that is all.
    `report(sent, total)` is called after every sample and has to be quick. The driver is closed in any case.
    Errors: HardwareError.
    """
    total = len(set_points)
    lateness = _Lateness(1.0 / rate_hz)
    sent, stopped = 0, False
    try:
        driver.connect(set_points[0])
        start_s = clock.now_s()
        for sample in set_points:
            due_s = start_s + sent / rate_hz
            clock.sleep_until(due_s)
            stopped = stop_requested()
            if stopped:
                break
            late_s = clock.now_s() - due_s
            driver.send(sample)
            if lateness.add(late_s):
                start_s += late_s
            sent += 1
            report(sent, total)
        resting = set_points[max(sent - 1, 0)]
        if stopped and sent:
            resting = _stop(set_points, sent - 1, rate_hz, arm, driver, clock)
        duration_s = clock.now_s() - start_s
    finally:
        driver.close()
    return Played(sent, total, duration_s, lateness.worst_s, lateness.total_s / max(sent, 1), lateness.late,
                  lateness.stalls, stopped, float(tip_at(arm, resting).position_mm[2]))


def _stop(set_points: FloatArray, sample: int, rate_hz: float, arm: Arm, driver: Driver, clock: Clock) -> FloatArray:
    """Brake from the sample sent last, the next being due now, and lift; the posture that the arm is left in."""
    refine = math.ceil(_STOPPING_RATE_HZ / rate_hz)
    period_s = 1.0 / (rate_hz * refine)
    braking = brake(arm, set_points, sample, rate_hz, refine)
    _send_all(braking, clock.now_s(), period_s, driver, clock)
    # The arm stands still: working out the lift now costs nothing but a moment's rest.
    lifting = lift(arm, braking[-1], rate_hz * refine)
    _send_all(lifting, clock.now_s() + period_s, period_s, driver, clock)
    resting: FloatArray = np.concatenate((braking, lifting))[-1]
    return resting


def _send_all(points: FloatArray, first_s: float, period_s: float, driver: Driver, clock: Clock) -> None:
    for k, point in enumerate(points):
        clock.sleep_until(first_s + k * period_s)
        driver.send(point)


class _Lateness:
    def __init__(self, period_s: float) -> None:
        self._period_s = period_s
        self.worst_s = self.total_s = 0.0
        self.late = self.stalls = 0

    def add(self, late_s: float) -> bool:
        """Note one sample; whether it was a stall."""
        stall = late_s > _STALL_S
        self.worst_s = max(self.worst_s, late_s)
        self.total_s += late_s
        self.late += late_s > self._period_s
        self.stalls += stall
        return stall
