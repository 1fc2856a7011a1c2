"""Motions that tests play, and what the pins have to show of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hardware.clock import Clock
from hardware.codecs import native
from hardware.drivers.native.driver import NativeDriver
from hardware.drivers.native.session import Transport
from planner.arrays import FloatArray
from tests.hardware.emulator.emulator import Emulator, LockStep

JOINTS = 5
PERIOD_S = 0.01
RANGE_US = (700.0, 2300.0)


def pulses_us(positions: FloatArray) -> FloatArray:
    return 1500.0 + 10.0 * positions


def _positions(pulses_us: FloatArray) -> FloatArray:
    return (pulses_us - 1500.0) / 10.0


def _slow_way(held: FloatArray, pose: FloatArray, rate_hz: float) -> FloatArray:
    return held + np.linspace(0.0, 1.0, round(2.0 * rate_hz))[1:, None] * (pose - held)


def driver_on(line: Transport, clock: Clock) -> NativeDriver:
    ranges_us = np.tile(RANGE_US, (JOINTS, 1))
    return NativeDriver(lambda: line, pulses_us, _positions, _slow_way, range(JOINTS), ranges_us, clock)


def waves(duration_s: float) -> FloatArray:
    """(n, JOINTS) positions PERIOD_S apart: every joint at a frequency of its own, from rest."""
    times_s = np.arange(round(duration_s / PERIOD_S) + 1) * PERIOD_S
    return np.array(
        [45.0 * np.minimum(times_s, 1.0) ** 2 * np.sin((2.0 + 0.7 * joint) * times_s) for joint in range(JOINTS)]
    ).T


def line_of(duration_s: float) -> FloatArray:
    """(n, JOINTS) positions along a straight line, so that every pulse tells how far along it the arm is."""
    along = np.linspace(0.0, 1.0, round(duration_s / PERIOD_S) + 1)
    return along[:, None] * np.linspace(40.0, 70.0, JOINTS)


@dataclass(frozen=True)
class OnPins:
    """Errors of all pulses of a run against the plan. began_s: the start of the plan that fits them best."""

    rms_us: float
    worst_us: float
    began_s: float
    pulses: int


def against_plan(emulator: Emulator, plan: FloatArray, since_s: float) -> OnPins:
    """Compare every pulse since `since_s` with the planned angle at the moment that it began."""
    channels = [emulator.pulses(channel) for channel in range(JOINTS)]
    grid_s = np.arange(len(plan)) * PERIOD_S
    targets_us = pulses_us(plan)
    best = OnPins(np.inf, np.inf, 0.0, 0)
    starts_s = np.unique(np.concatenate([one.starts_s for one in channels]))
    # The plan begins at the slot of some channel: all that there are before the first pulse that moves are tried.
    moving_s = min(
        one.starts_s[(one.starts_s > since_s) & (abs(one.widths_us - one.widths_us[0]) > 1.0)][0] for one in channels
    )
    for began_s in starts_s[(starts_s > moving_s - 0.3) & (starts_s <= moving_s)]:
        errors = np.concatenate(
            [
                (one.widths_us - np.interp(one.starts_s - began_s, grid_s, targets_us[:, channel]))[
                    one.starts_s > since_s
                ]
                for channel, one in enumerate(channels)
            ]
        )
        rms = float(np.sqrt(np.mean(errors**2)))
        if rms < best.rms_us:
            best = OnPins(rms, float(np.abs(errors).max()), float(began_s), len(errors))
    return best


def progress(emulator: Emulator, plan: FloatArray, since_s: float) -> tuple[FloatArray, FloatArray]:
    """Times of all pulses since `since_s` in order, and how far along the straight line `plan` each one is (0 to 1)."""
    first, last = pulses_us(plan[0]), pulses_us(plan[-1])
    times, along = [], []
    for channel in range(JOINTS):
        one = emulator.pulses(channel)
        times.append(one.starts_s)
        along.append((one.widths_us - first[channel]) / (last[channel] - first[channel]))
    times_s, along_line = np.concatenate(times), np.concatenate(along)
    order = np.argsort(times_s)
    keep = times_s[order] > since_s
    return times_s[order][keep], along_line[order][keep]


class Console:
    """Frames by hand, for what no driver would send."""

    sequence = 0
    """Counted over all consoles: a status tells the last order's, which may have been another console's."""

    def __init__(self, line: LockStep) -> None:
        self.line, self.reader = line, native.Reader()

    def give(self, kind: native.Order, message: bytes | None = None) -> native.Status:
        """An order, and the status that answers it."""
        Console.sequence = self.next()
        self.line.write(native.order(kind, self.sequence) if message is None else message)
        for _ in range(100):
            for one in self.reader.feed(self.line.read(4096, 0.002)):
                if isinstance(one, native.Status) and one.order == self.sequence:
                    return one
        raise AssertionError(f"no answer to {kind.name}")

    def next(self) -> int:
        return (self.sequence + 1) % 256

    def arm(self, pulse: int = 1500 * 16) -> native.Status:
        """Everything up to READY, at `pulse`."""
        self.line.sleep_until(self.line.now_s() + 0.01)  # it has to start first
        self.give(native.Order.HELLO, native.hello(self.next(), 77))
        shortest, longest = (round(16 * bound) for bound in RANGE_US)
        self.give(native.Order.CONFIG, native.config(self.next(), [native.Channel(shortest, longest, pulse)] * JOINTS))
        self.give(native.Order.ARM, native.arm(self.next(), []))
        self.line.sleep_until(self.line.now_s() + 1.0)
        return self.give(native.Order.PING)
