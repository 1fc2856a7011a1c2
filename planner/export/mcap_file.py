"""MCAP, which Foxglove and ROS 2's tools open: joint states and the pen, in JSON with their schemas.

The doorway to the package of that name, which comes with the extra `mcap`.
"""

from __future__ import annotations

import json
from io import BytesIO
from typing import IO, Any

from planner.errors import UsageError
from planner.export.motion import Motion

_NUMBERS = {"type": "array", "items": {"type": "number"}}
_STAMP = {"type": "object", "properties": {"sec": {"type": "integer"}, "nsec": {"type": "integer"}}}
_JOINT_STATE = {
    "type": "object",
    "properties": {
        "header": {"type": "object", "properties": {"stamp": _STAMP, "frame_id": {"type": "string"}}},
        "name": {"type": "array", "items": {"type": "string"}},
        "position": _NUMBERS,
        "velocity": _NUMBERS,
        "effort": _NUMBERS,
    },
}
_PEN = {"type": "object", "properties": {"down": {"type": "boolean"}, "stroke": {"type": "integer"}}}


def require_mcap() -> Any:
    """The package's writer. Errors: UsageError where it is not installed."""
    try:
        from mcap.writer import Writer
    except ImportError as error:
        raise UsageError("MCAP needs the extra of that name: pip install 'drawing-arm-planner[mcap]'") from error
    return Writer


def write_mcap(motion: Motion, file: IO[bytes]) -> None:
    """Topics /joint_states (rad, m, rad/s, m/s) and /pen, a message a sample, from time 0 on. Errors: UsageError."""
    packed = BytesIO()  # the writer goes back and forth, which a pipe does not
    writer = require_mcap()(packed)
    writer.start(profile="", library="drawing-arm-planner")
    states, pens = (
        writer.register_channel(
            topic=topic,
            message_encoding="json",
            schema_id=writer.register_schema(
                name=name, encoding="jsonschema", data=json.dumps(schema | {"title": name}).encode()
            ),
        )
        for topic, name, schema in (
            ("/joint_states", "sensor_msgs/JointState", _JOINT_STATE),
            ("/pen", "drawing_arm_planner/Pen", _PEN),
        )
    )
    writer.add_metadata("drawing-arm-planner", {"arm": motion.arm, "drawing": motion.drawing})
    rows = zip(motion.positions_si.tolist(), motion.velocities_si.tolist(), strict=True)
    for index, ((position, velocity), (sec, nsec)) in enumerate(
        zip(rows, motion.seconds_and_nanoseconds(), strict=True)
    ):
        state = {
            "header": {"stamp": {"sec": sec, "nsec": nsec}, "frame_id": ""},
            "name": motion.names,
            "position": position,
            "velocity": velocity,
            "effort": [],
        }
        pen = {"down": bool(motion.pen[index]), "stroke": int(motion.stroke[index])}
        for channel, message in ((states, state), (pens, pen)):
            time_ns = sec * 1_000_000_000 + nsec
            data = json.dumps(message).encode()
            writer.add_message(channel_id=channel, log_time=time_ns, publish_time=time_ns, sequence=index, data=data)
    writer.finish()
    file.write(packed.getvalue())
