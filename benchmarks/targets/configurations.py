"""Configurations of the default method beside sequential damped least squares: time, drawn error, limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.targets.row import Row
from benchmarks.targets.strokes import followed, lines, placed_strokes, timed
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.errors import PlannerError
from planner.kinematics.frame_jacobian import frame_jacobian
from planner.settings import Method, PlanSettings

LONGER_THAN_MM = 12.0
AT_REST = 2.5
"""Radians on the way of the arm's reach: what a joint is off at rest, against what it adds by running late."""
HEIGHT = 0.5
"""What a millimetre of height counts for, against one sideways."""
_HYSTERESIS_DEG = 0.1
"""A joint reverses where it turns back by more than this, degrees or mm: less is lost in any servo's dead band."""
_FRACTIONS = np.array([0.0, 0.5])


@dataclass(frozen=True, slots=True)
class Figures:
    """drawn_error: rms of what joints move the tip by for a millimetre of way, running late and off at rest, as if each
    erred by itself."""

    drawn_error: float
    reversals: int
    outside_share: float
    refused: int
    reason: str


def against_dls(drawing: Path, settings: PlanSettings) -> list[Row]:
    arm = load_arm(settings.arm)
    strokes = lines(placed_strokes(drawing, arm, settings), LONGER_THAN_MM)
    each = [replace(settings, method=method) for method in (settings.method, Method.DLS)]
    path, dls = (figures(arm, strokes, one) for one in each)
    path_s, dls_s = (float(timed(arm, strokes, one).time_s.sum()) for one in each)
    where = (
        f"configurations against sequential DLS, {len(strokes)} strokes of {drawing.stem} over {LONGER_THAN_MM:g} mm: "
    )
    time, error = path_s / dls_s, path.drawn_error / dls.drawn_error
    return [
        Row(
            where + "time after the same timing",
            "never longer",
            f"{path_s:.2f} s against {dls_s:.2f} s: {time - 1:+.1%}",
            time <= 1.0,
        ),
        Row(
            where + "expected drawn error, height included",
            "never more",
            f"{path.drawn_error:.3f} mm/mm against {dls.drawn_error:.3f}: {error - 1:+.1%}",
            error <= 1.0,
        ),
        Row(
            where + f"pen-down joint reversals over {_HYSTERESIS_DEG:g}°",
            "report",
            f"{path.reversals} against {dls.reversals}: {path.reversals / max(dls.reversals, 1) - 1:+.1%}",
        ),
    ]


def limits_of_narrow_arms(drawing: Path, settings: PlanSettings) -> list[Row]:
    """What DLS breaks, and what the default method does instead. The narrowed arm is given strokes on the canvas of
    the whole one, so that there is something to break."""
    whole, measured = load_arm(settings.arm), load_arm("drawing_arm_2022")
    rows = []
    for arm, placed_for, name in (
        (measured, measured, measured.name),
        (narrow(whole), whole, f"{whole.name}, windows narrowed by a third"),
    ):
        what = f"limit violations of {drawing.stem} on {name}"
        target = "DLS: report; path: none, or refused with the reason"
        try:
            strokes = lines(placed_strokes(drawing, placed_for, settings))
            path, dls = (
                figures(arm, strokes, replace(settings, method=method)) for method in (settings.method, Method.DLS)
            )
        except PlannerError as error:
            rows.append(Row(what, target, f"refused: {error}"))
            continue
        told = f" ({path.reason})" if path.reason else ""
        rows.append(
            Row(
                what,
                target,
                f"DLS outside on {dls.outside_share:.1%} of the way; path {path.outside_share:.1%},"
                f" {path.refused} of {len(strokes)} strokes refused{told}",
                path.outside_share == 0.0,
            )
        )
    return rows


def narrow(arm: Arm) -> Arm:
    """The arm with the middle two thirds of each joint's range."""
    return replace(
        arm,
        joints=tuple(
            replace(
                joint,
                minimum=joint.minimum + (joint.maximum - joint.minimum) / 6,
                maximum=joint.maximum - (joint.maximum - joint.minimum) / 6,
            )
            for joint in arm.joints
        ),
    )


def figures(arm: Arm, strokes: Sequence[FloatArray], settings: PlanSettings) -> Figures:
    """Of the strokes that the method draws; of all, whatever limit they break, for DLS, which knows none."""
    paths, joint_splines, infeasible_paths = followed(arm, strokes, settings)
    blocked = {infeasible_path.path for infeasible_path in infeasible_paths}
    joints = joint_splines.positions(_FRACTIONS)
    weight = np.hypot(*np.moveaxis(paths.pen.positions(_FRACTIONS, 1), 2, 0))
    drawn = np.array([settings.method is Method.DLS or path not in blocked for path in range(len(strokes))])
    of_path = np.repeat(np.arange(len(strokes)), joint_splines.n_cells)
    slope = joint_splines.positions(_FRACTIONS, 1) / np.maximum(weight, 1e-12)[..., None]
    weight[~drawn[of_path]] = 0.0
    jacobian = frame_jacobian(arm, joints.reshape(-1, arm.n_joints))[:, :3].reshape(*weight.shape, 3, arm.n_joints)
    counted = jacobian * np.array([1.0, 1.0, HEIGHT])[:, None]
    reach_mm = max(float(np.hypot(*np.moveaxis(paths.pen.positions(_FRACTIONS), 2, 0)).max()), 1.0)
    at_rest = AT_REST / reach_mm * arm.per_file_unit / np.radians(1)
    square = ((counted**2).sum(axis=2) * (slope**2 + at_rest**2)).sum(axis=2)
    outside = (np.maximum(arm.minimum - joints, joints - arm.maximum) > 1e-9).any(axis=2)
    turned = sum(
        reversals(joints[of_path == path].reshape(-1, arm.n_joints) / arm.per_file_unit)
        for path in np.flatnonzero(drawn).tolist()
    )
    length = max(float(weight.sum()), 1e-12)
    return Figures(
        float(np.sqrt((weight * square).sum() / length)),
        turned,
        float((weight * outside).sum() / length),
        len(blocked),
        infeasible_paths[0].reason if infeasible_paths else "",
    )


def reversals(joints: FloatArray) -> int:
    """How often joints (n, n_joints), degrees or mm, turn back by more than the hysteresis, all joints together."""
    total = 0
    for column in joints.T:
        values = column.tolist()
        low = high = values[0]
        direction = 0
        for value in values:
            high = max(high, value) if direction >= 0 else high
            low = min(low, value) if direction <= 0 else low
            if direction >= 0 and value < high - _HYSTERESIS_DEG:
                total += direction > 0
                direction, low = -1, value
            elif direction <= 0 and value > low + _HYSTERESIS_DEG:
                total += direction < 0
                direction, high = 1, value
    return total
