"""The ways to configurations that are compared: each is built once for an arm, and then solves for many targets."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.comparison.targets import TargetKind, Targets
from planner.inverse_kinematics import dls, nlp
from planner.inverse_kinematics.closed_forms import closed_form_of
from planner.inverse_kinematics.result import Solutions
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import project
from planner.redundancy.arm_model import ArmModel
from planner.redundancy.configuration_map import branch_references
from planner.settings import ConfigurationWeights, Method

Solve = Callable[[Targets, FloatArray], Solutions]
"""Targets, and the joints (n_joints,) that each sequence of them starts from."""

_ROUNDING_MM = 1e-6


@dataclass(frozen=True, slots=True)
class ComparedMethod:
    """build: the solver for an arm; it raises PlannerError where the arm has none. tolerance_mm: how far from its
    target a solved tip may be. unsolved: why a target is not solved. drawn_by: the method that `plan` draws
    with."""

    name: str
    title: str
    build: Callable[[ArmModel, ConfigurationWeights], Solve]
    tolerance_mm: float
    unsolved: str
    iterates: bool
    drawn_by: Method | None


def _by_dls(settings: dls.DlsSettings) -> Callable[[ArmModel, ConfigurationWeights], Solve]:
    def build(model: ArmModel, weights: ConfigurationWeights) -> Solve:
        solver = dls.DlsSolver(model.kinematics)
        return lambda targets, start: _one_by_one(
            targets, lambda tips_mm: solver.solve_sequence(tips_mm, start, settings)
        )

    return build


def _by_nlp(model: ArmModel, weights: ConfigurationWeights) -> Solve:
    solver, independent_of = nlp.NlpSolver(model.kinematics), model.arm.independent_of
    return lambda targets, start: _one_by_one(
        targets,
        lambda tips_mm: solver.solve_sequence(
            tips_mm, independent_of(start), settle=targets.kind is TargetKind.DRAWING
        ),
    )


def _by_closed_form(model: ArmModel, weights: ConfigurationWeights) -> Solve:
    closed_form = closed_form_of(model.arm)

    def solve(targets: Targets, start: FloatArray) -> Solutions:
        configurations = closed_form(targets.tips_mm)
        solved: BoolArray = np.all(np.isfinite(configurations), axis=1)
        return _solutions(model.kinematics, configurations, solved, targets.tips_mm)

    return solve


def _by_path(model: ArmModel, weights: ConfigurationWeights) -> Solve:
    kinematics, branches = model.kinematics, model.branches(weights)

    def solve(targets: Targets, start: FloatArray) -> Solutions:
        tips_mm = targets.tips_mm
        firsts = targets.firsts if targets.kind is TargetKind.DRAWING else np.arange(len(tips_mm))
        return _solutions(
            kinematics, *project(kinematics, branch_references(branches, tips_mm, firsts), tips_mm), tips_mm
        )

    return solve


def _one_by_one(targets: Targets, solve_sequence: Callable[[FloatArray], Solutions]) -> Solutions:
    found = [solve_sequence(tips_mm) for tips_mm in np.split(targets.tips_mm, targets.firsts[1:])]
    return Solutions(
        *(
            np.concatenate([getattr(each, name) for each in found])
            for name in ("configurations", "converged", "iterations", "error_mm")
        )
    )


def _solutions(kinematics: Kinematics, configurations: FloatArray, solved: BoolArray, tips_mm: FloatArray) -> Solutions:
    """Of methods that do not iterate; errors are NaN where there is no configuration at all."""
    error: FloatArray = np.linalg.norm(kinematics.tip_mm(configurations) - tips_mm, axis=1)
    return Solutions(configurations, solved, np.zeros(len(configurations), dtype=np.int64), error)


def _within_mm(settings: dls.DlsSettings) -> float:
    return float(np.hypot(settings.tolerance_xy_mm, settings.tolerance_z_mm))


METHODS = (
    ComparedMethod(
        "dls",
        "DLS documented",
        _by_dls(dls.DOCUMENTED),
        _within_mm(dls.DOCUMENTED),
        f"not within tolerance after {dls.DOCUMENTED.most_iterations} iterations",
        True,
        None,
    ),
    ComparedMethod(
        "dls-drawing",
        "DLS drawing",
        _by_dls(dls.FOR_DRAWING),
        _within_mm(dls.FOR_DRAWING),
        f"not within tolerance after {dls.FOR_DRAWING.most_iterations} iterations",
        True,
        Method.DLS,
    ),
    ComparedMethod(
        "nlp",
        "NLP per target",
        _by_nlp,
        nlp.TOLERANCE_MM,
        "found no configuration within the joint limits from where it began",
        True,
        Method.NLP,
    ),
    ComparedMethod(
        "closed-form",
        "closed form",
        _by_closed_form,
        _ROUNDING_MM,
        "the branch that the arm draws with does not get there",
        False,
        Method.CLOSED_FORM,
    ),
    ComparedMethod(
        "path",
        "path optimiser",
        _by_path,
        _ROUNDING_MM,
        "no configuration found near that of the map",
        False,
        Method.PATH,
    ),
)
