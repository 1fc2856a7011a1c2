"""Symbolic kinematics of any arm, built by CasADi from its chain and couplings.

Everything is a function of the independent joints: mimic joints are substituted, so a configuration cannot leave
its coupling. Compiled functions are evaluated over whole arrays of configurations at once.
"""

from __future__ import annotations

from functools import cached_property

import casadi
import numpy as np

from planner.arms.arm import Arm, JointKind, PenHold
from planner.arms.rigid_transform import RigidTransform
from planner.arrays import FloatArray
from planner.kinematics.compiled import CompiledFunction
from planner.kinematics.dh_row import dh_entries
from planner.kinematics.link_clearance import LinkClearance

_PROBES = 32
_NEARLY_SQUARE_RAD = float(np.radians(5.0))
"""Up to so far from square to the first joint's axis the paper counts as level to it."""
_ZERO = 1e-4
"""A horizontal component of a unit vector that is none: robot descriptions have right angles to four or five digits."""


class Kinematics:
    """Forward kinematics, Jacobians, the task and the clearances of one arm, as functions of its independent joints.

    The task is what a configuration has to meet at a pen target: the tip's place (3 rows, mm) and, where the
    tool axis has to point straight at the paper, its components along the paper (which have to be zero), seen from the
    turning base. An axis that stays in a plane with the base axis by construction has only one of them: such a pen is
    held to the base's vertical, as long as the paper is nearly level.
    held_along: (3,) how a pen that is held points, in the base frame.
    """

    def __init__(self, arm: Arm) -> None:
        self.arm = arm
        matrix, constant = arm.coupling_matrix
        self.independent = casadi.SX.sym("q", len(arm.independent_joints))
        self.joints = casadi.sparsify(casadi.SX(matrix)) @ self.independent + constant
        frames, last, corners = _chain(arm, self.joints)
        self.frames, self.last = frames, last
        self.tip = last[:3, 3]
        self.axis = last[:3, :3] @ casadi.DM(arm.pen.tool_axis)
        self.task, self.held_along = self.tip, np.array([0.0, 0.0, -1.0])
        if arm.pen.hold is PenHold.TOOL_AXIS:
            pointing, normal = self._pointing()
            self.task, self.held_along = casadi.vertcat(self.tip, *pointing), -normal
        self.nodes = casadi.horzcat(*corners).T

    @cached_property
    def clearance(self) -> LinkClearance:
        return LinkClearance(self.arm, self.nodes_mm)

    @property
    def turns_over_paper(self) -> bool:
        """Whether the first joint turns the whole arm about the paper's normal, or nearly so, and nothing else: what is
        done at one place is then done all around."""
        arm = self.arm
        alone = 0 in arm.independent_joints and all(
            other != 0 for coupling in arm.couplings for other, _ in coupling.coefficients
        )
        first = arm.joints[0]
        return first.kind is JointKind.REVOLUTE and first.origin.is_identity and alone and self._nearly_level

    @property
    def _nearly_level(self) -> bool:
        """Whether the paper's normal is the base's vertical, or nearly so."""
        return bool(self.arm.paper.normal[2] >= np.cos(_NEARLY_SQUARE_RAD))

    def _pointing(self) -> tuple[list[casadi.SX], FloatArray]:
        """What is zero where the pen points straight at the paper, and the paper's normal, (3,) in the base frame. An
        arm that cannot lean its pen sideways cannot follow a paper that is not quite level: it holds it to the
        vertical, which is given as the normal then."""
        if self._nearly_level:
            upright = self._leaning(self.arm.paper.T_base_paper[:3, :3])
            if len(upright) < 2:
                return upright, np.array([0.0, 0.0, 1.0])
        return self._leaning(np.eye(3)), self.arm.paper.normal

    def _leaning(self, turn: FloatArray) -> list[casadi.SX]:
        """The components of the tool axis, turned (3, 3) from the paper's frame, square to z that are not zero by
        construction: along and across the plane of the first link, if the axis stays in one, or that of a joint that
        stays square to z and to the tool axis."""
        axis = casadi.DM(turn) @ self.axis
        if self.turns_over_paper:
            c, s = casadi.cos(self.joints[0]), casadi.sin(self.joints[0])
            components = casadi.vertcat(c * axis[0] + s * axis[1], c * axis[1] - s * axis[0])
            values = self._probed(components)
            if (np.abs(values).max(axis=1) > _ZERO).all():  # the plane may stand askew to the first link's frame
                turns, sizes, _ = np.linalg.svd(values, full_matrices=False)
                if sizes[1] <= _ZERO * _PROBES:
                    return [casadi.DM(turns[:, 0]).T @ components]
            return self._not_always_zero(components)
        for frame in self.frames:
            side = casadi.DM(turn) @ frame[:3, 2]
            if not self._not_always_zero(casadi.vertcat(side[2], casadi.dot(side, axis))):
                return self._not_always_zero(side[1] * axis[0] - side[0] * axis[1])
        return self._not_always_zero(axis[:2])

    def _not_always_zero(self, values: casadi.SX) -> list[casadi.SX]:
        """Those of the values that some configuration makes other than zero."""
        largest = np.abs(self._probed(values)).max(axis=1)
        return [values[row] for row in range(values.shape[0]) if largest[row] > _ZERO]

    def _probed(self, values: casadi.SX) -> FloatArray:
        """(n_values, n_probes) the values in random configurations."""
        probe = casadi.Function("probe", [self.independent], [values])
        configurations = np.random.default_rng(0).uniform(-np.pi, np.pi, (self.n_independent, _PROBES))
        probed: FloatArray = np.array(probe.map(_PROBES)(configurations))
        return probed

    @property
    def n_independent(self) -> int:
        return len(self.arm.independent_joints)

    @property
    def n_task(self) -> int:
        return int(self.task.shape[0])

    @property
    def n_redundant(self) -> int:
        """Degrees of freedom left at a pen target."""
        return self.n_independent - self.n_task

    @cached_property
    def _pose(self) -> CompiledFunction:
        return CompiledFunction("pose", [self.independent], [self.last])

    @cached_property
    def _tip(self) -> CompiledFunction:
        return CompiledFunction("tip", [self.independent], [self.tip])

    @cached_property
    def _axis(self) -> CompiledFunction:
        return CompiledFunction("axis", [self.independent], [self.axis])

    @cached_property
    def _nodes(self) -> CompiledFunction:
        return CompiledFunction("nodes", [self.independent], [self.nodes])

    @cached_property
    def _task(self) -> CompiledFunction:
        return CompiledFunction("task", [self.independent], [self.task, casadi.jacobian(self.task, self.independent)])

    @cached_property
    def _jacobian(self) -> CompiledFunction:
        joints = casadi.SX.sym("q", self.arm.n_joints)
        return CompiledFunction("jacobian", [joints], [self.symbolic_jacobian(joints)[2]])

    def symbolic_jacobian(self, joints: casadi.SX) -> tuple[casadi.SX, casadi.SX, casadi.SX]:
        """Tip, tool axis and the geometric 6 x n Jacobian at symbolic joints, each taken as independent."""
        frames, last, _ = _chain(self.arm, joints)
        tip = last[:3, 3]
        angular = casadi.horzcat(
            *[
                frame[:3, 2] if joint.kind is JointKind.REVOLUTE else casadi.SX.zeros(3)
                for frame, joint in zip(frames, self.arm.joints, strict=True)
            ]
        )
        pointing = last[:3, :3] @ casadi.DM(self.arm.pen.tool_axis)
        return tip, pointing, casadi.vertcat(casadi.jacobian(tip, joints), angular)

    def pose(self, independent: FloatArray) -> FloatArray:
        """T_paper_pen (n, 4, 4), mm, of configurations (n, n_independent)."""
        return self._pose(independent)[0]

    def tip_mm(self, independent: FloatArray) -> FloatArray:
        """Pen tip (n, 3), mm, of configurations (n, n_independent)."""
        return self._tip(independent)[0]

    def tool_axis(self, independent: FloatArray) -> FloatArray:
        """Unit vector (n, 3) out of the nib, in the paper's frame, of configurations (n, n_independent)."""
        return self._axis(independent)[0]

    def nodes_mm(self, independent: FloatArray) -> FloatArray:
        """Corners of the link chain (n, n_nodes, 3), mm, from the first joint to the tip."""
        return self._nodes(independent)[0]

    def task_and_jacobian(self, independent: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Task (n, n_task) and its derivative by the independent joints (n, n_task, n_independent)."""
        task, jacobian = self._task(independent)
        return task, jacobian.reshape(len(independent), self.n_task, self.n_independent)

    def jacobian(self, joints: FloatArray) -> FloatArray:
        """Geometric Jacobian in the base frame, (n, 6, n_joints): linear rows in mm, then angular rows,
        of all joints (n, n_joints) as if no coupling held."""
        return self._jacobian(joints)[0].reshape(len(joints), 6, self.arm.n_joints)

    def task_target(self, tip_mm: FloatArray) -> FloatArray:
        """(n, n_task) the task's value where the tip is at (n, 3) and the pen is held as the arm holds it."""
        target = np.zeros((len(tip_mm), self.n_task))
        target[:, :3] = tip_mm
        return target

    def independent_of(self, joints: FloatArray) -> FloatArray:
        """The independent joints (..., n_independent) among all (..., n_joints)."""
        return self.arm.independent_of(joints)


def _chain(arm: Arm, joints: casadi.SX) -> tuple[list[casadi.SX], casadi.SX, list[casadi.SX]]:
    """The frame about or along whose z each joint moves and that of the pen, 4 x 4, and the corners of the link chain
    as points: for each joint its origin, where that is some way off, and the ends of its d and its a; then the tip."""
    frame = casadi.SX.eye(4) if arm.paper.is_base_plane else casadi.SX(arm.paper.T_paper_base)
    frames, corners = [], []
    for index, joint in enumerate(arm.joints):
        frame = _moved(frame, joint.origin)
        if joint.origin.length_mm:
            corners.append(frame[:3, 3])
        frames.append(frame)
        revolute = joint.kind is JointKind.REVOLUTE
        theta = joint.theta_rad + (joints[index] if revolute else 0)
        d = joint.d_mm + (0 if revolute else joints[index])
        along = frame @ casadi.vertcat(0, 0, d, 1)
        frame = frame @ _dh(theta, d, joint.a_mm, joint.alpha_rad)
        corners += [along[:3], frame[:3, 3]]
    frame = _moved(frame, arm.tool)
    if arm.tool.length_mm:
        corners.append(frame[:3, 3])
    return frames, frame, corners


def _moved(frame: casadi.SX, by: RigidTransform) -> casadi.SX:
    return frame if by.is_identity else frame @ casadi.sparsify(casadi.SX(by.matrix))


def _dh(theta: casadi.SX | float, d: casadi.SX | float, a_mm: float, alpha_rad: float) -> casadi.SX:
    rows = dh_entries(casadi.cos(theta), casadi.sin(theta), d, a_mm, alpha_rad)
    transform: casadi.SX = casadi.vertcat(*(casadi.horzcat(*row) for row in rows))
    return transform
