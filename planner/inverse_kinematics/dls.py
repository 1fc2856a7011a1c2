"""The documented damped least squares: one 6 x n step at a time, couplings overwritten after each.

`dq = J^T (J J^T + lambda^2 I)^-1 e` with the geometric Jacobian J of all joints and e = [target - tip; 0],
`q <- q + dq`, then every mimic joint is set from its coupling (documents on the drawing arm, algorithm;
Buss 2004). Lengths, those that joints slide by too, are in centimetres: lambda^2 = 50 weighs cm^2 against
rad^2, and only so the documented iterations come out. Joint limits are not part of the method.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import casadi
import numpy as np

from planner.arms.arm import JointKind, PenHold
from planner.arrays import FloatArray
from planner.inverse_kinematics.result import Solutions
from planner.kinematics.chain import Kinematics
from planner.kinematics.compiled import CompiledFunction

MM_PER_CM = 10.0
_LEVER_CM = 10.0
"""What a radian of pointing counts for, in arms that have to point their tool axis. The documents' arm has none to
point, its coupling does that, and their damping is far too strong for bare radians."""


@dataclass(frozen=True, slots=True)
class DlsSettings:
    """Damping lambda^2 in cm^2, and the tolerances in the plane of the paper, across it, and of pointing."""

    lambda_squared: float = 50.0
    tolerance_xy_mm: float = 5.0
    tolerance_z_mm: float = 1.0
    tolerance_tilt: float = 1e-2
    most_iterations: int = 2000

    def met_by(self, state: DlsStep) -> bool:
        """Whether an iteration needs no further one."""
        return (
            float(np.hypot(*state.error_mm[:2])) < self.tolerance_xy_mm
            and abs(float(state.error_mm[2])) < self.tolerance_z_mm
            and state.tilt < self.tolerance_tilt
        )


DOCUMENTED = DlsSettings()
FOR_DRAWING = DlsSettings(tolerance_xy_mm=0.01, tolerance_z_mm=0.01, tolerance_tilt=1e-3)


@dataclass(frozen=True, eq=False, slots=True)
class DlsStep:
    """One iteration: joints (n_joints,) before it, tip and error in mm, sine of the tool axis' tilt where the arm has
    to point it, and the step to be added."""

    joints: FloatArray
    tip_mm: FloatArray
    error_mm: FloatArray
    tilt: float
    step: FloatArray


class DlsSolver:
    """The method for one arm. The step is built once."""

    def __init__(self, kinematics: Kinematics) -> None:
        self._arm = kinematics.arm
        self._step = _dls_step(kinematics)

    def iterate(self, start: FloatArray, target_mm: FloatArray, lambda_squared: float) -> Iterator[DlsStep]:
        """Iterations without end from joints (n_joints,) towards a tip (3,): the caller decides when to stop."""
        joints, target = np.array(start, dtype=np.float64), np.asarray(target_mm, dtype=np.float64)
        damping = np.array([[lambda_squared]])
        matrix, constant = self._arm.coupling_matrix
        while True:
            (error,), (tip,), (change,), ((tilt,),) = self._step(joints[None], target[None], damping)
            yield DlsStep(joints, tip, error, float(tilt), change)
            joints = matrix @ self._arm.independent_of(joints + change) + constant

    def solve_sequence(self, targets_mm: FloatArray, start: FloatArray, settings: DlsSettings) -> Solutions:
        """Targets (n, 3) one after the other, each started from the configuration of the one before.

        start: (n_joints,), which also holds the coupling.
        """
        n_targets = len(targets_mm)
        configurations = np.empty((n_targets, len(self._arm.independent_joints)))
        converged = np.zeros(n_targets, dtype=bool)
        iterations = np.zeros(n_targets, dtype=np.int64)
        error_mm = np.empty(n_targets)
        joints = np.asarray(start)
        for index, target in enumerate(targets_mm):
            for count, state in enumerate(self.iterate(joints, target, settings.lambda_squared)):
                joints = state.joints
                converged[index] = settings.met_by(state)
                if converged[index] or count >= settings.most_iterations:
                    break
            iterations[index] = count
            error_mm[index] = float(np.linalg.norm(state.error_mm))
            configurations[index] = self._arm.independent_of(joints)
        return Solutions(configurations, converged, iterations, error_mm)


def _dls_step(kinematics: Kinematics) -> CompiledFunction:
    """(joints, target in mm, lambda^2) to (error in mm, tip in mm, step, sine of the tilt)."""
    arm = kinematics.arm
    joints = casadi.SX.sym("q", arm.n_joints)
    target = casadi.SX.sym("target_mm", 3)
    damping = casadi.SX.sym("lambda_squared")
    tip, axis, jacobian = kinematics.symbolic_jacobian(joints)
    points = arm.pen.hold is PenHold.TOOL_AXIS
    to_cm = casadi.diag(casadi.DM([1 / MM_PER_CM] * 3 + [_LEVER_CM if points else 1.0] * 3))
    turn = (
        casadi.cross(axis, casadi.DM(arm.paper.T_paper_base[:3, :3] @ kinematics.held_along))
        if points
        else casadi.SX.zeros(3)
    )
    error = target - tip
    joint_unit = casadi.diag(
        casadi.DM([MM_PER_CM if joint.kind is JointKind.PRISMATIC else 1.0 for joint in arm.joints])
    )
    scaled = to_cm @ jacobian @ joint_unit
    damped = scaled @ scaled.T + damping * casadi.SX.eye(6)
    step = joint_unit @ scaled.T @ casadi.solve(damped, to_cm @ casadi.vertcat(error, turn))
    return CompiledFunction("dls", [joints, target, damping], [error, tip, step, casadi.norm_2(turn)], blocks=(1,))
