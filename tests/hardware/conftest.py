from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from hardware.motion.slow_transfer import slow_transfer
from hardware.motion.stopping import lift
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.trajectory import TRAVELLING, Trajectory

ArcMaker = Callable[..., Trajectory]


@pytest.fixture(scope="session")
def arm() -> Arm:
    return load_arm("drawing_arm")


@pytest.fixture(scope="session")
def arc() -> ArcMaker:
    """One stroke along an arc of radius 100 mm: q1 turns, the rest of the arm holds the pen on the paper."""

    def make(duration_s: float = 0.6, rate_hz: float = 100.0) -> Trajectory:
        n = round(duration_s * rate_hz) + 1
        u = np.linspace(0, 1, n)
        q1_deg = -40 + 80 * (10 * u**3 - 15 * u**4 + 6 * u**5)
        positions: FloatArray = np.column_stack((q1_deg, *np.tile([[60.0], [-60.0], [-60.0], [-30.0]], n)))
        return Trajectory(
            arm="drawing_arm",
            drawing="arc.svg",
            method="path",
            rate_hz=rate_hz,
            columns=("q1_deg", "q2_deg", "q3_deg", "q4_deg", "q5_deg"),
            positions=positions,
            pen=np.ones(n, dtype=bool),
            stroke=np.zeros(n, dtype=np.int64),
            svg_to_arm_mm=(1, 0, 0, 1, 0, 0),
        )

    return make


@pytest.fixture(scope="session")
def sketch(arm: Arm, arc: ArcMaker) -> Trajectory:
    """Three arcs of radius 100 mm, one after the other and back, with travel moves between; the pen is up at both
    ends."""
    rate_hz = 100.0
    there = arm.from_file_units(arc().positions)
    parts, strokes = [], []
    for stroke, path in enumerate((there, there[::-1], there)):
        up = np.concatenate((path[-1:], lift(arm, path[-1], rate_hz)))
        down = np.concatenate((path[:1], lift(arm, path[0], rate_hz)))[::-1]
        before = parts[-1][-1] if parts else down[0]
        for part, label in (
            (slow_transfer(arm, before, down[0], rate_hz), TRAVELLING),
            (down[:-1] if not parts else down[1:-1], TRAVELLING),
            (path, stroke),
            (up[1:], TRAVELLING),
        ):
            parts.append(part)
            strokes += [label] * len(part)
    labels = np.array(strokes)
    return Trajectory(
        arm="drawing_arm",
        drawing="arcs.svg",
        method="path",
        rate_hz=rate_hz,
        columns=arm.column_names,
        positions=arm.to_file_units(np.concatenate(parts)),
        pen=labels >= 0,
        stroke=labels,
        svg_to_arm_mm=(1, 0, 0, 1, 0, 0),
    )
