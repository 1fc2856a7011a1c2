"""A trajectory as other systems want it: joints by the names of their own, SI units, and how fast everything goes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from planner.arms.arm import Arm, Joint, JointKind
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.errors import UsageError
from planner.trajectory import Trajectory


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """drawing, arm: what they are called. positions: (n_samples, n_joints) rad or mm, first and last at rest. pen,
    stroke: (n_samples,) as in a Trajectory."""

    drawing: str
    arm: str
    joints: tuple[Joint, ...]
    rate_hz: float
    positions: FloatArray
    pen: BoolArray
    stroke: IntArray

    @staticmethod
    def of(trajectory: Trajectory, arm: Arm) -> Motion:
        """The columns have to be the arm's joints."""
        return Motion(
            trajectory.drawing,
            arm.name,
            arm.joints,
            trajectory.rate_hz,
            arm.from_file_units(trajectory.positions),
            trajectory.pen,
            trajectory.stroke,
        )

    def only(self, names: Sequence[str]) -> Motion:
        """That of some joints, in the order of the names, which are those of the arm file or of the robot description.
        Errors: UsageError."""
        known = {
            name: index for index, joint in enumerate(self.joints) for name in (joint.name, joint.urdf_name) if name
        }
        missing = [name for name in names if name not in known]
        if missing:
            raise UsageError(f"--joints: there is no joint '{missing[0]}' (joints: {', '.join(self.names)})")
        chosen = [known[name] for name in names]
        if len(set(chosen)) < len(chosen):
            raise UsageError("--joints: a joint is named twice")
        return replace(self, joints=tuple(self.joints[index] for index in chosen), positions=self.positions[:, chosen])

    @property
    def names(self) -> tuple[str, ...]:
        """As the robot description has them."""
        return tuple(joint.urdf_name or joint.name for joint in self.joints)

    @property
    def slides(self) -> BoolArray:
        """(n_joints,)"""
        return np.array([joint.kind is JointKind.PRISMATIC for joint in self.joints])

    @property
    def n_samples(self) -> int:
        return len(self.positions)

    @property
    def positions_si(self) -> FloatArray:
        """(n_samples, n_joints) rad or m."""
        positions: FloatArray = self.positions * np.where(self.slides, 1e-3, 1.0)
        return positions

    @property
    def positions_in_file_units(self) -> FloatArray:
        """(n_samples, n_joints) deg or mm."""
        positions: FloatArray = self.positions / np.array([joint.per_file_unit for joint in self.joints])
        return positions

    @property
    def velocities_si(self) -> FloatArray:
        """(n_samples, n_joints) rad/s or m/s: (q[i+1] - q[i-1]) / 2h, which is a mean of the velocity between these
        two samples and so never beyond what it is there; zero at the ends, which are at rest."""
        velocities = np.zeros_like(self.positions)
        velocities[1:-1] = (self.positions_si[2:] - self.positions_si[:-2]) * (self.rate_hz / 2)
        return velocities

    @property
    def accelerations_si(self) -> FloatArray:
        """(n_samples, n_joints) rad/s2 or m/s2: (q[i+1] - 2 q[i] + q[i-1]) / h^2, a mean too."""
        accelerations = np.zeros_like(self.positions)
        accelerations[1:-1] = np.diff(self.positions_si, n=2, axis=0) * self.rate_hz**2
        return accelerations

    def seconds_and_nanoseconds(self) -> list[tuple[int, int]]:
        """Of each sample, from the first on."""
        nanoseconds = [round(index * 1e9 / self.rate_hz) for index in range(self.n_samples)]
        return [divmod(value, 1_000_000_000) for value in nanoseconds]


def number(value: float) -> str:
    """With twelve digits, none of them for nothing."""
    return f"{value + 0.0:.12g}"
