"""An arm as the text of its file: what `read_arm_file` reads back as the same arm."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict

import numpy as np

from planner.arms.arm import Arm, BusServo, Joint, Servo
from planner.arms.coupling_section import coupling_values
from planner.arms.frame_section import frame_values
from planner.arms.paper_pose import PaperPose
from planner.arms.rigid_transform import RigidTransform
from planner.settings import DEFAULT_WEIGHTS

_LIMITS = {"min": "minimum", "max": "maximum"}
_RATES = {
    "max_velocity_{}_s": "max_velocity",
    "max_acceleration_{}_s2": "max_acceleration",
    "max_jerk_{}_s3": "max_jerk",
}


def arm_toml(arm: Arm, remarks: Iterable[str] = ()) -> str:
    """The text of an arm file, `remarks` as comments at its top."""
    blocks = ["\n".join(f"# {line}".rstrip() for line in remarks)] if remarks else []
    head = {"name": arm.name, "source": arm.source}
    if arm.closed_form:
        head["closed_form"] = arm.closed_form
    blocks.append(_lines(head))
    pen = {
        "hold": arm.pen.hold.value,
        "tool_axis": list(arm.pen.tool_axis),
        "lift_mm": arm.pen.lift_mm,
        "clearance_mm": arm.pen.clearance_mm,
        "speed_mm_s": arm.pen.speed_mm_s,
    }
    blocks.append("[pen]\n" + _lines(pen))
    blocks.append(
        "[workspace]\n"
        + _lines(
            {"inner_radius_mm": arm.workspace.inner_radius_mm, "min_tip_speed_mm_s": arm.workspace.min_tip_speed_mm_s}
        )
    )
    if not arm.paper.is_base_plane:
        blocks.append("[paper]\n" + _lines(_paper(arm.paper)))
    if not arm.tool.is_identity:
        blocks.append("[tool]\n" + _exact_lines(frame_values(arm.tool)))
    if arm.set_point_period_s is not None:
        blocks.append("[servos]\n" + _lines({"set_point_period_ms": 1e3 * arm.set_point_period_s}))
    if arm.accuracy is not None:
        slack = {
            f"{joint.name}": value / joint.per_file_unit
            for joint, value in zip(arm.joints, arm.accuracy.slack, strict=True)
        }
        blocks.append(
            "[accuracy]\n"
            + _lines(
                {
                    "marks": arm.accuracy.marks,
                    "tip_mm": arm.accuracy.tip_mm,
                    "height_mm": arm.accuracy.height_mm,
                    "slack": slack,
                }
            )
        )
    if arm.weights != DEFAULT_WEIGHTS:
        blocks.append("[configurations]\n" + _lines(asdict(arm.weights)))
    blocks += [_joint(joint) for joint in arm.joints]
    for coupling in arm.couplings:
        blocks.append("[[coupling]]\n" + _lines(coupling_values(coupling, arm.joints)))
    if arm.park is not None:
        blocks.append(
            "[park]\n"
            + _lines(
                {
                    arm.joints[index].name: arm.park[index] / arm.joints[index].per_file_unit
                    for index in arm.independent_joints
                }
            )
        )
    return "\n\n".join(blocks) + "\n"


def _paper(paper: PaperPose) -> dict[str, float]:
    return {
        "x_mm": paper.x_mm,
        "y_mm": paper.y_mm,
        "z_mm": paper.z_mm,
        "yaw_deg": _degrees(paper.yaw_rad),
        "tilt_x_deg": _degrees(paper.tilt_x_rad),
        "tilt_y_deg": _degrees(paper.tilt_y_rad),
    }


def _joint(joint: Joint) -> str:
    unit, per = joint.file_unit, joint.per_file_unit
    values: dict[str, object] = {"name": joint.name, "kind": joint.kind.value}
    if joint.urdf_name is not None:
        values["urdf_name"] = joint.urdf_name
    if not joint.origin.is_identity:
        values["origin"] = joint.origin
    values |= {
        "theta_deg": _degrees(joint.theta_rad),
        "d_mm": joint.d_mm,
        "a_mm": joint.a_mm,
        "alpha_deg": _degrees(joint.alpha_rad),
    }
    if joint.thickness_mm is not None:
        values["thickness_mm"] = joint.thickness_mm
    values |= {f"{key}_{unit}": getattr(joint, name) / per for key, name in _LIMITS.items()}
    values |= {key.format(unit): getattr(joint, name) / per for key, name in _RATES.items()}
    text = "[[joints]]\n" + _lines(values)
    if joint.servo is not None:
        text += "\n[joints.servo]\n" + _lines(_servo(joint.servo, unit, per))
    if joint.bus is not None:
        text += "\n[joints.bus]\n" + _lines(_bus(joint.bus, unit, per))
    return text


def _servo(servo: Servo, unit: str, per: float) -> dict[str, object]:
    return {
        "channel": servo.channel,
        "direction": servo.direction,
        "trim_us": servo.trim_us,
        "table": [[position / per, pulse_us] for position, pulse_us in servo.curve],
        "pulse_range_us": list(servo.pulse_range_us),
        "resolution_us": servo.resolution_us,
        "dead_band_us": servo.dead_band_us,
        f"backlash_{unit}": servo.backlash / per,
        "lag_s": servo.lag_s,
    }


def _bus(bus: BusServo, unit: str, per: float) -> dict[str, object]:
    values: dict[str, object] = {
        "id": bus.id,
        "count_at_zero": bus.count_at_zero,
        f"counts_per_{unit}": bus.counts_per_unit * per,
        "count_range": list(bus.count_range),
        "dead_band_counts": bus.dead_band_counts,
        f"backlash_{unit}": bus.backlash / per,
        "lag_s": bus.lag_s,
    }
    if bus.curve is not None:
        values["table"] = [[position / per, count] for position, count in bus.curve]
    return values


def _exact_lines(values: Mapping[str, float]) -> str:
    return "\n".join(f"{key} = {_exact_text(value)}" for key, value in values.items())


def _exact_text(value: float) -> str:
    """With all digits but the two that converting to degrees may have cost: errors of origins add up along an arm."""
    return repr(float(f"{value:.14g}"))


def _lines(values: Mapping[str, object]) -> str:
    return "\n".join(f"{key} = {value_text(value)}" for key, value in values.items())


def value_text(value: object) -> str:
    """A text, a number, a list or a table of such as a file has it."""
    match value:
        case str():
            escaped = value.replace("\\", "\\\\").replace('"', '\\"')
            return '"' + "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in escaped) + '"'
        case int():
            return str(value)
        case RigidTransform():
            entries = (f"{key} = {_exact_text(entry)}" for key, entry in frame_values(value).items())
            return "{ " + ", ".join(entries) + " }"
        case float():
            return repr(float(f"{value:.10g}"))
        case list() if value and isinstance(value[0], list):
            rows = [value_text(row) for row in value]
            lines = [", ".join(rows[k : k + 6]) for k in range(0, len(rows), 6)]
            return "[\n    " + ",\n    ".join(lines) + ",\n]"
        case list():
            return "[" + ", ".join(map(value_text, value)) + "]"
        case dict():
            return "{ " + ", ".join(f"{key} = {value_text(entry)}" for key, entry in value.items()) + " }"
        case _:
            return value_text(float(np.float64(value)))  # type: ignore[arg-type]


def _degrees(angle_rad: float) -> float:
    return float(np.degrees(angle_rad))
