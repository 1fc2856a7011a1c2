"""Which joints of a robot make the arm: those on the way from one link, the base, to another, the tip."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from planner.arms.urdf.robot import Robot, UrdfJoint

MOVING = ("revolute", "continuous", "prismatic")
_TOOL = re.compile(r"(^|[_-])(tool\d*|tcp|ee|eef|end_?effector|pen|gripper_frame)(_link|_frame)?$", re.IGNORECASE)
_MOST_TOLD = 40


def chosen_branch(robot: Robot, base: str | None, tip: str | None) -> tuple[str, str, tuple[UrdfJoint, ...]]:
    """The base, the tip and the joints between them, from the base on.

    The base is the root where none is named. The tip is the end that is named like a tool, if there is just one such;
    else that of the branch with the most joints, or where several have as many, as the fingers of a hand do, the link
    that they have in common. Errors: ArmFileError, listing the links that there are.
    """
    for link, option in ((base, "--base"), (tip, "--tip")):
        if link is not None and link not in robot.links:
            robot.refuse(f"has no link '{link}' ({option}); {_listed('links', robot.links)}")
    leading = _leading(robot)
    if base is None:
        base = _root(robot, leading, tip)
    if tip is None:
        tip = _usual_tip(robot, leading, base)
    joints = _way(robot, leading, base, tip)
    if not any(joint.kind in MOVING for joint in joints):
        robot.refuse(f"no joint moves between link '{base}' and link '{tip}'; {_ends_told(robot, leading, base)}")
    return base, tip, joints


def _leading(robot: Robot) -> dict[str, list[UrdfJoint]]:
    """The joints that lead to each link: one, in a tree."""
    leading: dict[str, list[UrdfJoint]] = {link: [] for link in robot.links}
    for joint in robot.joints:
        leading.setdefault(joint.child, []).append(joint)
    return leading


def _root(robot: Robot, leading: dict[str, list[UrdfJoint]], tip: str | None) -> str:
    if tip is not None:
        return _upwards(robot, leading, tip)[-1]
    roots = [link for link in robot.links if not leading[link]]
    if not roots:
        _upwards(robot, leading, robot.links[-1])
    busy = [root for root in roots if any(joint.parent == root for joint in robot.joints)] or roots
    if len(busy) != 1:
        robot.refuse(f"has {len(busy)} links that nothing leads to; name one with --base: {_listed('links', busy)}")
    return busy[0]


def _upwards(robot: Robot, leading: dict[str, list[UrdfJoint]], link: str, until: str | None = None) -> list[str]:
    """The links from `link` to the root, or to `until`. Errors: ArmFileError where they are no tree."""
    way = [link]
    while way[-1] != until and leading.get(way[-1]):
        joints = leading[way[-1]]
        if len(joints) > 1:
            names = " and ".join(joint.name for joint in joints)
            robot.refuse(f"two joints lead to link '{way[-1]}', {names}: URDF knows trees alone")
        parent = joints[0].parent
        if parent not in leading:
            robot.refuse(
                f"joint {joints[0].name} in line {joints[0].line} hangs on link '{parent}', which there is not"
            )
        if parent in way:
            robot.refuse(f"links go round in a circle, by joint {joints[0].name} in line {joints[0].line}")
        way.append(parent)
    return way


def _way(robot: Robot, leading: dict[str, list[UrdfJoint]], base: str, tip: str) -> tuple[UrdfJoint, ...]:
    links = _upwards(robot, leading, tip, base)
    if links[-1] != base:
        robot.refuse(f"link '{tip}' does not hang on link '{base}', but on {' on '.join(map(repr, links[1:6]))}")
    joints = tuple(leading[link][0] for link in reversed(links[:-1]))
    for joint in joints:
        if joint.kind not in (*MOVING, "fixed"):
            what = f"is {joint.kind[:40]}" if joint.kind else "has no type"
            robot.refuse(
                f"joint {joint.name} in line {joint.line} {what}: an arm has joints that turn about an axis or slide"
                f" along one; begin beyond it, with --base {joint.child}"
            )
    return joints


def _usual_tip(robot: Robot, leading: dict[str, list[UrdfJoint]], base: str) -> str:
    ends = {link: way for link, way in _ends(robot, leading, base).items() if _count(way)}
    if not ends:
        robot.refuse(f"no joint moves beyond link '{base}'")
    tools = [link for link in ends if _TOOL.search(link)]
    if len(tools) == 1:
        return tools[0]
    most = max(map(_count, ends.values()))
    best = [way for way in ends.values() if _count(way) == most]
    shared = [joints[0] for joints in zip(*best, strict=False) if len({joint.name for joint in joints}) == 1]
    if _count(shared) < most - 1:
        robot.refuse(
            f"has several branches as long as each other; choose with --tip: {_ends_told(robot, leading, base)}"
        )
    return shared[-1].child if shared else base


def _ends(robot: Robot, leading: dict[str, list[UrdfJoint]], base: str) -> dict[str, list[UrdfJoint]]:
    """The joints that lead from the base to each link that no joint goes out from."""
    parents = {joint.parent for joint in robot.joints}
    ways = {}
    for link in robot.links:
        if link not in parents and link != base:
            links = _upwards(robot, leading, link, base)
            if links[-1] == base:
                ways[link] = [leading[one][0] for one in reversed(links[:-1])]
    return ways


def _count(joints: Iterable[UrdfJoint]) -> int:
    return sum(joint.kind in MOVING for joint in joints)


def _ends_told(robot: Robot, leading: dict[str, list[UrdfJoint]], base: str) -> str:
    ends = _ends(robot, leading, base)
    told = [f"{link} ({_count(way)} joints)" for link, way in sorted(ends.items(), key=lambda end: -_count(end[1]))]
    return _listed("ends", told)


def _listed(what: str, names: Sequence[str]) -> str:
    more = len(names) - _MOST_TOLD
    return f"{what}: " + ", ".join(names[:_MOST_TOLD]) + (f", and {more} more" if more > 0 else "")
