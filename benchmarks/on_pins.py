"""When the pulses on the emulated firmware's pins leave the record of the run that was planned."""

from __future__ import annotations

import time
from collections.abc import Sequence
from pathlib import Path
from threading import Event, Thread

import numpy as np

from planner.arrays import FloatArray
from tests.hardware.emulator.emulator import CYCLES_PER_S, Emulator, Pulses

_LOOK_S, _NEAR_S = 0.002, 0.1
_CHANGE = 16
"""Bytes of a record of the pins."""
_MOVED_US = 1.0
_BEFORE_S, _FINE_S = 0.3, 0.0005
_OFF_US = 1.0
"""A pulse is right to half a step of 0.5 us, and so is the record."""


class PinClock:
    """From the clock of this machine to that of the controller, which is in time with it but where the machine stalls:
    looked at for as long as this is held open."""

    def __init__(self, pins: Path) -> None:
        self._pins, self._over = pins, Event()
        self._seen: list[tuple[float, float]] = []
        self._thread = Thread(target=self._look)

    def __enter__(self) -> PinClock:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._thread.join()

    def at_s(self, wall_s: float) -> float:
        """The latest that the controller may have had at that time."""
        walls, controllers = np.array(self._seen).T
        near = np.abs(walls - wall_s) < _NEAR_S
        return wall_s + float((controllers - walls)[near].max())

    def _look(self) -> None:
        with self._pins.open("rb") as file:
            while not self._over.wait(_LOOK_S):
                end = file.seek(0, 2) // _CHANGE * _CHANGE
                if end:
                    file.seek(end - _CHANGE)
                    cycle = int.from_bytes(file.read(8), "little")
                    self._seen.append((time.time(), cycle / CYCLES_PER_S))


def left_at_s(emulator: Emulator, channels: Sequence[int], record: Path, since_s: float) -> float:
    """When the first pulse after `since_s`, in seconds of the controller, begins that is none of the run's."""
    table = np.genfromtxt(record, delimiter=",", skip_header=1)
    grid_s, rows_us = table[:, 0], table[:, 4:]
    pulses = [emulator.pulses(channel) for channel in channels]
    before = [one.starts_s < since_s for one in pulses]
    moving_s = min(float(one.starts_s[np.abs(one.widths_us - one.widths_us[0]) > _MOVED_US][0]) for one in pulses)

    def errors(joint: int, one: Pulses, began_s: float) -> FloatArray:
        wanted: FloatArray = np.interp(one.starts_s - began_s, grid_s, rows_us[:, joint])
        return np.abs(one.widths_us - wanted)

    def worst(began_s: float) -> float:
        return max(
            float(errors(joint, one, began_s)[early].max())
            for joint, (one, early) in enumerate(zip(pulses, before, strict=True))
        )

    began_s = min(np.arange(moving_s - _BEFORE_S, moving_s, _FINE_S).tolist(), key=worst)
    assert worst(began_s) < _OFF_US, "the run does not follow its record"
    off = [
        one.starts_s[~early & (errors(joint, one, began_s) > _OFF_US)]
        for joint, (one, early) in enumerate(zip(pulses, before, strict=True))
    ]
    return float(min(one[0] for one in off if len(one)))
