"""From what a method found to the figures it is compared by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import FloatArray, IntArray
from planner.comparison.measured import Measured
from planner.comparison.targets import TargetKind, Targets
from planner.kinematics.sensitivity import sideways_error
from planner.kinematics.singularity import manipulability

LIMIT_SLACK = 1e-9
"""rad or mm: rounding that is forgiven at a joint limit."""

_ByUnit = tuple[float | None, float | None]


@dataclass(frozen=True, slots=True)
class Figures:
    """Of all targets: solved_share, usable_share (solved within the joint limits), and iterations. Of those that
    are solved: all others. None where a figure means nothing, or there is nothing to tell it of.

    outside_share: with a joint beyond its limits; excess: how far at worst, and excess_joint, which. step: largest
    change of a joint from a target to its neighbour. roughness: second difference of the joints over the square of the
    targets' distance, rms. sideways: error along the paper per degree (or mm) of error of the joints, rms over
    them. repeat: largest change of a joint where the same target is visited again (`Targets.backwards`).
    drawing_s: pen-down time of the strokes that are not refused; drawing_common_s: of those that no method refuses.
    ruckig_common_s: of the same, from target to target by Ruckig; None where one cannot be drawn so.
    Of revolute joints in degrees, of sliding ones in mm.
    """

    solved_share: float | None = None
    usable_share: float | None = None
    iterations: float | None = None
    iterations_max: int | None = None
    cold_ms: float | None = None
    warm_us: float | None = None
    error_mean_mm: float | None = None
    error_max_mm: float | None = None
    outside_share: float | None = None
    excess_joint: str | None = None
    excess_deg: float | None = None
    excess_mm: float | None = None
    step_deg: float | None = None
    step_mm: float | None = None
    roughness_deg_mm2: float | None = None
    roughness_mm_mm2: float | None = None
    manipulability_mean: float | None = None
    manipulability_min: float | None = None
    sideways_mean_mm: float | None = None
    sideways_max_mm: float | None = None
    repeat_deg: float | None = None
    repeat_mm: float | None = None
    strokes_refused: int | None = None
    drawing_s: float | None = None
    drawing_common_s: float | None = None
    ruckig_common_s: float | None = None


def figures_of(arm: Arm, targets: Targets, found: Measured, *, iterates: bool) -> Figures:
    """All figures but those of the timing of strokes."""
    solved = found.solved
    joints, error = found.joints[solved], found.error_mm[solved]
    excess = beyond_limits(arm, joints)
    outside = (excess > LIMIT_SLACK).any(axis=1)
    some = bool(solved.any())
    worst = int(np.argmax((excess / (arm.maximum - arm.minimum)).max(axis=0, initial=-np.inf)))
    excess_deg, excess_mm = _by_unit(arm, np.maximum(excess, 0.0), np.max)
    step: _ByUnit = (None, None)
    roughness: _ByUnit = (None, None)
    repeat: _ByUnit = (None, None)
    if targets.kind is TargetKind.DRAWING:
        step = _by_unit(arm, np.abs(_steps(targets, found)), np.max)
        roughness = _by_unit(arm, _second_derivatives(targets, found), _rms)
    if targets.kind is not TargetKind.SINGLE:
        both = solved & found.solved_again
        repeat = _by_unit(arm, np.abs(found.joints[both] - found.again[both]), np.max)
    ease, sideways = manipulability(arm, joints), sideways_error(arm, joints)
    return Figures(
        solved_share=float(solved.mean()),
        usable_share=float((~outside).sum() / len(solved)),
        iterations=float(found.iterations.mean()) if iterates else None,
        iterations_max=int(found.iterations.max()) if iterates else None,
        cold_ms=1e3 * found.cold_s,
        warm_us=1e6 * found.warm_s,
        error_mean_mm=_of(error, np.mean),
        error_max_mm=_of(error, np.max),
        outside_share=float(outside.mean()) if some else None,
        excess_joint=arm.joints[worst].name if outside.any() else None,
        excess_deg=excess_deg,
        excess_mm=excess_mm,
        step_deg=step[0],
        step_mm=step[1],
        roughness_deg_mm2=roughness[0],
        roughness_mm_mm2=roughness[1],
        manipulability_mean=_of(ease, np.mean),
        manipulability_min=_of(ease, np.min),
        sideways_mean_mm=_of(sideways, np.mean),
        sideways_max_mm=_of(sideways, np.max),
        repeat_deg=repeat[0],
        repeat_mm=repeat[1],
    )


def beyond_limits(arm: Arm, joints: FloatArray) -> FloatArray:
    """(n, n_joints) how far each joint is beyond its nearer limit, rad or mm; negative within."""
    beyond: FloatArray = np.maximum(arm.minimum - joints, joints - arm.maximum)
    return beyond


def _steps(targets: Targets, found: Measured) -> FloatArray:
    """(m, n_joints) changes from a target to the next of its sequence, both of them solved."""
    after = np.setdiff1d(np.arange(1, len(found.solved)), targets.firsts)
    after = after[found.solved[after] & found.solved[after - 1]]
    step: FloatArray = found.joints[after] - found.joints[after - 1]
    return step


def _second_derivatives(targets: Targets, found: Measured) -> FloatArray:
    """(m, n_joints) per mm^2, at targets with two neighbours, all three of them solved."""
    behind = _third_of_three(targets, found)
    bend: FloatArray = found.joints[behind] - 2 * found.joints[behind - 1] + found.joints[behind - 2]
    spacing_mm = targets.along_mm[behind] - targets.along_mm[behind - 1]
    return bend / spacing_mm[:, None] ** 2


def _third_of_three(targets: Targets, found: Measured) -> IntArray:
    behind = np.setdiff1d(np.arange(2, len(found.solved)), np.concatenate((targets.firsts, targets.firsts + 1)))
    chosen: IntArray = behind[found.solved[behind] & found.solved[behind - 1] & found.solved[behind - 2]]
    return chosen


def _by_unit(arm: Arm, values: FloatArray, reduce: Callable[[FloatArray], float]) -> _ByUnit:
    """One figure of values (n, n_joints) for all revolute joints, in degrees, and one for all sliding ones, in mm."""
    in_file_units = arm.to_file_units(values)
    slides = np.array([joint.kind is JointKind.PRISMATIC for joint in arm.joints])
    return _of(in_file_units[:, ~slides], reduce), _of(in_file_units[:, slides], reduce)


def _of(values: FloatArray, reduce: Callable[[FloatArray], float]) -> float | None:
    return float(reduce(values)) if values.size else None


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
