"""What a posture field costs for a millimetre of radius: drawing time, tip error, joint reversals, nearness to limits.

With d_j = |dq_j / d rho| / speed_j, in units of the arm's own quickness, the cost density is

    time        the square of a smooth maximum of the d_j: the joint that has to hurry most decides
    reversals   the sum of the d_j, which leaves as many joints standing still as possible
    sensitivity the mean square of the tip's sideways error for a degree (or millimetre) of error of each joint
    limits      the mean square distance of the joints from the middle of their ranges
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import casadi
import numpy as np

from planner.arms.arm import Arm
from planner.arms.compiled import CompiledFunction
from planner.arms.kinematics import Kinematics
from planner.arrays import FloatArray
from planner.settings import PostureWeights

_SENSITIVITY, _REVERSALS, _LIMITS = 20.0, 10.0, 1.0
"""Against 1 for time: with these, equal weights improve all three figures of the drawing arm against damped least
squares (benchmarks hold the trade-off)."""

_MAXIMUM_POWER = 8
_STILL = 0.03
"""Slopes below this count as standing still: the corner of the absolute value is rounded there."""


@dataclass(frozen=True, eq=False)
class PostureCost:
    """The cost of one arm under some weights. quickness_mm_s: tip speed that is typical of the arm at full joint
    speed; reach_mm: its outer radius. Both only make the terms comparable between arms."""

    kinematics: Kinematics
    weights: PostureWeights
    quickness_mm_s: float
    reach_mm: float

    @property
    def _arm(self) -> Arm:
        return self.kinematics.arm

    def posture_symbol(self) -> casadi.SX:
        """Cost density of the posture itself, in terms of the kinematics' free joints."""
        arm, joints = self._arm, self.kinematics.joints
        spread = (joints - (arm.maximum + arm.minimum) / 2) / ((arm.maximum - arm.minimum) / 2)
        symbols = casadi.SX.sym("q", arm.n_joints)
        _, _, jacobian = self.kinematics.symbolic_jacobian(symbols)
        sideways = casadi.substitute(jacobian[:2, :], symbols, joints) @ casadi.diag(arm.per_file_unit / np.radians(1))
        cost: casadi.SX = (self.weights.sensitivity * _SENSITIVITY * casadi.sumsqr(sideways) / self.reach_mm ** 2
                           + self.weights.limits * _LIMITS * casadi.sumsqr(spread) / arm.n_joints)
        return cost

    @cached_property
    def _posture(self) -> CompiledFunction:
        return CompiledFunction("posture_cost", [self.kinematics.free], [self.posture_symbol()])

    def postures(self, free: FloatArray) -> FloatArray:
        """(n,) cost densities of postures (n, n_free)."""
        return self._posture(free)[0][:, 0]

    def steps_symbol(self, steps: casadi.SX, lengths_mm: FloatArray) -> casadi.SX:
        """Cost densities (1, n) of joint steps (n_joints, n) over radial lengths (n,)."""
        scale = casadi.DM(self.quickness_mm_s / np.outer(self._arm.max_velocity, lengths_mm))
        squared = (steps * scale) ** 2
        fastest = (casadi.sum1(squared ** (_MAXIMUM_POWER // 2)) + 1e-6) ** (2 / _MAXIMUM_POWER)
        return (self.weights.time * fastest
                + self.weights.reversals * _REVERSALS * casadi.sum1(casadi.sqrt(squared + _STILL ** 2)))

    def steps(self, steps: FloatArray, length_mm: float) -> FloatArray:
        """(...) cost densities of joint steps (..., n_joints) over a radial length."""
        slope = np.abs(steps) * (self.quickness_mm_s / length_mm / self._arm.max_velocity)
        cost: FloatArray = (self.weights.time * slope.max(axis=-1) ** 2
                            + self.weights.reversals * _REVERSALS * slope.sum(axis=-1))
        return cost
