"""The motion of an arm as a film shows it: which instants, and where the links are in them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray, IntArray
from planner.errors import UsageError
from planner.kinematics.frame_jacobian import chain_frames, joint_frames
from planner.plots.samples import window_s
from planner.trajectory import Trajectory

USUAL_FPS = 20.0
_USUAL_LENGTH_S = 20.0
_MOST_FRAMES = 200_000
_CELL_MM = 0.05
_LEVEL = 0.7
"""Cosine of the tilt up to which a paper lies rather than hangs."""
_BLOCK = 16_384


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """A part of a trajectory, played `speed_factor` times as fast as the arm moves.

    tip_mm: (n_samples, 3) at every sample of the trajectory.
    """

    trajectory: Trajectory
    arm: Arm
    tip_mm: FloatArray
    begin_s: float
    end_s: float
    speed_factor: float
    fps: float

    @property
    def times_s(self) -> FloatArray:
        """(n_frames,) the instant of the trajectory that each frame shows; the last is the end of the part."""
        step_s = self.speed_factor / self.fps
        n_steps = max(int(np.ceil((self.end_s - self.begin_s) / step_s - 1e-9)), 0)
        times: FloatArray = np.minimum(self.begin_s + step_s * np.arange(n_steps + 1), self.end_s)
        return times

    def last_samples(self, times_s: FloatArray) -> IntArray:
        """(n,) the sample at or before each time."""
        samples: IntArray = np.floor(times_s * self.trajectory.rate_hz + 1e-6).astype(np.int64)
        return np.minimum(samples, self.trajectory.n_samples - 1)

    def nodes_mm(self, times_s: FloatArray) -> FloatArray:
        """(n, n_nodes, 3) corners of the arm from the base to the tip, in the paper's frame. Joints move evenly between
        samples."""
        at = np.clip(times_s * self.trajectory.rate_hz, 0, self.trajectory.n_samples - 1)
        before = np.minimum(np.floor(at).astype(np.int64), max(self.trajectory.n_samples - 2, 0))
        after = np.minimum(before + 1, self.trajectory.n_samples - 1)
        share = (at - before)[:, np.newaxis]
        positions = self.trajectory.positions
        joints = self.arm.from_file_units((1 - share) * positions[before] + share * positions[after])
        nodes = np.concatenate(
            [arm_nodes(self.arm, joints[first : first + _BLOCK]) for first in range(0, len(joints), _BLOCK)]
        )
        if any(pen.height_mm for pen in self.trajectory.pens):  # whose tip is not where the last link ends
            nodes[:, -1] = (1 - share) * self.tip_mm[before] + share * self.tip_mm[after]
        return nodes

    def pen_lines(self, most: int) -> tuple[IntArray, IntArray]:
        """Samples that tell what the pen draws until the end of this part, and which begin a line, both (k,).

        Those between, less than a twentieth of a millimetre further on, are left out, or less than what leaves some
        `most` of them. A tap is a line of one sample.
        """
        trajectory = self.trajectory
        (last,) = self.last_samples(np.array([self.end_s]))
        down = np.flatnonzero(trajectory.pen[: last + 1])
        begins = np.ones(len(down), dtype=np.bool_)
        begins[1:] = (np.diff(down) > 1) | (np.diff(trajectory.stroke[down]) != 0)
        finishes = np.append(begins[1:], True)[: len(down)]
        steps_mm = np.linalg.norm(np.diff(self.tip_mm[down, :2], axis=0, prepend=self.tip_mm[down[:1], :2]), axis=1)
        way_mm = np.cumsum(steps_mm)
        cell = np.floor(way_mm / max(_CELL_MM, float(way_mm[-1]) / most if len(way_mm) else 0.0))
        kept = begins | finishes | (np.diff(cell, prepend=-1.0) > 0)
        return down[kept], begins[kept].astype(np.int64)


def motion_of(
    trajectory: Trajectory,
    arm: Arm,
    tip_mm: FloatArray,
    *,
    speed_factor: float | None = None,
    fps: float | None = None,
    from_s: float | None = None,
    to_s: float | None = None,
) -> Motion:
    """The part between two times. speed_factor: None for as fast as the arm, or what makes it last 20 s if that is
    faster. fps: frames per second, 20 unless given.

    Errors: UsageError where there is nothing in that part, or too much for a film.
    """
    begin_s, end_s = window_s(trajectory, from_s, to_s)
    motion = Motion(
        trajectory,
        arm,
        tip_mm,
        begin_s,
        end_s,
        speed_factor or max((end_s - begin_s) / _USUAL_LENGTH_S, 1.0),
        fps or USUAL_FPS,
    )
    n_frames = (end_s - begin_s) * motion.fps / motion.speed_factor
    if n_frames > _MOST_FRAMES:
        raise UsageError(
            f"a film of {n_frames:.0f} pictures; choose a greater --speed-factor, fewer --fps or a part (--from, --to)"
        )
    return motion


def is_seen_square_on(arm: Arm) -> bool:
    """Whether a view from the side turns with the arm: about its base, where the paper lies level."""
    return bool(arm.paper.normal[2] > _LEVEL)


def seen_from_the_side(arm: Arm, nodes_mm: FloatArray) -> FloatArray:
    """(n, n_nodes, 2) distance from the base and height over the paper of nodes (n, n_nodes, 3), the first of which is
    the base: along the bearing of the tip, so that an arm that turns about its base is seen square on, and along x of
    the paper where that is a board or a ceiling."""
    from_base = nodes_mm[..., :2] - nodes_mm[:, :1, :2]
    turns = float(is_seen_square_on(arm))
    bearing = turns * np.arctan2(from_base[:, -1, 1], from_base[:, -1, 0])[:, np.newaxis]
    along = from_base[..., 0] * np.cos(bearing) + from_base[..., 1] * np.sin(bearing)
    seen: FloatArray = np.stack((along, nodes_mm[..., 2]), axis=-1)
    return seen


def arm_nodes(arm: Arm, joints: FloatArray) -> FloatArray:
    """(n, n_nodes, 3) in the paper's frame: the base, and for each joint its origin, where its axis takes it and
    where its link ends, then the tip, of all those that ever differ from the one before. A pen that is held along
    the last joint's axis comes after that joint's link, so that it is what comes down to the paper."""
    frames = chain_frames(arm, joints)
    moving = joint_frames(arm, frames)
    nodes = [frames[:, 0, :3, 3]]
    for index, part in _links(arm):
        joint = arm.joints[index]
        slides = joint.kind is JointKind.PRISMATIC
        if part is _Part.ORIGIN:
            nodes.append(moving[:, index, :3, 3])
        elif part is _Part.TOOL:
            nodes.append(frames[:, -1, :3, 3])
        elif part is _Part.D:
            travel = joint.d_mm + (joints[:, index, np.newaxis] if slides else 0.0)
            nodes.append(nodes[-1] + travel * moving[:, index, :3, 2])
        else:
            turn = joint.theta_rad + (0.0 if slides else joints[:, index, np.newaxis])
            along = np.cos(turn) * moving[:, index, :3, 0] + np.sin(turn) * moving[:, index, :3, 1]
            nodes.append(nodes[-1] + joint.a_mm * along)
    T_paper_base = arm.paper.T_paper_base
    seen: FloatArray = np.stack(nodes, axis=1) @ T_paper_base[:3, :3].T + T_paper_base[:3, 3]
    return seen


def link_thicknesses_mm(arm: Arm) -> list[float | None]:
    """Of what lies between each two of `arm_nodes`; None where the arm's file does not say."""
    return [
        None if part is _Part.TOOL else arm.joints[max(index - (part is _Part.ORIGIN), 0)].thickness_mm
        for index, part in _links(arm)
    ]


class _Part(Enum):
    """Of a chain: on to the origin of a joint, along d and along a of its row, and on to the tip."""

    ORIGIN, D, A, TOOL = range(4)


def _links(arm: Arm) -> list[tuple[int, _Part]]:
    """The parts that lead from each of `arm_nodes` to the next, each with its joint."""
    links: list[tuple[int, _Part]] = []
    for index, joint in enumerate(arm.joints):
        d = [_Part.D] if joint.kind is JointKind.PRISMATIC or joint.d_mm else []
        a = [_Part.A] if joint.a_mm else []
        row = [*a, *d] if index == arm.n_joints - 1 and _pen_is_along_last_axis(arm) else [*d, *a]
        links += [(index, part) for part in ([_Part.ORIGIN] if joint.origin.length_mm else []) + row]
    if arm.tool.length_mm:
        links.append((arm.n_joints - 1, _Part.TOOL))
    return links


def _pen_is_along_last_axis(arm: Arm) -> bool:
    """Rather than along the link of that joint."""
    along_x, along_y, along_z = arm.pen.tool_axis
    alpha_rad = arm.joints[-1].alpha_rad
    along_axis = along_y * np.sin(alpha_rad) + along_z * np.cos(alpha_rad)
    return arm.tool.is_identity and bool(abs(along_axis) > abs(along_x))
