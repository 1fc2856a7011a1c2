"""LeRobot's actions, a line of JSON each: what `robot.send_action` takes, at so many a second.

Not their dataset: that is made for learning, with cameras, statistics and a form that changes with each version, while
a dozen lines play this. LeRobot counts degrees from the middle of the range of a bus servo, which a joint's `bus` in
the arm file tells; joints without one are in their own degrees or mm.
"""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np

from planner.arms.arm import Joint
from planner.arrays import FloatArray
from planner.export.motion import Motion

_DEGREES_PER_COUNT = 360.0 / 4095.0
_DECIMALS = 6


def lerobot_lines(motion: Motion) -> Iterator[str]:
    """The first line tells of the motion, each other is a sample."""
    names = [f"{joint.name}.pos" for joint in motion.joints]
    columns = [_values(joint, column) for joint, column in zip(motion.joints, motion.positions.T, strict=True)]
    head = {
        "format": "lerobot actions",
        "version": 1,
        "arm": motion.arm,
        "drawing": motion.drawing,
        "fps": motion.rate_hz,
        "frames": motion.n_samples,
        "action_names": names,
        "units": [joint.file_unit for joint in motion.joints],
    }
    yield json.dumps(head)
    for index, row in enumerate(np.round(np.column_stack(columns), _DECIMALS).tolist()):
        action = dict(zip(names, row, strict=True))
        frame = {"frame_index": index, "timestamp": round(index / motion.rate_hz, 9), "action": action}
        yield json.dumps(frame | {"pen": int(motion.pen[index]), "stroke": int(motion.stroke[index])})


def _values(joint: Joint, positions: FloatArray) -> FloatArray:
    """(n,) as LeRobot counts them (use_degrees=True), of positions (n,) rad or mm."""
    bus = joint.bus
    if bus is None:
        own: FloatArray = positions / joint.per_file_unit
        return own
    if bus.curve is None:
        counts = bus.count_at_zero + bus.counts_per_unit * positions
    else:
        at, told = np.array(bus.curve).T
        counts = np.interp(positions, at, told)
    middle = (bus.count_range[0] + bus.count_range[1]) / 2
    degrees: FloatArray = (counts - middle) * _DEGREES_PER_COUNT
    return degrees
