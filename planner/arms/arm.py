"""An arm as a value: its chain, its limits, and how it keeps a pen to the paper.

Each joint is a fixed transform, its origin, which most do without, and then a standard Denavit-Hartenberg row:
(theta, d, a, alpha) is `Rz(theta) Tz(d) Tx(a) Rx(alpha)`; a revolute joint adds its position to theta, a prismatic one
to d. After the last row comes the tool, a fixed transform too: the last frame is there, and the tip of the pen is its
origin. The paper is the plane z = 0 of its own frame, which is the base frame unless the file says where it lies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import cached_property

import numpy as np

from planner.arms.accuracy import Accuracy
from planner.arms.paper_pose import BASE_PLANE, PaperPose
from planner.arms.rigid_transform import IDENTITY, RigidTransform
from planner.arrays import FloatArray
from planner.errors import UsageError
from planner.settings import DEFAULT_WEIGHTS, ConfigurationWeights


class JointKind(StrEnum):
    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"


class PenHold(StrEnum):
    """What keeps the pen to the paper, and so which equations a configuration has to meet beside the tip's place."""

    COUPLING = "coupling"
    """Linear couplings between joints keep it upright: nothing to solve for."""
    CONSTRUCTION = "construction"
    """The chain itself keeps it upright (SCARA): nothing to solve for."""
    TOOL_AXIS = "tool_axis"
    """An axis of the last frame has to point straight at the paper, spin about it is free: two equations."""
    FREE = "free"
    """Only the tip is held; the tilt is whatever the chain gives."""


SERVO_LAG_S = 0.02
"""What hobby servos lag, where nothing else is known."""


@dataclass(frozen=True, slots=True)
class Servo:
    """The servo behind a joint, where it is one that is told by pulses.

    curve: (position, pulse in us), ascending in position and strictly monotone in pulse, two points where it is a
    straight line. Its positions are the servo's own, rad or mm: `direction` times the joint's. trim_us is added to
    what the curve gives. backlash: the full play, from one end to the other, rad or mm. lag_s: time constant of the
    first-order lag with which it follows.
    """

    channel: int
    curve: tuple[tuple[float, float], ...]
    direction: int
    trim_us: float
    pulse_range_us: tuple[float, float]
    resolution_us: float
    dead_band_us: float
    backlash: float
    lag_s: float = SERVO_LAG_S


@dataclass(frozen=True, slots=True)
class BusServo:
    """The servo behind a joint, where it is one on a bus: count = count_at_zero + counts_per_unit * position.

    Position in rad or mm; `id` is its number on the bus. backlash, lag_s: as a Servo's. curve: (position, count),
    ascending in position, in place of the straight line where a calibration found a bent one.
    """

    id: int
    count_at_zero: float
    counts_per_unit: float
    count_range: tuple[int, int]
    dead_band_counts: float = 0.0
    backlash: float = 0.0
    curve: tuple[tuple[float, float], ...] | None = None
    lag_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Joint:
    """One DH row and its limits: rad, rad/s, ... for a revolute joint, mm, mm/s, ... for a prismatic one.

    thickness_mm: diameter of the row's link, a capsule along its d, its a and the way to the origin of the next joint;
    None where it is not known. origin: from the end of the row before to the frame about or along whose z it moves.
    urdf_name: what a robot description calls it, where that can be no column of a file.
    """

    name: str
    kind: JointKind
    theta_rad: float
    d_mm: float
    a_mm: float
    alpha_rad: float
    minimum: float
    maximum: float
    max_velocity: float
    max_acceleration: float
    max_jerk: float
    servo: Servo | None = None
    bus: BusServo | None = None
    thickness_mm: float | None = None
    origin: RigidTransform = IDENTITY
    urdf_name: str | None = None

    @property
    def length_mm(self) -> float:
        """The greatest length that it adds to the chain."""
        slides = max(abs(self.minimum), abs(self.maximum)) if self.kind is JointKind.PRISMATIC else 0.0
        return self.origin.length_mm + abs(self.d_mm) + abs(self.a_mm) + slides

    @property
    def file_unit(self) -> str:
        """Unit of this joint in files and on the screen: "deg" or "mm"."""
        return "deg" if self.kind is JointKind.REVOLUTE else "mm"

    @property
    def per_file_unit(self) -> float:
        """How much of the inner unit (rad or mm) one file unit (deg or mm) is."""
        return float(np.pi / 180) if self.kind is JointKind.REVOLUTE else 1.0


@dataclass(frozen=True, slots=True)
class Coupling:
    """Joint `joint` follows others: q[joint] = constant + sum of coefficient * q[other], each in rad or mm."""

    joint: int
    constant: float
    coefficients: tuple[tuple[int, float], ...]


@dataclass(frozen=True, slots=True)
class Pen:
    """How the pen is held and lifted. `tool_axis` is a unit vector of the last frame that points out of the nib.

    speed_mm_s: on the paper, where nothing else is asked for: how fast the arm still draws well.
    """

    hold: PenHold
    tool_axis: tuple[float, float, float]
    lift_mm: float
    clearance_mm: float
    speed_mm_s: float = 80.0


@dataclass(frozen=True, slots=True)
class Workspace:
    """What the builder says of the paper: the inner radius that the pen stays out of, and how close to a
    singular configuration drawing may come.

    min_tip_speed_mm_s: a configuration counts as usable where the tip can move at least this fast in every
        direction with the joints within their speeds (smallest singular value of J diag(speeds)).
    """

    inner_radius_mm: float
    min_tip_speed_mm_s: float


@dataclass(frozen=True)
class Arm:
    """A checked arm. Joint arrays are in chain order, in rad or mm; closed_form names its family, if any. Two arms are
    equal where all of this is.

    park: (n_joints,) where the arm rests when it is not used, if the builder says. paper: where the paper lies.
    set_point_period_s: how often its servos take a new set point, where that is known. accuracy: what a calibration
    left unknown, where there was one. weights: what spare joints are spent on, where nothing else is asked for. tool:
    from the end of the last row to the pen's frame, whose origin is the tip.
    """

    name: str
    source: str
    joints: tuple[Joint, ...]
    couplings: tuple[Coupling, ...]
    pen: Pen
    workspace: Workspace
    closed_form: str | None = None
    park: tuple[float, ...] | None = None
    paper: PaperPose = BASE_PLANE
    accuracy: Accuracy | None = None
    weights: ConfigurationWeights = DEFAULT_WEIGHTS
    tool: RigidTransform = IDENTITY
    set_point_period_s: float | None = None

    @property
    def n_joints(self) -> int:
        return len(self.joints)

    def _column(self, key: str) -> FloatArray:
        column = np.array([getattr(joint, key) for joint in self.joints], dtype=np.float64)
        column.setflags(write=False)
        return column

    @cached_property
    def minimum(self) -> FloatArray:
        return self._column("minimum")

    @cached_property
    def maximum(self) -> FloatArray:
        return self._column("maximum")

    @cached_property
    def max_velocity(self) -> FloatArray:
        return self._column("max_velocity")

    @cached_property
    def max_acceleration(self) -> FloatArray:
        return self._column("max_acceleration")

    @cached_property
    def max_jerk(self) -> FloatArray:
        return self._column("max_jerk")

    @cached_property
    def per_file_unit(self) -> FloatArray:
        """(n_joints,) inner units in one file unit."""
        return self._column("per_file_unit")

    @cached_property
    def independent_joints(self) -> tuple[int, ...]:
        """Indices of the joints that no coupling drives."""
        mimic = {coupling.joint for coupling in self.couplings}
        return tuple(index for index in range(self.n_joints) if index not in mimic)

    @cached_property
    def coupling_matrix(self) -> tuple[FloatArray, FloatArray]:
        """(C, c) with q = C q_independent + c: shapes (n_joints, n_independent) and (n_joints,)."""
        matrix = np.zeros((self.n_joints, len(self.independent_joints)))
        constant = np.zeros(self.n_joints)
        column = {joint: k for k, joint in enumerate(self.independent_joints)}
        for joint, k in column.items():
            matrix[joint, k] = 1.0
        for coupling in self.couplings:
            constant[coupling.joint] = coupling.constant
            for other, coefficient in coupling.coefficients:
                matrix[coupling.joint, column[other]] = coefficient
        matrix.setflags(write=False)
        constant.setflags(write=False)
        return matrix, constant

    def complete(self, independent: FloatArray) -> FloatArray:
        """All joints (..., n_joints) from the free ones (..., n_independent), couplings applied."""
        matrix, constant = self.coupling_matrix
        joints: FloatArray = independent @ matrix.T + constant
        return joints

    def independent_of(self, joints: FloatArray) -> FloatArray:
        """The independent joints (..., n_independent) among all (..., n_joints)."""
        chosen: FloatArray = np.ascontiguousarray(joints[..., list(self.independent_joints)])
        return chosen

    def to_file_units(self, positions: FloatArray) -> FloatArray:
        """(..., n_joints) from rad or mm to the degrees and millimetres of files."""
        converted: FloatArray = positions / self.per_file_unit
        return converted

    def from_file_units(self, positions: FloatArray | Sequence[float]) -> FloatArray:
        """(..., n_joints) from the degrees and millimetres of files to rad or mm."""
        converted: FloatArray = np.asarray(positions, dtype=np.float64) * self.per_file_unit
        return converted

    def holding(self, height_mm: float, held_along: FloatArray | None = None) -> Arm:
        """The arm with a pen whose tip sticks out so much further, for which the paper is so much nearer: what is
        computed of its tip is true of the pen in the file, which stands that far off what is drawn. Exact for a pen
        that is held as `held_along` (3,) in the base frame, which is straight at the paper for a pen that is held so by
        its tool axis, straight down for others, where it is left out. Errors: UsageError for an arm that lets it
        tilt."""
        if not height_mm:
            return self
        if self.pen.hold is PenHold.FREE:
            raise UsageError(
                f"height_mm of a pen is {height_mm:g}, and arm {self.name} does not keep its pen upright: give each"
                " such pen an arm file of its own, with the length that it has"
            )
        if held_along is None:
            held_along = -self.paper.normal if self.pen.hold is PenHold.TOOL_AXIS else np.array([0.0, 0.0, -1.0])
        return replace(self, paper=self.paper.moved(-height_mm * held_along))

    @property
    def column_names(self) -> tuple[str, ...]:
        """Names of the joint columns in a trajectory file, such as `q1_deg`."""
        return tuple(f"{joint.name}_{joint.file_unit}" for joint in self.joints)
