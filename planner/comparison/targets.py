"""Where the pen is to be put: single targets, targets all over the paper, or targets along the strokes of a drawing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from planner.arms.arm import PenHold
from planner.arrays import FloatArray, IntArray
from planner.errors import PlanError
from planner.inverse_kinematics.references import TARGET_SPACING_MM
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import project
from planner.ragged import starts_of
from planner.redundancy.configuration_tests import usable_configurations

_DRAWN, _MOST_DRAWS = 4096, 100


class TargetKind(StrEnum):
    SINGLE = "single"
    """Each by itself, from the start."""
    RANDOM = "random"
    """All over the paper, each from the start; backwards one after the other."""
    DRAWING = "drawing"
    """Along strokes, each near the one before."""


@dataclass(frozen=True, eq=False, slots=True)
class Targets:
    """Tips (n, 3), arm mm, in sequences that begin at firsts (n_sequences,): a method that goes from configuration to
    configuration begins each sequence from the start. along_mm: (n,) the way along the sequence, zero where there is
    none. strokes: those (n, 2) of a drawing."""

    kind: TargetKind
    tips_mm: FloatArray
    firsts: IntArray
    along_mm: FloatArray
    strokes: Sequence[FloatArray] = ()

    def backwards(self) -> Targets:
        """Everything in the opposite order: the last sequence first, from its end. Random targets become one sequence,
        so that each is met from another configuration than the start."""
        firsts = len(self.tips_mm) - np.append(self.firsts, len(self.tips_mm))[:0:-1]
        if self.kind is TargetKind.RANDOM:
            firsts = firsts[:1]
        return Targets(self.kind, self.tips_mm[::-1], firsts, -self.along_mm[::-1])

    def first(self) -> Targets:
        """The first target alone."""
        return Targets(self.kind, self.tips_mm[:1], self.firsts[:1], self.along_mm[:1])


def single_targets(tips_mm: FloatArray) -> Targets:
    """Tips (n, 3)."""
    return Targets(TargetKind.SINGLE, tips_mm, np.arange(len(tips_mm)), np.zeros(len(tips_mm)))


def random_targets(kinematics: Kinematics, count: int, seed: int) -> Targets:
    """Places of the paper in front of the arm, each reached by a usable configuration that was drawn at random: within
    limits, clear of singularities, links above the paper. Errors: PlanError where hardly any is found."""
    random = np.random.default_rng(seed)
    arm = kinematics.arm
    low, high = kinematics.independent_of(arm.minimum), kinematics.independent_of(arm.maximum)
    found = np.empty((0, 3))
    for _ in range(_MOST_DRAWS):
        configurations = random.uniform(low, high, (_DRAWN, kinematics.n_independent))
        if arm.pen.hold is PenHold.TOOL_AXIS:
            configurations = configurations[kinematics.tool_axis(configurations)[:, 2] < 0]
        tips = kinematics.tip_mm(configurations)
        tips[:, 2] = 0.0
        in_front = (tips[:, 0] >= 0) | (not kinematics.turns_over_paper)
        in_front &= np.hypot(tips[:, 0], tips[:, 1]) >= arm.workspace.inner_radius_mm
        configurations, tips = configurations[in_front], tips[in_front]
        configurations, exact = project(kinematics, configurations, tips)
        found = np.concatenate((found, tips[exact][usable_configurations(kinematics, configurations[exact])]))
        if len(found) >= count:
            return Targets(TargetKind.RANDOM, found[:count], np.arange(count), np.zeros(count))
    raise PlanError(
        f"arm {arm.name}: of {_MOST_DRAWS * _DRAWN} random configurations only {len(found)} put the pen on the"
        " paper within the joint limits"
    )


def targets_along(strokes: Sequence[FloatArray]) -> Targets:
    """Targets about a millimetre apart along strokes (n, 2), both ends included; a tap is one."""
    tips, along = zip(*map(_stations, strokes), strict=True)
    firsts = starts_of(np.array([len(sequence) for sequence in tips]))[:-1]
    joined = np.concatenate(tips)
    return Targets(
        TargetKind.DRAWING, np.column_stack((joined, np.zeros(len(joined)))), firsts, np.concatenate(along), strokes
    )


def _stations(stroke: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(n, 2) evenly spaced points of a polyline, and (n,) the way to each."""
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(stroke, axis=0).T))))
    along = np.linspace(0.0, way[-1], int(np.ceil(way[-1] / TARGET_SPACING_MM)) + 1)
    return np.column_stack([np.interp(along, way, column) for column in stroke.T]), along
