"""What a configuration map costs for a millimetre of radius: drawing time, tip error, joint reversals, nearness to
limits.

With d_j = |dq_j / d rho| / speed_j, in units of the arm's own quickness, the cost density is

    time        the square of the largest d_j: the joint that has to hurry most decides
    reversals   the sum of d_j to a power below one: how often joints turn back by more than their play, see below
    sensitivity the mean square of the tip's sideways error for a degree (or millimetre) of error of each joint
    limits      the mean square distance of the joints from the middle of their ranges
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from functools import cached_property

import casadi
import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.kinematics.chain import Kinematics
from planner.kinematics.compiled import CompiledFunction
from planner.settings import ConfigurationWeights

_SENSITIVITY, _REVERSALS, _LIMITS = 20.0, 4.0, 0.5
"""Against 1 for time: with these, equal weights improve all three figures of the drawing arm against damped least
squares (docs/configurations.md holds the trade-off)."""

_LEAST_TIME = 0.05
"""Of the greatest weight, what time weighs at least. Where motion has no price, a joint that changes nothing else jumps
from one end of its range to the other, and no pen can be led over such a place."""

_TURNS_POWER = 0.7
"""A drawing comes nearer and goes away again far more often by a little than by much, and a joint with slope d turns
that into movements of d times the size. The number of those that are larger than the joint's play grows more slowly
than d, so one joint that stands still saves more than two that move half as much."""


@dataclass(frozen=True, eq=False)
class ConfigurationCost:
    """The cost of one arm under some weights. quickness_mm_s: tip speed that is typical of the arm at full joint
    speed; reach_mm: its outer radius. Both only make the terms comparable between arms."""

    kinematics: Kinematics
    weights: ConfigurationWeights
    quickness_mm_s: float
    reach_mm: float

    @property
    def _arm(self) -> Arm:
        return self.kinematics.arm

    def _configuration_symbol(self) -> casadi.SX:
        """Cost density of the configuration itself, in terms of the kinematics' independent joints."""
        arm, joints = self._arm, self.kinematics.joints
        spread = (joints - (arm.maximum + arm.minimum) / 2) / ((arm.maximum - arm.minimum) / 2)
        symbols = casadi.SX.sym("q", arm.n_joints)
        _, _, jacobian = self.kinematics.symbolic_jacobian(symbols)
        sideways = casadi.substitute(jacobian[:2, :], symbols, joints) @ casadi.diag(arm.per_file_unit / np.radians(1))
        cost: casadi.SX = (
            self.weights.sensitivity * _SENSITIVITY * casadi.sumsqr(sideways) / self.reach_mm**2
            + self.weights.limits * _LIMITS * casadi.sumsqr(spread) / arm.n_joints
        )
        return cost

    @cached_property
    def _configuration(self) -> CompiledFunction:
        return CompiledFunction("configuration_cost", [self.kinematics.independent], [self._configuration_symbol()])

    def configurations(self, independent: FloatArray) -> FloatArray:
        """(n,) cost densities of configurations (n, n_independent)."""
        return self._configuration(independent)[0][:, 0]

    def steps(self, steps: FloatArray, length_mm: float) -> FloatArray:
        """(...) cost densities of joint steps (..., n_joints) over a radial length."""
        slope = np.abs(steps) * (self.quickness_mm_s / length_mm / self._arm.max_velocity)
        time = max(self.weights.time, _LEAST_TIME * max(astuple(self.weights)))
        cost: FloatArray = time * slope.max(axis=-1) ** 2 + self.weights.reversals * _REVERSALS * (
            slope**_TURNS_POWER
        ).sum(axis=-1)
        return cost
