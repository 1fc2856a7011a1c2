"""The shapes in which chains lose a freedom, told from where the axes of the joints lie.

Axes that coincide (the wrist), a point of the pen's own on the first axis (the waist turns it in vain), a slide that
a joint has laid along the first axis (the shoulder), and two links in line, stretched or folded (the elbow).
"""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray
from planner.kinematics.frame_jacobian import chain_frames, joint_frames

_TOLERANCE = 1e-6
"""Of the arm's length, and of a radian."""


def singular_shapes(arm: Arm, joints: FloatArray) -> list[str]:
    """Sentences that name the shapes a configuration (n_joints,), rad or mm, has; none where it has none of them."""
    frames = chain_frames(arm, joints[None])
    moving = joint_frames(arm, frames)[0]
    axes, origins = moving[:, :3, 2], np.vstack((moving[:, :3, 3], frames[0, -1:, :3, 3]))  # the last one is the tip
    slack_mm = _TOLERANCE * float(np.linalg.norm(np.diff(origins, axis=0), axis=1).sum())
    turning = [index for index, joint in enumerate(arm.joints) if joint.kind is JointKind.REVOLUTE]
    names = [joint.name for joint in arm.joints]
    shapes = [
        f"the axes of {names[i]} and {names[j]} coincide"
        for i, j in combinations(turning, 2)
        if _parallel(axes[i], axes[j]) and _from_axis(origins[j], origins[i], axes[i]) <= slack_mm
    ]
    if turning[:1] == [0]:
        centre = _wrist_centre(axes, origins, turning, slack_mm)
        points = {"the tip": origins[-1]} | ({} if centre is None else {"the centre of the wrist": centre})
        shapes += [
            f"{point} is on the axis of {names[0]}"
            for point, place in points.items()
            if _from_axis(place, origins[0], axes[0]) <= slack_mm
        ]
        shapes += [
            f"the slide of {joint.name} is parallel to the axis of {names[0]}"
            for index, joint in enumerate(arm.joints)
            if joint.kind is JointKind.PRISMATIC
            and _parallel(axes[index], axes[0])
            and not all(_parallel(axes[before], axes[0]) for before in turning if before < index)
        ]
    for i, j in pairwise(turning):
        if not _parallel(axes[i], axes[j]):
            continue
        beyond = [place for place in origins[j + 1 :] if _from_axis(place, origins[j], axes[j]) > slack_mm]
        first = _across(origins[j] - origins[i], axes[i])
        if beyond and np.linalg.norm(first) > slack_mm:
            second = _across(beyond[0] - origins[j], axes[i])
            if np.linalg.norm(np.cross(first, second)) <= slack_mm * max(map(np.linalg.norm, (first, second))):
                shapes.append(
                    f"the links before and after {names[j]} are "
                    f"{'stretched out' if first @ second > 0 else 'folded onto each other'}"
                )
    return shapes


def _parallel(one: FloatArray, other: FloatArray) -> bool:
    return float(np.linalg.norm(np.cross(one, other))) <= _TOLERANCE


def _across(vector: FloatArray, axis: FloatArray) -> FloatArray:
    """The part of a vector at right angles to an axis."""
    part: FloatArray = vector - (vector @ axis) * axis
    return part


def _from_axis(point: FloatArray, origin: FloatArray, axis: FloatArray) -> float:
    return float(np.linalg.norm(_across(point - origin, axis)))


def _wrist_centre(axes: FloatArray, origins: FloatArray, turning: list[int], slack_mm: float) -> FloatArray | None:
    """Where the last three axes meet, if they turn and do, and others come before them."""
    n = len(axes)
    if n < 5 or turning[-3:] != [n - 3, n - 2, n - 1]:
        return None
    # The point that is nearest to all three of them: p with sum of (1 - z z^T)(p - o) = 0.
    across = np.eye(3) - axes[-3:, :, None] * axes[-3:, None, :]
    centre: FloatArray = np.linalg.lstsq(across.sum(axis=0), np.einsum("kij,kj->i", across, origins[n - 3 : n]))[0]
    meet = all(_from_axis(centre, origins[index], axes[index]) <= slack_mm for index in turning[-3:])
    return centre if meet else None
