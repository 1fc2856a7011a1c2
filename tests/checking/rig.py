"""Arms and motions that are simple enough to be known exactly, for trying the check on."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import pi

import numpy as np

from planner.arms.arm import Arm, Coupling, Joint, JointKind, Pen, PenHold, Workspace
from planner.arrays import FloatArray
from planner.drawing.drawing import Drawing, Outline
from planner.trajectory import TRAVELLING, Trajectory

RATE_HZ = 100.0
LIFT_MM = 5.0
AFFINE = (0.0, -0.5, -0.5, 0.0, 100.0, 50.0)
"""x = 100 - v / 2, y = 50 - u / 2."""


def joint(
    name: str,
    kind: JointKind = JointKind.REVOLUTE,
    theta: float = 0.0,
    d: float = 0.0,
    a: float = 0.0,
    alpha: float = 0.0,
    low: float = -200.0,
    high: float = 200.0,
) -> Joint:
    return Joint(name, kind, theta, d, a, alpha, low, high, 150.0, 3000.0, 60000.0)


def arm_of(
    *joints: Joint,
    couplings: tuple[Coupling, ...] = (),
    hold: PenHold = PenHold.CONSTRUCTION,
    tool_axis: tuple[float, float, float] = (1.0, 0.0, 0.0),
) -> Arm:
    return Arm("rig", "made for tests", joints, couplings, Pen(hold, tool_axis, LIFT_MM, 1.0), Workspace(0.0, 10.0))


def gantry() -> Arm:
    """Three sliding joints: height of the carriage (20 mm above the nib), -y and x."""
    slide = JointKind.PRISMATIC
    return arm_of(
        joint("h", slide, alpha=pi / 2),
        joint("v", slide, theta=pi / 2, alpha=pi / 2),
        joint("u", slide, a=-20.0),
        hold=PenHold.TOOL_AXIS,
        tool_axis=(-1.0, 0.0, 0.0),
    )


def with_limit(arm: Arm, name: str, **limits: float) -> Arm:
    return replace(arm, joints=tuple(replace(one, **limits) if one.name == name else one for one in arm.joints))


class Hand:
    """Moves a tip in straight lines from rest to rest, on a septic in time, and records what the pen does."""

    def __init__(self, x: float, y: float, z: float = LIFT_MM) -> None:
        self.tips = [np.array([[x, y, z]])]
        self.pens, self.strokes = [np.zeros(1, dtype=bool)], [np.full(1, TRAVELLING)]

    def move(self, x: float, y: float, z: float, stroke: int = TRAVELLING) -> Hand:
        begin, end = self.tips[-1][-1], np.array([x, y, z])
        distance = float(np.linalg.norm(end - begin))
        n = int(np.ceil(max(distance / 40, (distance / 250) ** 0.5, (distance / 800) ** (1 / 3), 0.05) * RATE_HZ))
        t = np.arange(1, n + 1)[:, np.newaxis] / n
        self.tips.append(begin + (end - begin) * t**4 * (35 - 84 * t + 70 * t**2 - 20 * t**3))
        self.pens.append(np.full(n, stroke >= 0))
        self.strokes.append(np.full(n, stroke))
        return self

    def draw(self, line: Sequence[tuple[float, float]], stroke: int) -> Hand:
        """Travel to the line, draw it, lift."""
        self.move(*line[0], LIFT_MM).move(*line[0], 0.0)
        self.pens[-1][-1], self.strokes[-1][-1] = True, stroke
        for x, y in line[1:]:
            self.move(x, y, 0.0, stroke)
        return self.move(*line[-1], LIFT_MM)

    def tip_mm(self) -> FloatArray:
        return np.concatenate(self.tips)

    def trajectory(self) -> Trajectory:
        """For the gantry."""
        x, y, z = self.tip_mm().T
        return Trajectory(
            "rig",
            "rig.svg",
            "hand",
            RATE_HZ,
            gantry().column_names,
            np.column_stack((z + 20, -y, x)),
            np.concatenate(self.pens),
            np.concatenate(self.strokes),
            AFFINE,
        )


CORNERED = ((60.0, 10.0), (80.0, 10.0), (80.0, -10.0))
SHORT = ((70.0, -20.0), (90.0, -25.0))
DOT = ((100.0, 0.0),)


def hand() -> Hand:
    return Hand(60, 0).draw(CORNERED, 0).draw(SHORT, 1).draw(DOT, 2)


def drawing_of(*lines: Sequence[tuple[float, float]]) -> Drawing:
    """The drawing whose outlines AFFINE puts on the given lines of arm coordinates."""
    outlines = []
    for line in lines:
        x, y = np.array(line).T
        user = np.column_stack(((50 - y) * 2, (100 - x) * 2))
        begins, ends = (user[:-1], user[1:]) if len(user) > 1 else (user, user)
        share = np.linspace(0, 1, 4)[:, np.newaxis]
        outlines.append(Outline(begins[:, np.newaxis] + share * (ends - begins)[:, np.newaxis]))
    return Drawing("rig.svg", tuple(outlines), np.array([[0.5, 0, 0], [0, 0.5, 0]]), (100.0, 100.0))
