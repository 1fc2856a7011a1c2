"""Inverse kinematics as a nonlinear programme with joint limits, one target at a time.

`min |(q - q_before) / speed|^2 + w |(q - middle) / half range|^2` subject to `task(q) = target` and the
limits of all joints, driven ones included. Built once for an arm, warm-started along a stroke.
"""

from __future__ import annotations

import math
from functools import lru_cache

import casadi
import numpy as np

from planner.arms.arm import Arm
from planner.arms.kinematics import kinematics_of
from planner.arms.projection import joint_scale
from planner.arrays import FloatArray
from planner.inverse_kinematics.result import Solutions

_CENTRING = 1e-3
TOLERANCE_MM = 1e-3
_TOLERANCE_LIMITS = 1e-6
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
        fast = casadi.nlpsol("sqp", "sqpmethod", problem, {
            **quiet, "qpsol": "qrqp", "print_header": False, "print_iteration": False, "print_status": False,
            "tol_pr": 1e-9, "tol_du": 1e-7, "max_iter": 30,
            "qpsol_options": {"print_iter": False, "print_header": False, "print_info": False, "error_on_fail": False}})
        sure = casadi.nlpsol("ip", "ipopt", problem, {
            **quiet, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.max_iter": 300, "ipopt.tol": 1e-10})
        room = _ROOM * (arm.maximum - arm.minimum)
        self._n_task = self.kinematics.n_task
        self._lower = np.concatenate((np.zeros(self._n_task), arm.minimum + room))
        self._upper = np.concatenate((np.zeros(self._n_task), arm.maximum - room))
        self._allowed = np.repeat((TOLERANCE_MM, _TOLERANCE_LIMITS), (self._n_task, arm.n_joints))
        self._solvers = [_Buffered(solver, self._lower, self._upper) for solver in (fast, sure)]

    def solve(self, target_mm: FloatArray, before: FloatArray) -> tuple[FloatArray, bool, int, float]:
        """Posture (n_free,) for a tip (3,) near the posture before, whether it converged, iterations, error in mm."""
        self._lower[:3] = self._upper[:3] = target_mm  # the rest of the task, of pointing, has to be zero
        iterations = 0
        for solver in self._solvers:
            success, count = solver(before)
            iterations += count
            beyond = np.maximum(self._lower - solver.constraints, solver.constraints - self._upper)
            converged = success and bool((beyond < self._allowed).all())
            if converged:
                break
        return solver.solution.copy(), converged, iterations, math.hypot(*beyond[:3])


class _Buffered:
    """A solver called through CasADi's raw buffers: its dictionaries would take longer than a warm solution does.

    lower, upper: (n_constraints,), read anew at every call. solution: (n_free,) and constraints: (n_constraints,)
    are those of the last one.
    """

    def __init__(self, solver: casadi.Function, lower: FloatArray, upper: FloatArray) -> None:
        n_free = solver.size1_in("x0")
        self._before = np.zeros(n_free)
        self._unbounded = np.full(n_free, np.inf)
        self._inputs = {"x0": self._before, "p": self._before, "lbx": -self._unbounded, "ubx": self._unbounded,
                        "lbg": lower, "ubg": upper}
        self.solution, self.constraints = np.zeros(n_free), np.zeros(len(lower))
        self._buffer, self._evaluate = solver.buffer()
        for name, array in self._inputs.items():
            self._buffer.set_arg(solver.index_in(name), memoryview(array))  # type: ignore[call-arg, arg-type]
        for name, array in (("x", self.solution), ("g", self.constraints)):
            self._buffer.set_res(solver.index_out(name), memoryview(array))  # type: ignore[call-arg, arg-type]

    def __call__(self, before: FloatArray) -> tuple[bool, int]:
        """Whether the solver is content, and its iterations, near a posture (n_free,) and started from it."""
        self._before[:] = before
        self._evaluate()
        statistics = self._buffer.stats()
        return bool(statistics["success"]), int(statistics["iter_count"])


@lru_cache(maxsize=16)
def nlp_solver(arm: Arm) -> NlpSolver:
    """The solver of an arm, built once."""
    return NlpSolver(arm)


def solve_sequence(arm: Arm, targets_mm: FloatArray, start: FloatArray, *, settle: bool = True) -> Solutions:
    """Targets (n, 3) one after the other from free joints (n_free,), each near the one before.

    With `settle` the first is solved until it stays where it is, so that a path does not begin with the way from the
    start; its iterations count all of that.
    """
    solver = nlp_solver(arm)
    n_targets = len(targets_mm)
    postures = np.empty((n_targets, len(start)))
    converged = np.zeros(n_targets, dtype=bool)
    iterations = np.zeros(n_targets, dtype=np.int64)
    error_mm = np.empty(n_targets)
    before = start
    for target in targets_mm[:1 if settle else 0]:
        for _ in range(_MOST_SETTLING):
            settled, good, count, _ = solver.solve(target, before)
            iterations[0] += count
            if not good or np.abs(settled - before).max() < 1e-4:
                break
            before = settled
    for index, target in enumerate(targets_mm):
        postures[index], converged[index], count, error_mm[index] = solver.solve(target, before)
        iterations[index] += count
        if converged[index]:
            before = postures[index]
    return Solutions(postures, converged, iterations, error_mm)
