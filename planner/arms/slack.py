"""How far joints may be from where their servos are told to bring them, and how much later they are there."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm, Joint
from planner.arrays import FloatArray

FRAME_S = 0.02
"""A hobby servo looks for a new pulse so often."""


def half_slack(arm: Arm) -> FloatArray:
    """(n_joints,) rad or mm: half of play and dead band together, which act as one; 0 where nothing is known."""
    return np.array([_of(joint) for joint in arm.joints])


def delays_s(arm: Arm) -> FloatArray:
    """(n_joints,) how long a joint runs after what its servo is told: its lag, and for pulses half the time between
    two looks."""
    return np.array(
        [
            joint.servo.lag_s + FRAME_S / 2 if joint.servo else joint.bus.lag_s if joint.bus else 0.0
            for joint in arm.joints
        ]
    )


def leads_s(arm: Arm, period_s: float) -> FloatArray:
    """(n_joints,) how long before its time a joint is to be told where to be, by set points `period_s` apart: what a
    hobby servo sees when it looks was told half a period ago on average."""
    looks = np.array([joint.servo is not None for joint in arm.joints])
    leads: FloatArray = delays_s(arm) + looks * period_s / 2
    return leads


def _of(joint: Joint) -> float:
    if joint.servo is not None:
        servo = joint.servo
        (low, first_us), (high, last_us) = servo.curve[0], servo.curve[-1]
        return servo.backlash / 2 + servo.dead_band_us * abs((high - low) / (last_us - first_us))
    if joint.bus is not None:
        return joint.bus.backlash / 2 + joint.bus.dead_band_counts / abs(joint.bus.counts_per_unit)
    return 0.0
