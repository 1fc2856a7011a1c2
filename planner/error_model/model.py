"""What an arm is believed to do with what its servos are told."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.error_model.chain import Geometry, TipChange, tips
from planner.error_model.curve import Curve
from planner.error_model.slack import Course


@dataclass(frozen=True, eq=False, slots=True)
class ErrorModel:
    """curves: one a joint. slack: (n_joints,) half of what a set point may move before the joint does, rad or mm."""

    curves: tuple[Curve, ...]
    slack: FloatArray
    geometry: Geometry


@dataclass(frozen=True, eq=False, slots=True)
class Standing:
    """Joints at rest at some moments: positions (m, n_joints), what their servos were told when it moved them last
    (m, n_joints), and on which side of that they stand, -1, 0 or 1 (m, n_joints)."""

    positions: FloatArray
    told: FloatArray
    side: FloatArray


@dataclass(frozen=True, eq=False, slots=True)
class Told:
    """A record of what servos were told, cut down to what matters at some moments.

    courses: one a joint. values: one a joint, (n_turns,) us or counts.
    """

    courses: tuple[Course, ...]
    values: tuple[FloatArray, ...]

    @staticmethod
    def of(told: FloatArray, rows: IntArray) -> Told:
        """told: (n, n_joints); rows: (m,) set points that are asked about."""
        courses = tuple(Course.of(column, rows) for column in told.T)
        return Told(courses, tuple(column[course.turns] for column, course in zip(told.T, courses, strict=True)))


def standing(model: ErrorModel, told: Told) -> Standing:
    """Where the joints stand at the moments of `told`, everything at rest."""
    columns = []
    for curve, slack, course, values in zip(model.curves, model.slack.tolist(), told.courses, told.values, strict=True):
        position, mover, side = course.standing(curve.position(values), slack)
        columns.append((position, values[mover], side))
    positions, movers, sides = (np.column_stack(column) for column in zip(*columns, strict=True))
    return Standing(positions, movers, sides)


def tips_at(model: ErrorModel, told: Told) -> tuple[TipChange, Standing]:
    """The tips on the paper at the moments of `told`."""
    stands = standing(model, told)
    return tips(model.geometry, stands.positions), stands
