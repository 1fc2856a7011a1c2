"""How far the tip of a pen is moved by what a controller cannot tell apart."""

from __future__ import annotations

from itertools import product

import numpy as np

from hardware.compensation.servo_values import pulse_calibration
from hardware.motion.tip import link_nodes_mm
from planner.arms.arm import Arm
from planner.arrays import FloatArray


def rounding_mm(arm: Arm, positions: FloatArray, step_us: float) -> float:
    """On the paper, at the most, in any of `positions` (n, n_joints): each pulse is off by half a step, all of them to
    the side that is worst."""
    calibration = pulse_calibration(arm)
    pulses_us, tip_mm = calibration.to_servos(positions), link_nodes_mm(arm, positions)[:, -1, :2]
    moved_mm = [
        link_nodes_mm(arm, calibration.to_joints(pulses_us + step_us / 2 * np.array(sides)))[:, -1, :2] - tip_mm
        for sides in product((-1.0, 1.0), repeat=arm.n_joints)
    ]
    return float(np.linalg.norm(moved_mm, axis=-1).max())
