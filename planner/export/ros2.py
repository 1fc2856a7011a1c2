"""`trajectory_msgs/msg/JointTrajectory`, as the YAML or the JSON that ROS 2's tools read."""

from __future__ import annotations

import json
from collections.abc import Iterator

from planner.arrays import FloatArray
from planner.export.motion import Motion, number


def yaml_lines(motion: Motion) -> Iterator[str]:
    """The message in YAML, as `ros2 topic pub` and any reader of YAML take it."""
    yield "header:"
    yield "  stamp: {sec: 0, nanosec: 0}"
    yield "  frame_id: ''"
    yield f"joint_names: [{', '.join(map(json.dumps, motion.names))}]"
    yield "points:"
    for positions, velocities, accelerations, seconds, nanoseconds in _points(motion):
        yield f"- positions: {positions}"
        yield f"  velocities: {velocities}"
        yield f"  accelerations: {accelerations}"
        yield "  effort: []"
        yield f"  time_from_start: {{sec: {seconds}, nanosec: {nanoseconds}}}"


def json_lines(motion: Motion) -> Iterator[str]:
    """The same message in JSON."""
    yield '{"header": {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""},'
    yield f' "joint_names": {json.dumps(motion.names)},'
    yield ' "points": ['
    for index, (positions, velocities, accelerations, seconds, nanoseconds) in enumerate(_points(motion)):
        yield (
            f'  {{"positions": {positions}, "velocities": {velocities}, "accelerations": {accelerations}, "effort": [],'
            f' "time_from_start": {{"sec": {seconds}, "nanosec": {nanoseconds}}}}}'
            + ("," if index < motion.n_samples - 1 else "")
        )
    yield " ]}"


def _points(motion: Motion) -> Iterator[tuple[str, str, str, int, int]]:
    tables = (motion.positions_si, motion.velocities_si, motion.accelerations_si)
    for rows, (seconds, nanoseconds) in zip(zip(*tables, strict=True), motion.seconds_and_nanoseconds(), strict=True):
        positions, velocities, accelerations = map(_list, rows)
        yield positions, velocities, accelerations, seconds, nanoseconds


def _list(row: FloatArray) -> str:
    """With a point in every number: a reader of YAML would have whole ones of another type."""
    texts = map(number, row.tolist())
    return f"[{', '.join(text if '.' in text else _with_point(text) for text in texts)}]"


def _with_point(text: str) -> str:
    mantissa, e, exponent = text.partition("e")
    return f"{mantissa}.0{e}{exponent}"
