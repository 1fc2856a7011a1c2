"""A small arm with a revolute, a prismatic and a coupled joint, and a trajectory for it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from planner.arms.arm import Arm, Coupling, Joint, JointKind, Pen, PenHold, Workspace
from planner.trajectory import TRAVELLING, Trajectory


def _joint(name: str, kind: JointKind, low: float, high: float) -> Joint:
    """Limits in file units; velocity, acceleration and jerk 10, 100 and 1000 times the higher."""
    unit = math.radians(1) if kind is JointKind.REVOLUTE else 1.0
    return Joint(
        name,
        kind,
        0.0,
        0.0,
        50.0,
        0.0,
        low * unit,
        high * unit,
        10 * high * unit,
        100 * high * unit,
        1000 * high * unit,
    )


@pytest.fixture(scope="session")
def arm() -> Arm:
    joints = (
        _joint("q1", JointKind.REVOLUTE, -90, 80),
        _joint("d2", JointKind.PRISMATIC, -5, 30),
        _joint("q3", JointKind.REVOLUTE, -100, 100),
    )
    return Arm(
        "three",
        "made for tests",
        joints,
        (Coupling(2, 0.0, ((0, -1.0),)),),
        Pen(PenHold.COUPLING, (0.0, 0.0, -1.0), 5.0, 1.0),
        Workspace(0.0, 1.0),
    )


@pytest.fixture(scope="session")
def make_trajectory(arm: Arm) -> Callable[..., Trajectory]:
    def make(n_samples: int = 301, swing: float = 1.0, drawing: str = "flower.svg") -> Trajectory:
        """Joints swing from rest to rest, by 30 degrees and 10 mm times `swing`; the pen draws stroke 0 in
        the second quarter, taps as stroke 1 for one sample at three fifths, and draws stroke 2 in the last quarter."""
        s = np.linspace(0, 1, n_samples)
        wave = np.sin(np.pi * s) ** 4 * swing
        stroke = np.full(n_samples, TRAVELLING)
        stroke[n_samples // 4 : n_samples // 2] = 0
        stroke[3 * n_samples // 5] = 1
        stroke[3 * n_samples // 4 : -2] = 2
        return Trajectory(
            "three",
            drawing,
            "path",
            100.0,
            arm.column_names,
            np.column_stack((30 * wave, 10 * wave, -30 * wave)),
            stroke >= 0,
            stroke,
            (0.0, -1.0, -1.0, 0.0, 120.0, 40.0),
        )

    return make
