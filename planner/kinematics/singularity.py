"""What an arm's Jacobian says of a configuration: how freely it moves, and what it cannot do there.

A motion of the joints in the null space of J is internal: the frame rests. A velocity in the null space of
its transpose is impossible, however the joints move. Rank is judged with lengths in units of the
arm's own, so that millimetres and radians weigh alike.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray
from planner.kinematics.frame_jacobian import chain_frames, frame_jacobian

ROW_NAMES = ("vx", "vy", "vz", "wx", "wy", "wz")
RANK_TOLERANCE = 1e-7
"""Singular values below this times the greatest one count as zero: configurations come with six decimals of a
degree."""

_PROBES = 32


@dataclass(frozen=True, eq=False, slots=True)
class Mobility:
    """What a chain can do at all with one of its frames, whatever the configuration.

    rows: indices in 0..5 of the velocity components that tell all of it: the linear ones alone where turning
    adds nothing of its own, else all that are not always zero. freedom: how many independent ones there are.
    length_mm: the arm's own unit of length.
    """

    rows: tuple[int, ...]
    freedom: int
    length_mm: float


@dataclass(frozen=True, eq=False, slots=True)
class Singularity:
    """The Jacobian of one configuration and its null spaces.

    jacobian: (6, n_joints), mm and rad per rad or mm, all joints independent. singular_values: (freedom,) of
    the rows of `mobility` over the independent joints, lengths in units of the arm's. manipulability: sqrt(det(J J^T))
    over the same rows, in mm and rad. internal: (k, n_joints) motions of the joints that leave these rows at rest,
    couplings kept, rad or mm. impossible: (m, rows) velocities that cannot be, mm and rad; m is
    rows - rank, of which rows - freedom are so in every configuration. The largest entry of each is 1 in either.
    """

    jacobian: FloatArray
    mobility: Mobility
    singular_values: FloatArray
    manipulability: float
    rank: int
    internal: FloatArray
    impossible: FloatArray

    @property
    def is_singular(self) -> bool:
        return self.rank < self.mobility.freedom

    @property
    def condition(self) -> float:
        """Greatest over smallest singular value, infinite at a singular configuration."""
        return np.inf if self.is_singular else float(self.singular_values[0] / self.singular_values[-1])


def mobility(arm: Arm, of_frame: int | None = None, in_frame: int = 0) -> Mobility:
    """What the arm can do with frame `of_frame` seen from frame `in_frame`, from configurations drawn at random.

    Errors: UsageError where the chain has no such frame.
    """
    random = np.random.default_rng(0)
    joints = arm.complete(random.uniform(-np.pi, np.pi, (_PROBES, len(arm.independent_joints))))
    sliding = [joint.kind is JointKind.PRISMATIC for joint in arm.joints]
    joints[:, sliding] = random.uniform(arm.minimum[sliding], arm.maximum[sliding], (_PROBES, sum(sliding)))
    frames = chain_frames(arm, joints)
    length_mm = float(np.linalg.norm(np.diff(frames[:, :, :3, 3], axis=1), axis=2).sum(axis=1).mean()) or 1.0
    scaled = _scaled(arm, _independent(arm, frame_jacobian(arm, joints, of_frame, in_frame)), length_mm, range(6))

    def freedom(rows: tuple[int, ...]) -> int:
        return int(np.linalg.matrix_rank(scaled[:, rows], tol=RANK_TOLERANCE).max()) if rows else 0

    linear, present = (
        [row for row in rows if np.abs(scaled[:, row]).max(initial=0.0) > RANK_TOLERANCE]
        for rows in (range(3), range(6))
    )
    total = freedom(tuple(present))
    return Mobility(tuple(linear if freedom(tuple(linear)) == total else present), total, length_mm)


def manipulability(arm: Arm, joints: FloatArray, of_frame: int | None = None, in_frame: int = 0) -> FloatArray:
    """(n,) sqrt(det(J J^T)) of configurations (n, n_joints), over the arm's rows and independent joints, in mm and rad.

    Where the rows are more than the arm's freedom, the product of as many singular values as it has
    (Yoshikawa, "Manipulability of robotic mechanisms", 1985).
    """
    able = mobility(arm, of_frame, in_frame)
    rows = _independent(arm, frame_jacobian(arm, joints, of_frame, in_frame))[:, able.rows]
    return _volume(rows, able.freedom)


def singularity(arm: Arm, joints: FloatArray, of_frame: int | None = None, in_frame: int = 0) -> Singularity:
    """The analysis of one configuration (n_joints,), rad or mm, for one frame seen from another.

    Errors: UsageError where the chain has no such frame.
    """
    able = mobility(arm, of_frame, in_frame)
    jacobian = frame_jacobian(arm, joints[None], of_frame, in_frame)
    independent = _independent(arm, jacobian)
    left, values, right = np.linalg.svd(_scaled(arm, independent, able.length_mm, able.rows)[0])
    rank = int((values > RANK_TOLERANCE * values.max(initial=1e-300)).sum())
    matrix, _ = arm.coupling_matrix
    of_row, of_joint = _weights(arm, able.length_mm)
    return Singularity(
        jacobian=jacobian[0],
        mobility=able,
        singular_values=values[: able.freedom],
        rank=rank,
        manipulability=float(_volume(independent[:, able.rows], able.freedom)[0]),
        internal=_to_one((_readable(right[rank:]) * of_joint) @ matrix.T),
        impossible=_to_one(_readable(left[:, rank:].T) * of_row[list(able.rows)]),
    )


def _independent(arm: Arm, jacobian: FloatArray) -> FloatArray:
    """(n, 6, n_independent) velocities by the independent joints, the mimic ones following."""
    matrix, _ = arm.coupling_matrix
    independent: FloatArray = jacobian @ matrix
    return independent


def _weights(arm: Arm, length_mm: float) -> tuple[FloatArray, FloatArray]:
    """What rows (6,) and independent joints (n_independent,) are multiplied by for lengths in units of the arm's."""
    kinds = [arm.joints[index].kind for index in arm.independent_joints]
    return (
        np.array([1 / length_mm] * 3 + [1.0] * 3),
        np.array([length_mm if kind is JointKind.PRISMATIC else 1.0 for kind in kinds]),
    )


def _scaled(arm: Arm, independent: FloatArray, length_mm: float, rows: range | tuple[int, ...]) -> FloatArray:
    """(n, rows, n_independent) without units."""
    of_row, of_joint = _weights(arm, length_mm)
    chosen = list(rows)
    scaled: FloatArray = of_row[chosen, None] * independent[:, chosen] * of_joint
    return scaled


def _volume(rows: FloatArray, freedom: int) -> FloatArray:
    values = np.linalg.svd(rows, compute_uv=False)
    volume: FloatArray = np.prod(values[:, :freedom], axis=1)
    return volume


def _readable(basis: FloatArray) -> FloatArray:
    """Another basis (k, m) of the same space with as many zeros as elimination gives: a joint that moves for
    itself is a vector for itself."""
    reduced = basis.copy()
    for row in range(len(reduced)):
        block = np.abs(reduced[row:])
        best, column = np.unravel_index(int(block.argmax()), block.shape)
        reduced[[row, row + int(best)]] = reduced[[row + int(best), row]]
        reduced[row] /= reduced[row, column]
        others = np.arange(len(reduced)) != row
        reduced[others] -= reduced[others, column][:, None] * reduced[row]
    reduced[np.abs(reduced) < RANK_TOLERANCE] = 0.0
    return reduced


def _to_one(vectors: FloatArray) -> FloatArray:
    """Each vector scaled so that its largest entry is 1."""
    if not vectors.size:
        return vectors
    peak = np.take_along_axis(vectors, np.abs(vectors).argmax(axis=1)[:, None], axis=1)
    scaled: FloatArray = vectors / peak + 0.0
    return scaled
