"""Inverse kinematics as a nonlinear program with joint limits, one target at a time.

`min |(q - q_before) / speed|^2 + w |(q - middle) / half range|^2` subject to `task(q) = target` and the
limits of all joints, mimic ones included, with the pen pointing down and not up. Built once for an arm,
warm-started along a stroke; where that leads nowhere, started again from elsewhere.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import casadi
import numpy as np

from planner.arms.arm import PenHold
from planner.arrays import FloatArray
from planner.inverse_kinematics.guesses import Guesses
from planner.inverse_kinematics.result import Solutions
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import joint_scale

_CENTRING = 1e-3
TOLERANCE_MM = 1e-3
_TOLERANCE_LIMITS = 1e-6
_SURE_GUESSES = 2
_MOST_SETTLING = 50
"""Each solution goes a small part of the way to where it would stay: what is left after so many is a slow drift along
the path, which is as exact as any other."""
_ROOM = 5e-3
"""Share of each joint's range kept from its limits, for the splines that join the configurations of sparse targets."""


class NlpSolver:
    """The parametric problem of one arm: SQP first, an interior-point method where that fails, then other starts."""

    def __init__(self, kinematics: Kinematics) -> None:
        arm = kinematics.arm
        self.arm, self.kinematics = arm, kinematics
        independent, joints = self.kinematics.independent, self.kinematics.joints
        before = casadi.SX.sym("before", self.kinematics.n_independent)
        middle, half = (arm.minimum + arm.maximum) / 2, (arm.maximum - arm.minimum) / 2
        objective = casadi.sumsqr((independent - before) / joint_scale(self.kinematics)) + _CENTRING * casadi.sumsqr(
            (joints - middle) / half
        )
        points = arm.pen.hold is PenHold.TOOL_AXIS  # and the task alone would let the pen point straight up
        heights = [self.kinematics.axis[2]] if points else []
        constraints = casadi.vertcat(self.kinematics.task, joints, *heights)
        problem = {"x": independent, "p": before, "f": objective, "g": constraints}
        quiet = {"print_time": False, "error_on_fail": False}
        fast = casadi.nlpsol(
            "sqp",
            "sqpmethod",
            problem,
            {
                **quiet,
                "qpsol": "qrqp",
                "print_header": False,
                "print_iteration": False,
                "print_status": False,
                "tol_pr": 1e-9,
                "tol_du": 1e-7,
                "max_iter": 30,
                "qpsol_options": {
                    "print_iter": False,
                    "print_header": False,
                    "print_info": False,
                    "error_on_fail": False,
                },
            },
        )
        sure = casadi.nlpsol(
            "ip",
            "ipopt",
            problem,
            {**quiet, "ipopt.print_level": 0, "ipopt.sb": "yes", "ipopt.max_iter": 300, "ipopt.tol": 1e-10},
        )
        on_task = np.zeros(self.kinematics.n_task)
        self._joints = slice(len(on_task), len(on_task) + arm.n_joints)
        self._lower = np.concatenate((on_task, arm.minimum, [-np.inf] * points))
        self._upper = np.concatenate((on_task, arm.maximum, [0.0] * points))
        self._allowed = np.repeat((TOLERANCE_MM, _TOLERANCE_LIMITS), (len(on_task), arm.n_joints + points))
        self._fast, self._sure = (_Buffered(solver, self._lower, self._upper) for solver in (fast, sure))
        self._guesses = Guesses(self.kinematics)

    def solve(
        self, target_mm: FloatArray, before: FloatArray, *, restarts: bool = True
    ) -> tuple[FloatArray, bool, int, float]:
        """Configuration (n_independent,) for a tip (3,) near the configuration before, whether it converged,
        iterations, error in mm. Where nothing converges it is the configuration that comes nearest."""
        self._lower[:3] = self._upper[:3] = target_mm  # the rest of the task, of pointing, has to be zero
        iterations, nearest, error_mm = 0, before, math.inf
        for solver, guess in self._attempts(target_mm, before, restarts):
            success, count = solver(before, guess)
            iterations += count
            beyond = np.maximum(self._lower - solver.constraints, solver.constraints - self._upper)
            miss_mm = math.hypot(*beyond[:3])
            if success and bool((beyond < self._allowed).all()):
                return solver.solution.copy(), True, iterations, miss_mm
            if miss_mm < error_mm:
                nearest, error_mm = solver.solution.copy(), miss_mm
        return nearest, False, iterations, error_mm

    def solve_sequence(self, targets_mm: FloatArray, start: FloatArray, *, settle: bool = True) -> Solutions:
        """Targets (n, 3) one after the other from independent joints (n_independent,), each near the one before.

        With `settle` they are a path: the first is solved until it stays where it is, so that the path does not begin
        with the way from the start, and its iterations count all of that; the others have to follow from it, and are
        not started again from elsewhere, where the path would jump.
        """
        n_targets = len(targets_mm)
        configurations = np.empty((n_targets, len(start)))
        converged = np.zeros(n_targets, dtype=bool)
        iterations = np.zeros(n_targets, dtype=np.int64)
        error_mm = np.empty(n_targets)
        before = start
        for target in targets_mm[: 1 if settle else 0]:
            for _ in range(_MOST_SETTLING):
                settled, good, count, _ = self.solve(target, before)
                iterations[0] += count
                if not good or np.abs(settled - before).max() < 1e-4:
                    break
                before = settled
        for index, target in enumerate(targets_mm):
            configurations[index], converged[index], count, error_mm[index] = self.solve(
                target, before, restarts=index == 0 or not settle
            )
            iterations[index] += count
            if converged[index]:
                before = configurations[index]
        return Solutions(configurations, converged, iterations, error_mm)

    def _attempts(
        self, target_mm: FloatArray, before: FloatArray, restarts: bool
    ) -> Iterator[tuple[_Buffered, FloatArray]]:
        """Solvers and their guesses, the cheapest first; what joints keep from their limits is given up last."""
        turned = self._guesses.turned(target_mm, before)
        self._keep(_ROOM)
        yield self._fast, turned
        yield self._sure, turned
        if not restarts:
            return
        guesses = self._guesses.near(target_mm)
        for guess in guesses:
            yield self._fast, guess
        for guess in guesses[:_SURE_GUESSES]:
            yield self._sure, guess
        self._keep(0.0)
        for guess in (turned, *guesses):
            yield self._fast, guess
        yield self._sure, turned

    def _keep(self, share: float) -> None:
        """Bound the joints to that share of their ranges within their limits."""
        room = share * (self.arm.maximum - self.arm.minimum)
        self._lower[self._joints], self._upper[self._joints] = self.arm.minimum + room, self.arm.maximum - room


class _Buffered:
    """A solver called through CasADi's raw buffers: its dictionaries would take longer than a warm solution does.

    lower, upper: (n_constraints,), read anew at every call. solution: (n_independent,) and constraints:
    (n_constraints,) are those of the last one.
    """

    def __init__(self, solver: casadi.Function, lower: FloatArray, upper: FloatArray) -> None:
        n_independent = solver.size1_in("x0")
        self._before, self._guess = np.zeros(n_independent), np.zeros(n_independent)
        self._unbounded = np.full(n_independent, np.inf)
        self._inputs = {
            "x0": self._guess,
            "p": self._before,
            "lbx": -self._unbounded,
            "ubx": self._unbounded,
            "lbg": lower,
            "ubg": upper,
        }
        self.solution, self.constraints = np.zeros(n_independent), np.zeros(len(lower))
        self._buffer, self._evaluate = solver.buffer()
        for name, array in self._inputs.items():
            self._buffer.set_arg(solver.index_in(name), memoryview(array))  # type: ignore[call-arg, arg-type]
        for name, array in (("x", self.solution), ("g", self.constraints)):
            self._buffer.set_res(solver.index_out(name), memoryview(array))  # type: ignore[call-arg, arg-type]

    def __call__(self, before: FloatArray, guess: FloatArray) -> tuple[bool, int]:
        """Whether the solver is content, and its iterations, near a configuration (n_independent,) and started from a
        guess."""
        self._before[:], self._guess[:] = before, guess
        self._evaluate()
        statistics = self._buffer.stats()
        return bool(statistics["success"]), int(statistics["iter_count"])
