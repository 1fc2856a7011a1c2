"""Inverse kinematics as a nonlinear programme with joint limits, one target at a time.

`min |(q - q_before) / speed|^2 + w |(q - middle) / half range|^2` subject to `task(q) = target` and the
limits of all joints, driven ones included. Built once for an arm, warm-started along a stroke.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi
import numpy as np

from planner.arms.arm import Arm
from planner.arms.kinematics import kinematics_of
from planner.arms.projection import joint_scale
from planner.arrays import FloatArray
from planner.inverse_kinematics.result import Solutions

_CENTRING = 1e-3
_TOLERANCE_MM = 1e-3
_MOST_SETTLING = 50
_ROOM = 5e-3
"""Share of each joint's range kept from its limits, for the splines that join the postures of sparse targets."""


class NlpSolver:
    """The parametric problem of one arm: SQP first, an interior-point method where that fails."""

    def __init__(self, arm: Arm) -> None:
        self.arm = arm
        self.kinematics = kinematics_of(arm)
        free, joints = self.kinematics.free, self.kinematics.joints
        before = casadi.SX.sym("before", self.kinematics.n_free)
        middle, half = (arm.minimum + arm.maximum) / 2, (arm.maximum - arm.minimum) / 2
        objective = (casadi.sumsqr((free - before) / joint_scale(self.kinematics))
                     + _CENTRING * casadi.sumsqr((joints - middle) / half))
        problem = {"x": free, "p": before, "f": objective, "g": casadi.vertcat(self.kinematics.task, joints)}
        quiet = {"print_time": False, "error_on_fail": False}
        self._fast = casadi.nlpsol("sqp", "sqpmethod", problem, {
            **quiet, "qpsol": "qrqp", "print_header": False, "print_iteration": False, "print_status": False,
            "tol_pr": 1e-9, "tol_du": 1e-7, "max_iter": 30,
            "qpsol_options": {"print_iter": False, "print_header": False, "print_info": False, "error_on_fail": False}})
        self._sure = casadi.nlpsol("ip", "ipopt", problem, {
            **quiet, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.max_iter": 300, "ipopt.tol": 1e-10})

    def solve(self, target_mm: FloatArray, before: FloatArray) -> tuple[FloatArray, bool, int, float]:
        """Posture (n_free,) for a tip (3,) near the posture before, whether it converged, iterations, error in mm."""
        target = self.kinematics.task_target(target_mm[None])[0]
        room = _ROOM * (self.arm.maximum - self.arm.minimum)
        bounds = {"lbg": np.concatenate((target, self.arm.minimum + room)),
                  "ubg": np.concatenate((target, self.arm.maximum - room))}
        solution, iterations = before, 0
        for solver in (self._fast, self._sure):
            found: dict[str, Any] = solver(x0=before, p=before, **bounds)
            statistics = solver.stats()
            iterations += int(statistics["iter_count"])
            solution = np.array(found["x"]).ravel()
            values = np.array(found["g"]).ravel()
            miss = values[:len(target)] - target
            error_mm = float(np.linalg.norm(miss[:3]))
            outside = float(np.maximum(bounds["lbg"] - values, values - bounds["ubg"])[len(target):].max())
            if statistics["success"] and np.abs(miss).max() < _TOLERANCE_MM and outside < 1e-6:
                return solution, True, iterations, error_mm
        return solution, False, iterations, error_mm


@lru_cache(maxsize=16)
def nlp_solver(arm: Arm) -> NlpSolver:
    """The solver of an arm, built once."""
    return NlpSolver(arm)


def solve_sequence(arm: Arm, targets_mm: FloatArray, start: FloatArray) -> Solutions:
    """Targets (n, 3) one after the other from free joints (n_free,), each near the one before.

    The first is solved until it stays where it is, so that a path does not begin with the way from the start.
    """
    solver = nlp_solver(arm)
    n_targets = len(targets_mm)
    postures = np.empty((n_targets, len(start)))
    converged = np.zeros(n_targets, dtype=bool)
    iterations = np.zeros(n_targets, dtype=np.int64)
    error_mm = np.empty(n_targets)
    before = start
    for target in targets_mm[:1]:
        for _ in range(_MOST_SETTLING):
            settled, good, _, _ = solver.solve(target, before)
            if not good or np.abs(settled - before).max() < 1e-4:
                break
            before = settled
    for index, target in enumerate(targets_mm):
        postures[index], converged[index], iterations[index], error_mm[index] = solver.solve(target, before)
        if converged[index]:
            before = postures[index]
    return Solutions(postures, converged, iterations, error_mm)
