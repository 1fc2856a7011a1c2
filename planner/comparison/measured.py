"""One method on one set of targets: what it finds, how long it takes, and what it finds the next time round."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import process_time

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import BoolArray, FloatArray
from planner.comparison.methods import ComparedMethod, Solve
from planner.comparison.targets import Targets
from planner.inverse_kinematics.result import Solutions
from planner.redundancy.arm_model import ArmModel
from planner.settings import ConfigurationWeights

_MOST_RUNS, _ENOUGH_S = 20, 0.2
"""Short runs are repeated, and the quickest counts."""


@dataclass(frozen=True, eq=False, slots=True)
class Measured:
    """joints: (n, n_joints) rad or mm; solved: (n,) as the method judges; iterations: (n,); error_mm: (n,); each in the
    order of the targets. again, solved_again: the same targets visited backwards. cold_s: building the
    solver and the first target; warm_s: a target once it is built, in the mean; both of processor time, which does
    not count what else the computer is doing."""

    joints: FloatArray
    solved: BoolArray
    iterations: FloatArray
    error_mm: FloatArray
    again: FloatArray
    solved_again: BoolArray
    cold_s: float
    warm_s: float


def measure(
    method: ComparedMethod,
    arm: Arm,
    weights: ConfigurationWeights,
    targets: Targets,
    start: FloatArray,
    clock: Callable[[], float] = process_time,
) -> Measured:
    """Solve for all targets, forwards and backwards. Errors: PlannerError where the arm has no such method."""
    began = clock()
    solve = method.build(ArmModel(arm, cache=False), weights)  # of which nothing has been built yet
    solve(targets.first(), start)
    cold_s = clock() - began
    found, warm_s = _timed(solve, targets, start, clock)
    back = solve(targets.backwards(), start)
    return Measured(
        arm.complete(found.configurations),
        found.converged,
        found.iterations.astype(np.float64),
        found.error_mm,
        arm.complete(back.configurations[::-1]),
        back.converged[::-1],
        cold_s,
        warm_s / len(targets.tips_mm),
    )


def _timed(solve: Solve, targets: Targets, start: FloatArray, clock: Callable[[], float]) -> tuple[Solutions, float]:
    """What is found, and the seconds of the quickest run."""
    began = clock()
    quickest = np.inf
    for _ in range(_MOST_RUNS):
        before = clock()
        found = solve(targets, start)
        after = clock()
        quickest = min(quickest, after - before)
        if after - began > _ENOUGH_S:
            break
    return found, quickest
