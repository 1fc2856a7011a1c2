"""Laws of the joints: rest at the ends, limits at and between samples, couplings.

Positions in a file are rounded to six decimals or more, by r = 5e-7 of its units at most. A k-th finite
difference times rate^k is an average of the k-th derivative over its samples, so a motion that keeps its
limit cannot exceed it there; rounding adds 2^k r rate^k at most, and that alone is allowed.
"""

from __future__ import annotations

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
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
            trajectory, arm, check, joint, float(step[joint]), float(limit[joint]), sample, "in the step beside it"))
    return findings


def position_limits(trajectory: Trajectory, arm: Arm) -> list[Finding]:
    """Positions beyond their limits at samples (rounding allowed) and on the cubic between them (the
    error of the interpolation allowed), a finding a joint: how far beyond, negative inside."""
    low, high = arm.to_file_units(arm.minimum), arm.to_file_units(arm.maximum)
    allowance = arm.to_file_units(cubic_error(arm.max_jerk, 1 / trajectory.rate_hz)) + ROUNDING
    beyond = _beyond(trajectory.positions, low, high)
    findings = []
    at_sample = np.argmax(beyond, axis=0)
    between, between_step = np.full(arm.n_joints, -np.inf), np.zeros(arm.n_joints, dtype=np.int64)
    start = 0
    for block in positions_between(trajectory.positions, Interpolation.CUBIC):
        excess = _beyond(block, low, high)
        place = np.argmax(excess, axis=0)
        worst = np.take_along_axis(excess, place[np.newaxis], axis=0)[0]
        further = worst > between
        between[further] = worst[further]
        between_step[further] = (start + place[further]) // POINTS_PER_STEP
        start += len(block)
    for joint in range(arm.n_joints):
        sample = int(at_sample[joint])
        findings.append(_joint_finding(
            trajectory, arm, "position", joint, float(beyond[sample, joint]), ROUNDING, sample,
            f"beyond its limits {low[joint]:g} and {high[joint]:g}"))
        if beyond[sample, joint] <= ROUNDING and between[joint] > allowance[joint]:
            findings.append(_joint_finding(
                trajectory, arm, "position between samples", joint, float(between[joint]), float(allowance[joint]),
                int(between_step[joint]), f"beyond its limits {low[joint]:g} and {high[joint]:g}"))
    return findings


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
                "", "/s" + ("" if order == 1 else "²" if order == 2 else "³")))
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
                   remark: str = "", per: str = "") -> Finding:
    stroke = int(trajectory.stroke[sample])
    place = Place(sample / trajectory.rate_hz, sample, trajectory.line(sample), arm.joints[joint].name,
                  stroke if stroke >= 0 else None)
    return Finding(check, worst <= limit, worst, limit, arm.joints[joint].file_unit + per, place, remark)
