"""A small step as plain values for JSON and as text for people, in degrees and millimetres."""

from __future__ import annotations

from typing import Any

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.json_numbers import rounded
from planner.kinematics.configuration_description import frame_name, motion_text, velocity_text
from planner.kinematics.escape import escape
from planner.kinematics.singular_shapes import singular_shapes
from planner.kinematics.singularity import ROW_NAMES, singularity
from planner.kinematics.small_step import SmallStep

_AXES = ("x", "y", "z", "rx", "ry", "rz")
_PER_FILE_UNIT = np.array([1.0] * 3 + [np.pi / 180] * 3)


def step_description(
    arm: Arm, joints: FloatArray, step: SmallStep, asked: FloatArray | None, in_frame: int
) -> dict[str, Any]:
    """asked: (3,) or (6,) mm and rad, where a step of the tool was. tool_step, missing, moved: by x, y, z (mm) and rx,
    ry, rz (deg) of the frame; `moved` is what the tool does, `tool_step` its linear part. outside_limits: joints that
    would be beyond a limit. singularity: its type, of a singular configuration."""
    found = singularity(arm, joints, None, in_frame)
    names = [joint.name for joint in arm.joints]
    after = joints + step.joints
    way_out = escape(arm, joints) if found.is_singular else None
    rows = [ROW_NAMES[row] for row in found.mobility.rows]
    return {
        "joints": dict(zip(names, rounded(arm.to_file_units(joints)), strict=True)),
        "frame": in_frame,
        "asked": None if asked is None else _of_tool(asked),
        "joint_step": dict(zip(names, rounded(arm.to_file_units(step.joints)), strict=True)),
        "tool_step": _of_tool(step.tool),
        "missing": _of_tool(step.missing),
        "possible": step.is_possible,
        "moved": _of_tool(step.moved),
        "time_s": rounded(step.time_s),
        "outside_limits": [
            name
            for name, value, low, high in zip(names, after, arm.minimum, arm.maximum, strict=True)
            if not low - 1e-9 <= value <= high + 1e-9
        ],
        "internal_motion": [
            dict(zip(names, rounded(motion / np.abs(motion).max()), strict=True))
            for motion in map(arm.to_file_units, found.internal)
        ],
        "impossible_velocity": [dict(zip(rows, rounded(velocity), strict=True)) for velocity in found.impossible],
        "singular": found.is_singular,
        "shapes": singular_shapes(arm, joints) if found.is_singular else [],
        "singularity": None
        if way_out is None
        else {
            "type": way_out.type,
            "null_motion_leaves": way_out.null_motion_leaves,
            "tool_can_rest": way_out.tool_can_rest,
            "in_words": str(way_out),
        },
    }


def step_lines(arm: Arm, step: dict[str, Any]) -> list[str]:
    """What `step_description` found, as lines to read."""
    units = {joint.name: joint.file_unit for joint in arm.joints}
    frame = frame_name(arm, step["frame"])
    lines = [
        "configuration: " + ", ".join(f"{name} {value:g} {units[name]}" for name, value in step["joints"].items()),
        *([] if step["asked"] is None else [f"asked of the tool, in frame {frame}: {_told(step['asked'])}"]),
        "joints: " + ", ".join(f"{name} {value:+.6g} {units[name]}" for name, value in step["joint_step"].items()),
        f"tool, in frame {frame}: {_told(step['tool_step'])}",
    ]
    if not step["possible"]:
        lines.append(
            f"missing: {_told({k: v for k, v in step['missing'].items() if v})}, which no joint does from here"
        )
    beyond = {key: step["moved"][key] - value for key, value in step["tool_step"].items()}
    lines.append(f"beyond the linear part, a step of this size moves the tool by {_told(beyond)}")
    lines.append(f"time: {step['time_s']:.4g} s at the joints' full speed")
    if step["outside_limits"]:
        lines.append(f"limits: {', '.join(step['outside_limits'])} would be beyond")
    lines += [f"internal motion: {motion_text(motion, units)}" for motion in step["internal_motion"]]
    lines += [f"impossible, in frame {frame}: {velocity_text(one)}" for one in step["impossible_velocity"]]
    if step["singular"]:
        shapes = "; ".join(step["shapes"])
        lines.append(f"singular{f' ({shapes})' if shapes else ''}, {step['singularity']['in_words']}")
    return lines


def _of_tool(values: FloatArray) -> dict[str, float]:
    return dict(zip(_AXES, rounded(values / _PER_FILE_UNIT[: len(values)]), strict=False))


def _told(values: dict[str, float]) -> str:
    return ", ".join(f"{key} {value:+.6g} {'deg' if key.startswith('r') else 'mm'}" for key, value in values.items())
