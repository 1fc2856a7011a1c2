"""What lies on the paper under an arm of ideal servos, by the pulses on the controller's pins."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from hardware.compensation.servo_values import pulse_calibration
from hardware.simulation.ink import drawn_lines
from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from tests.hardware.emulator.emulator import Emulator, Pulses

_STEP_S = 0.002
_LOOSE_S = 0.05
"""A servo that gets no pulse for so long has let go."""


def ink(emulator: Emulator, arm: Arm) -> list[FloatArray]:
    """Lines (n, 2) in arm millimetres in the order that they were drawn. Servos follow the curve through their pulses;
    while any is loose there is none."""
    calibration = pulse_calibration(arm)
    channels = [emulator.pulses(channel) for channel in calibration.addresses]
    if not all(len(one.starts_s) for one in channels):
        return []
    times_s = np.arange(max(one.starts_s[0] for one in channels), min(one.starts_s[-1] for one in channels), _STEP_S)
    if not len(times_s):
        return []
    held = np.logical_and.reduce([_is_held(one, times_s) for one in channels])
    pieces = np.split(np.arange(len(times_s)), np.flatnonzero(held[1:] != held[:-1]) + 1)
    lines: list[FloatArray] = []
    for piece in (times_s[piece] for piece in pieces if held[piece[0]]):
        piece = np.append(piece, min(_next(one, piece[-1]) for one in channels))  # fast ink is cut off between steps
        pulses_us = np.column_stack([_between(one, piece) for one in channels])
        lines += drawn_lines(arm, calibration.to_joints(pulses_us))
    return lines


def _next(one: Pulses, time_s: float) -> float:
    """When the pulse after `time_s` begins; the last one, if there is none."""
    return float(one.starts_s[min(int(np.searchsorted(one.starts_s, time_s, side="right")), len(one.starts_s) - 1)])


def _between(one: Pulses, times_s: FloatArray) -> FloatArray:
    near = (one.starts_s > times_s[0] - _LOOSE_S) & (one.starts_s < times_s[-1] + _LOOSE_S)
    widths_us: FloatArray = CubicSpline(one.starts_s[near], one.widths_us[near])(times_s)
    return widths_us


def _is_held(one: Pulses, times_s: FloatArray) -> BoolArray:
    before = np.searchsorted(one.starts_s, times_s, side="right") - 1
    held: BoolArray = np.diff(one.starts_s)[np.clip(before, 0, len(one.starts_s) - 2)] < _LOOSE_S
    return held
