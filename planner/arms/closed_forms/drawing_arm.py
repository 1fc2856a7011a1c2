"""Closed form of the drawing arm: a turning base, three parallel joints, and a link that hangs upright.

With the pen vertical the end of link 4 is right above the tip, so given the pitch phi = q2 + q3 + q4 of link 4
the end of link 3 is known and q2, q3 follow from a triangle, elbow up or down. The pitch is the
arm's redundancy (documents on the drawing arm, inverse kinematics; here with a lateral offset of the pen).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial import Chebyshev

from planner.arms.arm import Arm, JointKind
from planner.arrays import BoolArray, FloatArray
from planner.errors import PlanError

_PITCHES = np.radians(np.linspace(-180, 180, 721))
_RADII = 120
_DEGREE = 8


def fits(arm: Arm) -> bool:
    """Whether the chain is of this family: five turning joints with DH rows (L1, 0, 90 degrees), then links in
    one plane, and the last held upright by q5 = -90 degrees - q2 - q3 - q4."""
    rows = np.array([(joint.theta_rad, joint.alpha_rad) for joint in arm.joints])
    expected = np.zeros_like(rows)
    expected[0, 1] = np.pi / 2
    if arm.n_joints != 5 or any(joint.kind is not JointKind.REVOLUTE for joint in arm.joints):
        return False
    if arm.joints[0].a_mm != 0.0 or not np.allclose(rows, expected, rtol=0.0, atol=1e-12):
        return False
    if arm.free_joints != (0, 1, 2, 3):
        return False
    matrix, constant = arm.coupling_matrix
    return bool(np.allclose(matrix[4], [0, -1, -1, -1]) and np.isclose(constant[4], -np.pi / 2))


def postures(arm: Arm, tip_mm: FloatArray, pitch_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Both postures for each tip and pitch, and how far beyond reach each is.

    tip_mm: (n, 3); pitch_rad: (n,). Returns free joints (n, 2, 4), elbow up (q3 < 0) first, and gaps (n,) in
    mm: 0 where the triangle closes, else the length that is missing; NaN postures there.
    """
    base, upper, fore, wrist, pen = arm.joints
    x, y, z = tip_mm.T
    offset = sum(joint.d_mm for joint in arm.joints[1:])
    radial_squared = x * x + y * y - offset * offset
    inside = np.sqrt(np.maximum(radial_squared, 0.0))
    q1 = np.arctan2(y, x) + np.arctan2(offset, inside)
    along = inside - wrist.a_mm * np.cos(pitch_rad)
    up = z + pen.a_mm - base.d_mm - wrist.a_mm * np.sin(pitch_rad)
    squared = along * along + up * up
    cosine = (squared - upper.a_mm ** 2 - fore.a_mm ** 2) / (2 * upper.a_mm * fore.a_mm)
    distance = np.sqrt(squared)
    gap = np.maximum(distance - (upper.a_mm + fore.a_mm), abs(upper.a_mm - fore.a_mm) - distance)
    gap = np.maximum(gap, np.where(radial_squared < 0, abs(offset) - np.hypot(x, y), 0.0))
    bend = np.arccos(np.clip(cosine, -1.0, 1.0))
    solutions = np.empty((len(tip_mm), 2, 4))
    for k, q3 in enumerate((-bend, bend)):
        q2 = np.arctan2(up, along) - np.arctan2(fore.a_mm * np.sin(q3), upper.a_mm + fore.a_mm * np.cos(q3))
        solutions[:, k] = np.column_stack((q1, q2, q3, pitch_rad - q2 - q3))
    # Angles near the limits' middle, rather than a turn away from it.
    middle = ((arm.minimum + arm.maximum) / 2)[:4]
    solutions = middle + (solutions - middle + np.pi) % (2 * np.pi) - np.pi
    beyond = gap > 1e-9
    solutions[beyond] = np.nan
    return solutions, np.where(beyond, gap, 0.0)


def centred_postures(arm: Arm, tip_mm: FloatArray) -> FloatArray:
    """(n, 4) postures whose pitch lies midway between the joint limits at each tip's radius."""
    elbow, pitch = _centred_pitch(arm)
    found, _ = postures(arm, tip_mm, pitch(np.hypot(tip_mm[:, 0], tip_mm[:, 1])))
    return found[:, elbow]


@lru_cache(maxsize=16)
def _centred_pitch(arm: Arm) -> tuple[int, Chebyshev]:
    """The elbow with the wider choice, and the pitch as a smooth function of the radius on the paper: a
    polynomial through the middle of the pitches that the joint limits allow."""
    reach = sum(joint.a_mm for joint in arm.joints)
    radii = np.linspace(arm.workspace.inner_radius_mm, reach, _RADII)
    tips = np.zeros((len(radii) * len(_PITCHES), 3))
    tips[:, 0] = np.repeat(radii, len(_PITCHES))
    found, _ = postures(arm, tips, np.tile(_PITCHES, len(radii)))
    joints = arm.complete(found)
    with np.errstate(invalid="ignore"):
        allowed = ((joints >= arm.minimum) & (joints <= arm.maximum))[..., 1:].all(axis=-1)
    allowed = allowed.reshape(len(radii), len(_PITCHES), 2)
    elbow = int(allowed.sum(axis=(0, 1)).argmax())
    windows = [_widest_run(row) for row in allowed[:, :, elbow]]
    reached = np.array([window is not None for window in windows])
    if reached.sum() <= _DEGREE:
        raise PlanError(f"arm {arm.name}: the closed form finds no posture within the joint limits on the paper")
    middles = np.array([0.5 * (_PITCHES[window[0]] + _PITCHES[window[1]]) for window in windows if window])
    return elbow, Chebyshev.fit(radii[reached], middles, _DEGREE)


def _widest_run(allowed: BoolArray) -> tuple[int, int] | None:
    """First and last index of the longest run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], allowed.astype(np.int8), [0]))))
    if not len(edges):
        return None
    starts, ends = edges[0::2], edges[1::2] - 1
    longest = int((ends - starts).argmax())
    return int(starts[longest]), int(ends[longest])
