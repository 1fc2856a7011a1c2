"""Where a local solver may begin: the configuration before turned towards the target, and others that are near it
anyway.

A solver that follows derivatives ends in the nearest place where they vanish, and that need not be a solution. Most of
the way to a far target is a turn about the base, which is known beforehand; where the rest still leads
into a corner of the joint limits, beginning elsewhere is all that helps.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from planner.arms.arm import PenHold
from planner.arrays import FloatArray
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import within_limits

_DRAWN = 20_000
_GUESSES = 20
_SPREAD = 0.15
"""Guesses are further apart than this in one joint at least, as a share of its range: those beside each other lead to
the same end."""


class Guesses:
    """Guesses for one arm. The same ones always, for the same results."""

    def __init__(self, kinematics: Kinematics) -> None:
        self._kinematics = kinematics
        arm = kinematics.arm
        self._turns = kinematics.turns_over_paper
        self._low, self._high = kinematics.independent_of(arm.minimum), kinematics.independent_of(arm.maximum)

    def turned(self, target_mm: FloatArray, configuration: FloatArray) -> FloatArray:
        """(n_independent,) the configuration with the first joint turned, within its limits, so that the pen is on the
        side of the target (3,); as it is where the first joint does not turn."""
        turned: FloatArray = self._turned(target_mm, configuration[None], self._kinematics.tip_mm(configuration[None]))[
            0
        ]
        return turned

    def near(self, target_mm: FloatArray) -> list[FloatArray]:
        """Configurations (n_independent,) within the limits that come near the target (3,) with the pen held as the arm
        holds it, those that come nearest first, and all unlike each other."""
        configurations, tips, tilts = self._pool
        turned = self._turned(target_mm, configurations, tips)
        if self._turns:  # what the turn leaves to do, wherever limits let the first joint come to
            turn = turned[:, 0] - configurations[:, 0]
            x, y = tips[:, 0], tips[:, 1]
            tips = np.column_stack(
                (np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y, tips[:, 2])
            )
        longest = float(np.linalg.norm(tips, axis=1).max(initial=1.0))
        order = np.argsort(np.linalg.norm(tips - target_mm, axis=1) / longest + tilts, kind="stable")
        chosen: list[FloatArray] = []
        for guess in turned[order]:
            if all((np.abs(guess - other) > _SPREAD * (self._high - self._low)).any() for other in chosen):
                chosen.append(guess)
                if len(chosen) == _GUESSES:
                    break
        return chosen

    @cached_property
    def _pool(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Random configurations (n, n_independent) within all limits, their tips (n, 3) and how far off the pen is,
        (n,)."""
        kinematics, arm = self._kinematics, self._kinematics.arm
        configurations = np.random.default_rng(20221101).uniform(
            self._low, self._high, (_DRAWN, kinematics.n_independent)
        )
        kept = within_limits(arm, arm.complete(configurations), slack=0.0)
        if arm.pen.hold is PenHold.TOOL_AXIS:
            kept &= kinematics.tool_axis(configurations)[:, 2] < 0
        configurations = configurations[kept]
        task, _ = kinematics.task_and_jacobian(configurations)
        return configurations, task[:, :3], np.abs(task[:, 3:]).sum(axis=1)

    def _turned(self, target_mm: FloatArray, configurations: FloatArray, tips_mm: FloatArray) -> FloatArray:
        turned = configurations.copy()
        if self._turns:
            away = np.arctan2(target_mm[1], target_mm[0]) - np.arctan2(tips_mm[:, 1], tips_mm[:, 0])
            low, high = float(self._low[0]), float(self._high[0])
            angle = configurations[:, 0] + _wrapped(away)
            other = (low + high) / 2 + _wrapped(angle - (low + high) / 2)  # the turn that fits, if any does
            turned[:, 0] = np.clip(np.where((angle < low) | (angle > high), other, angle), low, high)
        return turned


def _wrapped(angles_rad: FloatArray) -> FloatArray:
    """Angles from -pi to pi."""
    wrapped: FloatArray = angles_rad - 2 * np.pi * np.round(angles_rad / (2 * np.pi))
    return wrapped
