"""Joints that mimic others: which of a branch move by themselves, and what the others make of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from planner.arms.urdf.branch import MOVING
from planner.arms.urdf.robot import Robot, UrdfJoint


@dataclass(frozen=True, slots=True)
class Following:
    """position = offset + multiplier * that of `leader`, rad or m."""

    leader: UrdfJoint
    multiplier: float = 1.0
    offset: float = 0.0


def followed(robot: Robot, joint: UrdfJoint) -> Following:
    """The joint that leads in the end, where one that is mimicked mimics another. A joint that mimics none leads
    itself. Errors: ArmFileError."""
    found, seen = Following(joint), {joint.name}
    while "mimic" in found.leader.parts:
        here = found.leader
        name = here.parts["mimic"].get("joint", "")
        leader = next((other for other in robot.joints if other.name == name), None)
        if leader is None:
            robot.refuse(f"joint {here.name} in line {here.line} mimics joint '{name[:60]}', which there is not")
        if name in seen:
            robot.refuse(f"joint {here.name} in line {here.line} mimics itself, by way of joint {name}")
        seen.add(name)
        multiplier = robot.number(here, "mimic", "multiplier", 1.0)
        offset = robot.number(here, "mimic", "offset", 0.0)
        found = Following(leader, found.multiplier * multiplier, found.multiplier * offset + found.offset)
    return found


def standing(robot: Robot, joint: UrdfJoint) -> float | None:
    """Where a joint stands for good, rad or m: one that is fixed, one that mimics such a one or mimics nothing of
    another's motion, one whose limits leave it no way. None where it moves. Errors: ArmFileError."""
    following = followed(robot, joint)
    if following.leader.kind == "fixed" or following.multiplier == 0.0:
        return following.offset
    leader = following.leader
    if leader.kind in ("revolute", "prismatic") and "limit" in leader.parts:
        lower, upper = (robot.number(leader, "limit", key, 0.0) for key in ("lower", "upper"))
        if lower == upper:
            return following.multiplier * lower + following.offset
    return None


def led(robot: Robot, moving: Sequence[UrdfJoint]) -> dict[str, Following]:
    """By the names of joints that follow others of the branch: whom, and how. The first of those that mimic a joint
    elsewhere leads the rest, as that one moves for nothing else."""
    leaders: dict[str, Following] = {joint.name: Following(joint) for joint in moving if "mimic" not in joint.parts}
    result = {}
    for joint in moving:
        following = followed(robot, joint)
        name = following.leader.name
        if name == joint.name:
            continue
        if following.leader.kind not in MOVING:
            robot.refuse(f"joint {joint.name} mimics joint {name}, which is {following.leader.kind[:40] or 'no type'}")
        if name not in leaders:
            # joint = m leader + o, so that leader = (joint - o) / m
            m, o = following.multiplier, following.offset
            leaders[name] = Following(joint, 1.0 / m, -o / m)
            continue
        lead = leaders[name]
        m, o = following.multiplier, following.offset
        result[joint.name] = Following(lead.leader, m * lead.multiplier, m * lead.offset + o)
    return result
