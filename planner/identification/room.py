"""Where a joint can be tried: a pose with the pen well up, and how far each joint can go from it alone."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.arms.arm import Arm, PenHold
from planner.arrays import BoolArray, FloatArray
from planner.errors import PlanError
from planner.kinematics.chain import Kinematics
from planner.kinematics.link_clearance import KEPT_MM

_POSES = 400
_STATIONS = 121
"""Positions of a joint at which it is asked whether all is clear."""
_KEPT = 0.03
"""Share of a joint's range that is left free at its ends: overshoot has to end somewhere."""
BEYOND = 0.25
"""Of the room, what is clear beyond each end of it: a joint that does not follow overshoots."""


@dataclass(frozen=True, eq=False, slots=True)
class Room:
    """pose: (n_joints,) where all joints wait. low, high: (n_joints,) between which each is tried while they do;
    `BEYOND` tells how much further it touches nothing."""

    pose: FloatArray
    low: FloatArray
    high: FloatArray


def room_of(arm: Arm, reach: FloatArray | None, seed: int = 0) -> Room:
    """The park pose, or the one of many in which the joint with the least room has the most. reach: (n_joints, 2) where
    servos get to, None for all. Errors: PlanError where there is none with room for every joint."""
    by_itself = Kinematics(replace(arm, couplings=(), pen=replace(arm.pen, hold=PenHold.FREE)))
    margin = _KEPT * (arm.maximum - arm.minimum)
    low, high = arm.minimum + margin, arm.maximum - margin
    if reach is not None:
        kept = _KEPT * (reach[:, 1] - reach[:, 0])
        low, high = np.maximum(low, reach[:, 0] + kept), np.minimum(high, reach[:, 1] - kept)
    random = np.random.default_rng(seed)
    free = list(arm.independent_joints)
    poses = arm.complete(random.uniform(low[free], high[free], size=(_POSES, len(free))))
    if arm.park is not None:
        poses = np.concatenate((np.array([arm.park]), poses))
    poses = poses[np.all((poses >= low) & (poses <= high), axis=1)]
    poses = poses[_is_clear(by_itself, poses)] if len(poses) else poses
    best, best_share = None, 0.0
    for pose in poses:
        room = _around(by_itself, pose, low, high)
        share = float(((room.high - room.low) / (arm.maximum - arm.minimum)).min())
        if share > best_share:
            best, best_share = room, share
    if best is None:
        raise PlanError(f"arm {arm.name}: there is no pose with its pen up in which every joint has room to be tried")
    return best


def _around(kinematics: Kinematics, pose: FloatArray, low: FloatArray, high: FloatArray) -> Room:
    """The middle of the part of each joint's range about the pose in which nothing is touched."""
    lows, highs = pose.copy(), pose.copy()
    for joint in range(len(pose)):
        stations = np.linspace(low[joint], high[joint], _STATIONS)
        there = np.repeat(pose[None], _STATIONS, axis=0)
        there[:, joint] = stations
        clear = _is_clear(kinematics, there)
        at = int(np.argmin(np.abs(stations - pose[joint])))
        if not clear[at]:
            continue
        blocked = np.flatnonzero(~clear)
        first = blocked[blocked < at].max(initial=-1) + 1
        last = blocked[blocked > at].min(initial=_STATIONS) - 1
        middle, half = (stations[first] + stations[last]) / 2, (stations[last] - stations[first]) / 2
        half /= 1 + 2 * BEYOND
        lows[joint], highs[joint] = middle - half, middle + half
    return Room(pose, lows, highs)


def _is_clear(kinematics: Kinematics, joints: FloatArray) -> BoolArray:
    """(n,) whether the pen is up by the lift height, nothing dips below the paper, and no links touch."""
    heights = kinematics.nodes_mm(joints)[:, :, 2]
    clear: BoolArray = (heights[:, -1] >= kinematics.arm.pen.lift_mm) & (heights.min(axis=1) >= 0.0)
    return clear & (kinematics.clearance.least_mm(joints)[0] >= KEPT_MM)
