"""Laws of the joints: rest at the ends, limits at and between samples, couplings.

Positions in a file are rounded to six decimals or more, by r = 5e-7 of its units at most. A k-th finite
difference times rate^k is an average of the k-th derivative over its samples, so a motion that keeps its
limit cannot exceed it there; rounding adds 2^k r rate^k at most, and that alone is allowed.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.checking.between import POINTS_PER_STEP, Interpolation, cubic_error, positions_between
from planner.checking.verdict import Finding, Place
from planner.trajectory import Trajectory

ROUNDING = 5e-7
COUPLING_TOLERANCE_DEG = 1e-4


def rest_at_the_ends(trajectory: Trajectory, arm: Arm) -> list[Finding]:
    """At rest means velocity and acceleration zero; jerk alone then moves a joint J h^3 / 6 in one step."""
    findings = []
    limit = arm.to_file_units(arm.max_jerk) / trajectory.rate_hz**3 / 6 + 2 * ROUNDING
    last = trajectory.n_samples - 1
    for check, sample, other in (("starts at rest", 0, min(1, last)), ("ends at rest", last, max(last - 1, 0))):
        step = np.abs(trajectory.positions[sample] - trajectory.positions[other])
        joint = int(np.argmax(step / limit))
        findings.append(_joint_finding(
            trajectory, arm, check, joint, float(step[joint]), float(limit[joint]), sample,
            remark="in the step beside it"))
    return findings


def position_limits(trajectory: Trajectory, arm: Arm) -> list[Finding]:
    """Positions at samples (rounding allowed) and on the cubic between them (the error of the interpolation
    allowed as well): for each joint the position that is furthest towards a limit or beyond it."""
    low, high = arm.to_file_units(arm.minimum), arm.to_file_units(arm.maximum)
    interpolation_error = arm.to_file_units(cubic_error(arm.max_jerk, 1 / trajectory.rate_hz))
    blocks = positions_between(trajectory.positions, Interpolation.CUBIC)
    findings = []
    for check, (positions, samples), allowance in (
        ("position", _outermost([trajectory.positions], 1, low, high), np.full(arm.n_joints, ROUNDING)),
        ("position between samples", _outermost(blocks, POINTS_PER_STEP, low, high), ROUNDING + interpolation_error),
    ):
        excess = _beyond(positions, low, high)
        limits = np.where(2 * positions > low + high, high, low)
        findings += [
            _joint_finding(trajectory, arm, check, joint, float(positions[joint]), float(limits[joint]),
                           int(samples[joint]), bool(excess[joint] <= allowance[joint]),
                           f"within {low[joint]:g} and {high[joint]:g}")
            for joint in range(arm.n_joints)]
    return findings


def _outermost(blocks: Iterable[FloatArray], points_per_sample: int, low: FloatArray,
               high: FloatArray) -> tuple[FloatArray, IntArray]:
    """(n_joints,) the position of each joint that is furthest out, and the sample at or before it."""
    positions, points = np.zeros(len(low)), np.zeros(len(low), dtype=np.int64)
    worst = np.full(len(low), -np.inf)
    joints, start = np.arange(len(low)), 0
    for block in blocks:
        excess = _beyond(block, low, high)
        row = np.argmax(excess, axis=0)
        further = excess[row, joints] > worst
        worst[further] = excess[row, joints][further]
        positions[further] = block[row, joints][further]
        points[further] = start + row[further]
        start += len(block)
    return positions, points // points_per_sample


def _beyond(positions: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    excess: FloatArray = np.maximum(positions - high, low - positions)
    return excess


def rate_limits(trajectory: Trajectory, arm: Arm) -> list[Finding]:
    """Velocity, acceleration and jerk by finite differences, a finding for each joint and each of them."""
    findings = []
    for order, check, maximum in (
        (1, "velocity", arm.max_velocity), (2, "acceleration", arm.max_acceleration), (3, "jerk", arm.max_jerk)):
        if trajectory.n_samples <= order:
            continue
        rate = trajectory.rate_hz**order
        derivative = np.abs(np.diff(trajectory.positions, n=order, axis=0)) * rate
        limit = arm.to_file_units(maximum) + 2**order * ROUNDING * rate
        for joint in range(arm.n_joints):
            sample = int(np.argmax(derivative[:, joint]))
            findings.append(_joint_finding(
                trajectory, arm, check, joint, float(derivative[sample, joint]), float(limit[joint]), sample,
                per="/s" + ("" if order == 1 else "²" if order == 2 else "³")))
    return findings


def couplings(trajectory: Trajectory, arm: Arm) -> list[Finding]:
    """How far each driven joint is from what its coupling says. A finding a coupling."""
    findings = []
    positions = arm.from_file_units(trajectory.positions)
    for coupling in arm.couplings:
        wanted = coupling.constant_rad + sum(
            coefficient * positions[:, other] for other, coefficient in coupling.coefficients)
        gap_deg = np.degrees(np.abs(positions[:, coupling.joint] - wanted))
        sample = int(np.argmax(gap_deg))
        findings.append(_joint_finding(
            trajectory, arm, "coupling", coupling.joint, float(gap_deg[sample]), COUPLING_TOLERANCE_DEG, sample))
    return findings


def _joint_finding(trajectory: Trajectory, arm: Arm, check: str, joint: int, worst: float, limit: float, sample: int,
                   passed: bool | None = None, remark: str = "", per: str = "") -> Finding:
    """A finding on a joint; passed, unless said otherwise, where worst is at most the limit."""
    stroke = int(trajectory.stroke[sample])
    place = Place(sample / trajectory.rate_hz, sample, trajectory.line(sample), arm.joints[joint].name,
                  stroke if stroke >= 0 else None)
    return Finding(check, worst <= limit if passed is None else passed, worst, limit,
                   arm.joints[joint].file_unit + per, place, remark)
