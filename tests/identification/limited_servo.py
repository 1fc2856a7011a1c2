"""Servos on a bus that hide their limits, and report where they are: an account of their own, with nothing of the
planner's in it.

A servo goes through the set points smoothly, some time after they were sent. Its motor goes after them with a speed, an
acceleration, and a change of acceleration, that saturate at their limits, the first two at less against gravity than
with it; it catches up as one does who knows how soon it can brake. A loop of second order, its lag, stands behind
the motor, as where firmware makes a profile and a loop follows that, or before it, as where the limits are those of the
torque. It leaves a small change alone. Reports are counts, late by some milliseconds, and their times are off by more.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

_STEP_S = 0.001
COUNT_DEG = 360 / 4096

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class LimitedServo:
    """velocity, acceleration, jerk: its limits in deg and s, against gravity. gravity: how much more it has with it, as
    a share. lag_s: of its loop;
    lags_before: whether that stands before the motor. latency_s: of what it is told. dead_band: change in deg that it
    leaves alone. report_hz, report_s, jitter_s: how often it reports, how late, and how much times are off."""

    velocity: float
    acceleration: float
    jerk: float
    gravity: float = 0.15
    lag_s: float = 0.025
    lags_before: bool = False
    latency_s: float = 0.004
    dead_band: float = COUNT_DEG
    report_hz: float = 100.0
    report_s: float = 0.005
    jitter_s: float = 0.001


def moved(servos: list[LimitedServo], told: Floats, rate_hz: float) -> Floats:
    """(k, n) where each of n servos is, in deg, each ms, which is told (m, n) from rest on."""
    each_s = 1 / rate_hz
    n_steps = round((len(told) - 1) * each_s / _STEP_S) + 1
    velocity, acceleration, jerk, gravity, lag_s, latency_s, dead_band = (
        np.array([getattr(servo, key) for servo in servos])
        for key in ("velocity", "acceleration", "jerk", "gravity", "lag_s", "latency_s", "dead_band")
    )
    pole, before = 2 / lag_s, np.array([servo.lags_before for servo in servos])
    late_s = np.clip(np.arange(n_steps)[:, None] * _STEP_S - latency_s, 0.0, None)
    ways, which = np.unique(told.T, axis=0, return_inverse=True)  # many servos may be told the same
    splines = [CubicSpline(np.arange(len(told)) * each_s, way) for way in ways]
    goals, goal_speeds, goal_changes = (
        np.stack([splines[way](late, order) for way, late in zip(which.tolist(), late_s.T, strict=True)], axis=1)
        for order in range(3)
    )
    at, held, seen, lagging = (told[0].copy() for _ in range(4))
    speed, change, seen_speed, lagging_speed = np.zeros((4, len(servos)))
    positions = np.empty((n_steps, len(servos)))
    for k in range(n_steps):
        positions[k] = np.where(before, held, seen)
        lagging_change = pole**2 * (goals[k] - lagging) - 2 * pole * lagging_speed
        meant, meant_speed, meant_change = (
            np.where(before, one, other)
            for one, other in (
                (lagging, goals[k]),
                (lagging_speed, goal_speeds[k]),
                (lagging_change, goal_changes[k]),
            )
        )
        lagging_speed = lagging_speed + lagging_change * _STEP_S
        lagging = lagging + lagging_speed * _STEP_S
        behind = meant - at
        catching_up = np.sign(behind) * np.minimum(12 * np.abs(behind), np.sqrt(0.5 * acceleration * np.abs(behind)))
        wanted_speed = np.clip(meant_speed + catching_up, -velocity * (1 + gravity / 2), velocity)
        slow = wanted_speed - speed
        pull = np.sign(slow) * np.minimum(40 * np.abs(slow), np.sqrt(0.5 * jerk * np.abs(slow)))
        is_slower = wanted_speed != meant_speed + catching_up
        wanted = np.clip(np.where(is_slower, 0.0, meant_change) + pull, -acceleration * (1 + gravity), acceleration)
        change = change + np.clip(wanted - change, -jerk * _STEP_S, jerk * _STEP_S)
        speed = speed + change * _STEP_S
        at = at + speed * _STEP_S
        held = np.clip(held, at - dead_band, at + dead_band)
        seen_speed = seen_speed + (pole**2 * (held - seen) - 2 * pole * seen_speed) * _STEP_S
        seen = seen + seen_speed * _STEP_S
    return positions


def reports(servo: LimitedServo, positions: Floats, random: np.random.Generator) -> tuple[Floats, Floats]:
    """Times and positions (k,) that a servo reports, of where it was each ms (n,)."""
    length_s = (len(positions) - 1) * _STEP_S
    true_s = np.arange(random.uniform(0, 1 / servo.report_hz), length_s, 1 / servo.report_hz)
    at = np.interp(true_s, np.arange(len(positions)) * _STEP_S, positions)
    times_s = true_s + servo.report_s + servo.jitter_s * random.uniform(-1, 1, len(true_s))
    return times_s, np.round(at / COUNT_DEG) * COUNT_DEG


def any_servo(
    random: np.random.Generator, velocity: float, acceleration: float, jerk: float, lags_before: bool = False
) -> LimitedServo:
    """One with these limits, and the rest as it comes."""
    return LimitedServo(
        velocity,
        acceleration,
        jerk,
        gravity=random.uniform(0.0, 0.3),
        lag_s=random.uniform(0.015, 0.04),
        lags_before=lags_before,
        latency_s=random.uniform(0.002, 0.01),
        dead_band=random.uniform(0.5, 1.5) * COUNT_DEG,
        report_hz=float(random.choice([50.0, 100.0, 200.0])),
        report_s=random.uniform(0.002, 0.012),
        jitter_s=random.uniform(0.0, 0.002),
    )
