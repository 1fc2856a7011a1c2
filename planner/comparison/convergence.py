"""The documented damped least squares towards one target, iteration by iteration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.comparison.worked_example import ITERATIONS, TARGET_CM, Row, documented_start
from planner.inverse_kinematics.dls import DOCUMENTED, MM_PER_CM, DlsSolver, DlsStep
from planner.kinematics.chain import Kinematics


@dataclass(frozen=True, eq=False, slots=True)
class Convergence:
    """steps: from the start to the one that meets the documents' tolerances, or the last that was tried; printed: what
    the documents print of the same iterations, if they do."""

    target_mm: FloatArray
    steps: tuple[DlsStep, ...]
    converged: bool
    printed: tuple[Row, ...]


def convergence(kinematics: Kinematics, target_mm: FloatArray, start: FloatArray) -> Convergence:
    """From joints (n_joints,) to a tip (3,)."""
    steps: list[DlsStep] = []
    for state in DlsSolver(kinematics).iterate(start, target_mm, DOCUMENTED.lambda_squared):
        steps.append(state)
        if DOCUMENTED.met_by(state) or len(steps) > DOCUMENTED.most_iterations:
            break
    documented = documented_start(kinematics.arm)
    is_printed = (
        documented is not None
        and np.allclose(start, documented, rtol=0, atol=1e-9)
        and np.allclose(target_mm, MM_PER_CM * np.array(TARGET_CM), rtol=0, atol=1e-9)
    )
    return Convergence(target_mm, tuple(steps), DOCUMENTED.met_by(steps[-1]), ITERATIONS if is_printed else ())
