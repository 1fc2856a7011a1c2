"""Laws of the joints: rest at the ends, limits at and between samples, couplings.

A k-th finite difference over strides of m samples, divided by (m h)^k, is a mean of the k-th derivative over the k m
samples that it spans (h is the time between samples): a motion that keeps its limit cannot exceed it there. Each
position in a file is off by the half of its last decimal at most, r, so that the difference is off by the sum of the
binomial coefficients times r: that is allowed, and it weighs 1 / m^k as much. Over single samples it drowns
everything at high rates; so wider strides are tried as well, until rounding counts for little. Each stride is a
law of its own. A wide one sees only what lasts: a peak shorter than what it spans is averaged with what is around it,
and so is one that changes its sign.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.checking.between import POINTS_PER_STEP, Interpolation, cubic_error, positions_between
from planner.checking.check_result import Finding, Place
from planner.trajectory import TEST_MOTION, Trajectory

COUPLING_TOLERANCE = 1e-4
"""In deg or mm of the joint that is driven."""
EXACTNESS = 1e-5
"""Share of a limit by which it may be exceeded: what is planned up to a limit is so but for arithmetic."""
_NEGLIGIBLE = 2e-3
"""Share of a limit below which rounding is no reason for a wider stride."""


def columns(trajectory: Trajectory, arm: Arm) -> Finding:
    """Without the arm's joints in its columns, nothing else of a trajectory can be told."""
    if trajectory.columns == arm.column_names:
        return Finding("columns", True, remark=f"are the joints of {arm.name}")
    return Finding(
        "columns",
        False,
        remark=f"the file moves the joints {', '.join(trajectory.columns)}; "
        f"arm '{arm.name}' has {', '.join(arm.column_names)}",
    )


def rest_at_the_ends(trajectory: Trajectory, arm: Arm) -> list[Finding]:
    """At rest means velocity and acceleration zero; jerk alone then moves a joint J t^3 / 6 in the time t."""
    findings = []
    max_jerk = arm.to_file_units(trajectory.beyond_limits * arm.max_jerk)
    for check, end in (("starts at rest", slice(None)), ("ends at rest", slice(None, None, -1))):
        positions, rounding = trajectory.positions[end], trajectory.rounding[end]
        worst: tuple[float, int, int, float, float] | None = None
        for stride in _strides(trajectory.n_samples - 1):
            by_jerk = max_jerk * (stride / trajectory.rate_hz) ** 3 / 6
            limit = by_jerk * (1 + EXACTNESS) + rounding[0] + rounding[stride]
            moved = np.abs(positions[stride] - positions[0])
            joint = int(np.argmax(moved / limit))
            if worst is None or moved[joint] / limit[joint] > worst[0]:
                worst = float(moved[joint] / limit[joint]), joint, stride, float(moved[joint]), float(limit[joint])
            if np.all(limit - by_jerk <= _NEGLIGIBLE * by_jerk):
                break
        _, joint, stride, moved_by, most = worst or (0.0, 0, 0, 0.0, 0.0)
        remark = "in the step beside it" if stride < 2 else f"in the {stride} steps beside it"
        if moved_by > most and end.step:
            remark += " (is the file cut off?)"
        findings.append(
            _joint_finding(
                trajectory,
                arm,
                check,
                joint,
                moved_by,
                most,
                trajectory.n_samples - 1 if end.step else 0,
                remark=remark,
            )
        )
    return findings


def _strides(n_steps: int) -> Iterator[int]:
    """1, 2, 3, 4, 6, 8, 12, ... up to a number of steps."""
    power = 1
    while power <= n_steps:
        yield power
        if power >= 2 and 3 * power // 2 <= n_steps:
            yield 3 * power // 2
        power *= 2


def position_limits(trajectory: Trajectory, arm: Arm) -> list[Finding]:
    """Positions at samples (rounding allowed) and on the cubic between them (the error of the interpolation
    allowed as well): for each joint the position that is furthest towards a limit or beyond it."""
    low, high = arm.to_file_units(arm.minimum), arm.to_file_units(arm.maximum)
    rounding = trajectory.rounding.max(axis=0)
    interpolation_error = arm.to_file_units(
        cubic_error(trajectory.beyond_limits * arm.max_jerk, 1 / trajectory.rate_hz)
    )
    blocks = positions_between(trajectory.positions, Interpolation.CUBIC)
    findings = []
    for check, (positions, samples), allowance in (
        ("position", _outermost([trajectory.positions], 1, low, high), rounding),
        ("position between samples", _outermost(blocks, POINTS_PER_STEP, low, high), rounding + interpolation_error),
    ):
        excess = _beyond(positions, low, high)
        limits = np.where(2 * positions > low + high, high, low)
        findings += [
            _joint_finding(
                trajectory,
                arm,
                check,
                joint,
                float(positions[joint]),
                float(limits[joint]),
                int(samples[joint]),
                bool(excess[joint] <= allowance[joint]),
                f"within {low[joint]:g} and {high[joint]:g}",
                middle=float(low[joint] + high[joint]) / 2,
            )
            for joint in range(arm.n_joints)
        ]
    return findings


def _outermost(
    blocks: Iterable[FloatArray], points_per_sample: int, low: FloatArray, high: FloatArray
) -> tuple[FloatArray, IntArray]:
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
    """Velocity, acceleration and jerk by finite differences, a finding for each joint and each of them. A test motion
    may go as far beyond them as its header tells."""
    findings = []
    rounding = trajectory.rounding
    beyond = trajectory.beyond_limits
    on_purpose = f"which may be {beyond:g} times the arm's limit in this test motion" if beyond != 1.0 else ""
    for order, check, maximum in (
        (1, "velocity", beyond * arm.max_velocity),
        (2, "acceleration", beyond * arm.max_acceleration),
        (3, "jerk", beyond * arm.max_jerk),
    ):
        if trajectory.n_samples <= order:
            continue
        for joint, limit in enumerate(arm.to_file_units(maximum).tolist()):
            worst = _worst_difference(
                trajectory.positions[:, joint], rounding[:, joint], order, limit, trajectory.rate_hz
            )
            findings.append(
                _joint_finding(
                    trajectory,
                    arm,
                    check,
                    joint,
                    worst.figure,
                    worst.limit,
                    worst.sample,
                    remark=", ".join(
                        filter(
                            None,
                            (f"over {order * worst.stride} steps" if worst.stride > 1 else "", on_purpose),
                        )
                    ),
                    per="/s" + ("" if order == 1 else "²" if order == 2 else "³"),
                )
            )
    return findings


@dataclass(frozen=True, slots=True)
class _Difference:
    """A finite difference, what it may be, the sample amid it, and its stride."""

    figure: float
    limit: float
    sample: int
    stride: int


def _worst_difference(
    positions: FloatArray, rounding: FloatArray, order: int, limit: float, rate_hz: float
) -> _Difference:
    """The difference of one joint, over all strides, that is the largest share of what it may be."""
    worst = _Difference(0.0, limit, 0, 1)
    for stride in _strides((len(positions) - 1) // order):
        difference, allowance = positions, rounding
        for _ in range(order):
            difference = difference[stride:] - difference[:-stride]
            allowance = allowance[stride:] + allowance[:-stride]
        rate = (rate_hz / stride) ** order
        allowed = limit * (1 + EXACTNESS) + allowance * rate
        share = np.abs(difference) * rate / allowed
        index = int(np.argmax(share))
        if share[index] > worst.figure / worst.limit:
            worst = _Difference(
                float(np.abs(difference[index])) * rate, float(allowed[index]), index + -(-order * stride // 2), stride
            )
        if float(allowance.max()) * rate <= _NEGLIGIBLE * limit:
            break
    return worst


def couplings(trajectory: Trajectory, arm: Arm) -> list[Finding]:
    """How far each mimic joint is from what its coupling says. A finding a coupling; none of a test motion, which moves
    every joint by itself."""
    findings: list[Finding] = []
    if trajectory.method == TEST_MOTION:
        return findings
    positions = arm.from_file_units(trajectory.positions)
    for coupling in arm.couplings:
        wanted = coupling.constant + sum(
            coefficient * positions[:, other] for other, coefficient in coupling.coefficients
        )
        gap = np.abs(positions[:, coupling.joint] - wanted) / arm.joints[coupling.joint].per_file_unit
        sample = int(np.argmax(gap))
        findings.append(
            _joint_finding(trajectory, arm, "coupling", coupling.joint, float(gap[sample]), COUPLING_TOLERANCE, sample)
        )
    return findings


def _joint_finding(
    trajectory: Trajectory,
    arm: Arm,
    check: str,
    joint: int,
    worst: float,
    limit: float,
    sample: int,
    passed: bool | None = None,
    remark: str = "",
    per: str = "",
    middle: float = 0.0,
) -> Finding:
    """A finding on a joint; passed, unless said otherwise, where worst is at most the limit."""
    stroke = int(trajectory.stroke[sample])
    place = Place(
        sample / trajectory.rate_hz,
        sample,
        trajectory.line(sample),
        arm.joints[joint].name,
        stroke if stroke >= 0 else None,
    )
    return Finding(
        check,
        worst <= limit if passed is None else passed,
        worst,
        limit,
        arm.joints[joint].file_unit + per,
        place,
        remark,
        middle=middle,
    )
