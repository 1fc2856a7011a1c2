"""A configuration of an arm as plain values for JSON and as text for people, in degrees and millimetres."""

from __future__ import annotations

from typing import Any

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.json_numbers import rounded
from planner.kinematics.frame_jacobian import chain_frames
from planner.kinematics.sensitivity import sideways_error, tip_sensitivity
from planner.kinematics.singular_shapes import singular_shapes
from planner.kinematics.singularity import ROW_NAMES, singularity

_SLACK = 1e-9


def configuration_description(arm: Arm, joints: FloatArray, in_frame: int = 0) -> dict[str, Any]:
    """The pen's pose, limits, Jacobian, singular values, null spaces and tip errors of one configuration.

    joints: (n_joints,), rad or mm. jacobian: 6 rows, mm and rad per rad or mm, of the last frame seen from
    `in_frame`. internal_motion: steps of the joints, in degrees or mm, that leave those of its `rows` at rest.
    impossible_velocity: weights of the Jacobian's rows whose sum is zero whatever the joints do.
    Errors: UsageError where the chain has no such frame.
    """
    found = singularity(arm, joints, None, in_frame)
    frame = chain_frames(arm, joints[None])[0, -1]
    pen = frame[:3, :3] @ np.array(arm.pen.tool_axis)
    rows = [ROW_NAMES[row] for row in found.mobility.rows]
    names = [joint.name for joint in arm.joints]
    return {
        "joints": _named(names, arm.to_file_units(joints)),
        "outside_limits": [
            _beyond(arm, index, float(value))
            for index, value in enumerate(joints)
            if not arm.minimum[index] - _SLACK <= value <= arm.maximum[index] + _SLACK
        ],
        "coupling_error_deg": _named(
            [names[coupling.joint] for coupling in arm.couplings], _coupling_errors(arm, joints)
        ),
        "tip_mm": rounded(frame[:3, 3]),
        "rotation": rounded(frame[:3, :3]),
        "tilt_deg": rounded(np.degrees(np.arctan2(np.hypot(pen[0], pen[1]), -pen[2]))),
        "jacobian_frame": in_frame,
        "jacobian": rounded(found.jacobian),
        "rows": rows,
        "length_mm": rounded(found.mobility.length_mm),
        "singular_values": rounded(found.singular_values),
        "condition": None if found.is_singular else rounded(found.condition),
        "manipulability": rounded(found.manipulability),
        "freedom": found.mobility.freedom,
        "rank": found.rank,
        "singular": found.is_singular,
        "shapes": singular_shapes(arm, joints) if found.is_singular else [],
        "internal_motion": [_named(names, motion) for motion in _in_file_units(arm, found.internal)],
        "impossible_velocity": [_named(rows, velocity) for velocity in found.impossible],
        "tip_error_mm": _named(names, np.linalg.norm(tip_sensitivity(arm, joints[None])[0], axis=0)),
        "sideways_error_mm": rounded(sideways_error(arm, joints[None])[0]),
    }


def configuration_lines(arm: Arm, configuration: dict[str, Any]) -> list[str]:
    """What `configuration_description` found, as lines to read."""
    units = {joint.name: joint.file_unit for joint in arm.joints}
    frame = frame_name(arm, configuration["jacobian_frame"])
    x, y, z = configuration["tip_mm"]
    lines = [
        "configuration: "
        + ", ".join(f"{name} {value:g} {units[name]}" for name, value in configuration["joints"].items()),
        f"pen: tip at ({x:.3f}, {y:.3f}, {z:.3f}) mm, {configuration['tilt_deg']:.3f} deg off straight down",
        "limits: " + ("; ".join(configuration["outside_limits"]) or "kept"),
    ]
    if configuration["coupling_error_deg"]:
        off = {name: error for name, error in configuration["coupling_error_deg"].items() if abs(error) > 1e-4}
        lines.append(
            "coupling: "
            + ("; ".join(f"{name} is off by {error:g} {units[name]}" for name, error in off.items()) or "kept")
        )
    lines += ["", f"Jacobian of the pen in frame {frame} (mm and rad, per rad or mm of the joint)"]
    widths = [max(10, len(name)) for name in units]
    lines += [f"  {'':2}  " + "  ".join(f"{name:>{width}}" for name, width in zip(units, widths, strict=True))]
    lines += [
        f"  {name}  " + "  ".join(f"{value + 0.0:{width}.4f}" for value, width in zip(row, widths, strict=True))
        for name, row in zip(ROW_NAMES, configuration["jacobian"], strict=True)
    ]
    lines += [
        "",
        f"rank: {configuration['rank']} of {configuration['freedom']}, over {' '.join(configuration['rows'])}",
        "singular values: "
        + ", ".join(f"{value:.4g}" for value in configuration["singular_values"])
        + f" (lengths in units of {configuration['length_mm']:.4g} mm)",
        "condition: " + ("infinite" if configuration["condition"] is None else f"{configuration['condition']:.4g}"),
        f"manipulability: {configuration['manipulability'] if not configuration['singular'] else 0.0:.6g} (mm and rad)",
    ]
    if configuration["singular"]:
        lines.append("singular: " + ("; ".join(configuration["shapes"]) or "in a way that no single joint tells"))
    resting = "pen" if any(row.startswith("w") for row in configuration["rows"]) else "tip"
    lines += [
        f"internal motion, the {resting} at rest: {motion_text(motion, units)}"
        for motion in configuration["internal_motion"]
    ]
    lines += [
        f"impossible, in frame {frame}: {velocity_text(velocity)}" for velocity in configuration["impossible_velocity"]
    ]
    lines.append(
        "tip error: "
        + ", ".join(f"{name} {value:.3g} mm/{units[name]}" for name, value in configuration["tip_error_mm"].items())
        + f"; along the paper {configuration['sideways_error_mm']:.3g} mm, rms over the joints"
    )
    return lines


def _coupling_errors(arm: Arm, joints: FloatArray) -> FloatArray:
    """(n_couplings,) deg or mm by which mimic joints differ from what the others make them."""
    wanted = arm.complete(joints[list(arm.independent_joints)])
    error: FloatArray = arm.to_file_units(joints - wanted)[[coupling.joint for coupling in arm.couplings]]
    return error


def _beyond(arm: Arm, index: int, value: float) -> str:
    joint = arm.joints[index]
    over = value > joint.maximum
    limit = (joint.maximum if over else joint.minimum) / joint.per_file_unit
    return (
        f"{joint.name} at {value / joint.per_file_unit:.10g} {joint.file_unit} is"
        f" {'above its greatest' if over else 'below its least'}, {limit:.10g} {joint.file_unit}"
    )


def _in_file_units(arm: Arm, motions: FloatArray) -> FloatArray:
    """Motions (k, n_joints) in degrees and mm, the largest entry of each 1 again."""
    if not len(motions):
        return motions
    converted = arm.to_file_units(motions)
    peak = np.take_along_axis(converted, np.abs(converted).argmax(axis=1)[:, None], axis=1)
    scaled: FloatArray = converted / peak
    return scaled


def frame_name(arm: Arm, frame: int) -> str:
    return {0: "0 (base)", arm.n_joints: f"{frame} (tool)"}.get(frame, str(frame))


def motion_text(motion: dict[str, float], units: dict[str, str]) -> str:
    return ", ".join(f"{name} {value:+.4g} {units[name]}" for name, value in motion.items() if abs(value) > 1e-6)


def velocity_text(weights: dict[str, float]) -> str:
    terms = {name: weight for name, weight in weights.items() if abs(weight) > 1e-6}
    if len(terms) == 1:
        return next(iter(terms))
    return " ".join(f"{weight:+.4g} {name}" for name, weight in terms.items()) + " is always 0"


def _named(names: list[str], values: FloatArray) -> dict[str, float]:
    return dict(zip(names, rounded(values), strict=True))
