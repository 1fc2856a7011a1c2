"""What lies on the paper under an arm of ideal servos, by the pulses on the controller's pins."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from hardware.calibration import pulse_calibration
from hardware.drawn import drawn_lines
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from tests.hardware.emulator.emulator import Emulator, Pulses

_STEP_S = 0.002
_LOOSE_S = 0.05
"""A servo that gets no pulse for so long has let go."""


def ink(emulator: Emulator, arm: Arm) -> list[FloatArray]:
    """Lines (n, 2) in arm millimetres in the order that they were drawn. Servos follow the curve through their pulses;
    while any is loose there is none."""
    calibration = pulse_calibration(arm)
    channels = [emulator.pulses(channel) for channel in calibration.addresses]
    times_s = np.arange(max(one.starts_s[0] for one in channels), min(one.starts_s[-1] for one in channels), _STEP_S)
    held = np.logical_and.reduce([_is_held(one, times_s) for one in channels])
    pulses_us = np.column_stack([CubicSpline(one.starts_s, one.widths_us)(times_s) for one in channels])
    joints = calibration.to_joints(pulses_us)
    pieces = np.split(np.arange(len(times_s)), np.flatnonzero(held[1:] != held[:-1]) + 1)
    return [line for piece in pieces if held[piece[0]] for line in drawn_lines(arm, joints[piece])]


def _is_held(one: Pulses, times_s: FloatArray) -> FloatArray:
    before = np.searchsorted(one.starts_s, times_s, side="right") - 1
    held: FloatArray = np.diff(one.starts_s)[np.clip(before, 0, len(one.starts_s) - 2)] < _LOOSE_S
    return held
