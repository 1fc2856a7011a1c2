"""What a configuration map costs for a millimetre of radius: drawn error, drawing time, and what a user may add.

With dq_j / d rho the slopes of the joints, J_j how far joint j moves the tip (its height counted by half), and d_j =
|dq_j / d rho| / speed_j in units of the arm's own quickness, the cost density is

    sensitivity the expected square of the drawn error: the sum of |J_j|^2 (|dq_j / d rho|^2 + at rest^2). A joint that
                runs late or crosses its slack is off by some time of its own way; any joint is off by something at rest
    time        the square of the largest d_j: the joint that has to hurry most decides
    reversals   the sum of d_j to a power below one: how often joints turn back by more than their play, see below
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

_REVERSALS, _LIMITS = 4.0, 0.5
"""Against 1 for time and for sensitivity: weights of 1 then matter about alike."""

_AT_REST = 2.5
"""A joint at rest is off by as much as one is late that turns so many radians on the way of the arm's reach. With the
degree of slack and the 35 ms that hobby servos are late at 30 mm/s it is 2.5, with an arm of 150 mm."""

_HEIGHT = 0.5
"""What a millimetre of height counts for, against one sideways: a sprung pen leaves ink up to 1.5 mm too high."""

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

    @cached_property
    def _of_configurations(self) -> CompiledFunction:
        """The cost density of the configuration itself, and the squares of J_j, of the independent joints."""
        arm, joints = self._arm, self.kinematics.joints
        spread = (joints - (arm.maximum + arm.minimum) / 2) / ((arm.maximum - arm.minimum) / 2)
        symbols = casadi.SX.sym("q", arm.n_joints)
        _, _, jacobian = self.kinematics.symbolic_jacobian(symbols)
        counted = casadi.diag([1.0, 1.0, _HEIGHT]) @ casadi.substitute(jacobian[:3, :], symbols, joints)
        off = arm.per_file_unit / np.radians(1) * _AT_REST / self.reach_mm  # a slide by a mm for each degree
        cost = (
            self.weights.sensitivity * casadi.sumsqr(counted @ casadi.diag(off))
            + self.weights.limits * _LIMITS * casadi.sumsqr(spread) / arm.n_joints
        )
        return CompiledFunction("configuration_cost", [self.kinematics.independent], [cost, casadi.sum1(counted**2).T])

    def configurations(self, independent: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(n,) cost densities of configurations (n, n_independent), and (n, n_joints) how far the tip moves with each
        joint, squared, in mm per rad or mm: what `steps` to them needs."""
        cost, squares = self._of_configurations(independent)
        return cost[:, 0], squares

    def steps(self, steps: FloatArray, length_mm: float, squares: FloatArray) -> FloatArray:
        """(...) cost densities of joint steps (..., n_joints) over a radial length, to configurations with these
        squares (..., n_joints) of the tip's way with each joint."""
        slope = np.abs(steps) * (self.quickness_mm_s / length_mm / self._arm.max_velocity)
        time = max(self.weights.time, _LEAST_TIME * max(astuple(self.weights)))
        cost: FloatArray = (
            self.weights.sensitivity * (squares * (steps / length_mm) ** 2).sum(axis=-1)
            + time * slope.max(axis=-1) ** 2
            + self.weights.reversals * _REVERSALS * (slope**_TURNS_POWER).sum(axis=-1)
        )
        return cost
