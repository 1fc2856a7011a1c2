"""What a joint may do: the limits of its description, and stated guesses for what that leaves open."""

from __future__ import annotations

import math

from planner.arms.urdf.import_options import ImportOptions
from planner.arms.urdf.mimics import followed
from planner.arms.urdf.robot import Robot, UrdfJoint

_MOST_TURNS_RAD = 4.0 * math.pi
"""A range beyond two whole turns is that of a joint without limits."""
_MOST_SPEED = 1000.0
"""rad/s or m/s: what is beyond is a way to say "none"."""


def position_limits(robot: Robot, joint: UrdfJoint, options: ImportOptions, remarks: list[str]) -> tuple[float, float]:
    """Lower and upper, rad or m. Adds to the remarks what was made up. Errors: ArmFileError."""
    lower, upper = (robot.number(joint, "limit", key, 0.0) for key in ("lower", "upper"))
    turns = joint.kind != "prismatic"
    if turns and (joint.kind == "continuous" or "limit" not in joint.parts or upper - lower > _MOST_TURNS_RAD):
        remarks.append(f"joint {joint.name} has no limits; it turns {options.turn_deg:g} deg to either side here")
        return -math.radians(options.turn_deg), math.radians(options.turn_deg)
    if "limit" not in joint.parts:
        robot.refuse(
            f"joint {joint.name} in line {joint.line} slides and has no limit: add <limit lower upper velocity>"
        )
    if lower > upper:
        robot.refuse(
            f"joint {joint.name} in line {joint.line}: its lower limit {lower:g} is above its upper limit {upper:g}"
        )
    following = followed(robot, joint)
    if following.leader.name != joint.name and following.leader.kind != "continuous":
        leader = following.leader
        ends = [
            following.multiplier * robot.number(leader, "limit", key, 0.0) + following.offset
            for key in ("lower", "upper")
        ]
        if min(ends) < max(ends):
            lower, upper = max(lower, min(ends)), min(upper, max(ends))
    if lower >= upper:
        robot.refuse(
            f"joint {joint.name} in line {joint.line}: its limits and those of the joint that it mimics have nothing in"
            " common"
        )
    return lower, upper


def velocity_limit(robot: Robot, joint: UrdfJoint, options: ImportOptions, remarks: list[str]) -> float:
    """rad/s or m/s. Adds to the remarks what was made up. Errors: ArmFileError."""
    velocity = robot.number(joint, "limit", "velocity", 0.0)
    if 0 < velocity <= _MOST_SPEED:
        return velocity
    turns = joint.kind != "prismatic"
    unit = "deg/s" if turns else "mm/s"
    remarks.append(f"joint {joint.name} has no velocity limit; {options.velocity:g} {unit} was taken (--velocity)")
    return math.radians(options.velocity) if turns else options.velocity / 1000.0
