"""A comparison as plain values for JSON, in degrees and millimetres."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.comparison.compare import Comparison, MethodResult
from planner.comparison.convergence import Convergence
from planner.comparison.targets import TargetKind


def comparison_description(comparison: Comparison) -> dict[str, Any]:
    """The same keys whatever was compared; null where there is nothing to say, as in `Figures`.

    configurations: of single targets, those that each method ends at. convergence: of single targets, the iterations of
    the documented method.
    """
    arm, targets = comparison.arm, comparison.targets
    is_single = targets.kind is TargetKind.SINGLE
    return {
        "arm": arm.name,
        "targets": {
            "kind": targets.kind.value,
            "count": len(targets.tips_mm),
            "tips_mm": targets.tips_mm.tolist() if is_single else None,
        },
        "start": _joints(arm, comparison.start),
        "methods": [_method(arm, result, with_configurations=is_single) for result in comparison.results],
        "convergence": [_convergence(arm, found) for found in comparison.convergences] if is_single else None,
    }


def _method(arm: Arm, result: MethodResult, *, with_configurations: bool) -> dict[str, Any]:
    return {
        "method": result.method.name,
        "title": result.method.title,
        "tolerance_mm": result.method.tolerance_mm,
        "refusal": result.refusal,
        **asdict(result.figures),
        "failures": [asdict(failure) for failure in result.failures],
        "postures": [_joints(arm, joints) for joints in result.measured.joints]
        if with_configurations and result.measured is not None
        else None,
    }


def _convergence(arm: Arm, found: Convergence) -> dict[str, Any]:
    return {
        "target_mm": found.target_mm.tolist(),
        "converged": found.converged,
        "iterations": [
            {
                "i": index,
                "joints": _joints(arm, state.joints),
                "tip_mm": state.tip_mm.tolist(),
                "error_mm": state.error_mm.tolist(),
                "error_along_mm": float(np.hypot(*state.error_mm[:2])),
                "error_across_mm": abs(float(state.error_mm[2])),
                "step": _joints(arm, state.step),
            }
            for index, state in enumerate(found.steps)
        ],
    }


def _joints(arm: Arm, joints: FloatArray) -> dict[str, float] | None:
    """By name, in degrees or mm; None where there is no configuration."""
    if np.isnan(joints).any():
        return None
    return dict(zip((joint.name for joint in arm.joints), arm.to_file_units(joints).tolist(), strict=True))
