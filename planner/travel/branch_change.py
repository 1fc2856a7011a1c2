"""Travel moves between configurations of different branches: straight up, through the air in joint space, straight
down.

The tip cannot stay near the paper while an arm folds over.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits
from planner.motion.timed_stroke import Contact
from planner.travel.air_way import air_leg, air_way
from planner.travel.travel_moves import TravelMove, TravelRules, plan_travel_moves

_MET = 1e-6
"""Configurations that differ by less, in rad or mm, are one."""


def keeps_branch(kinematics: Kinematics, move: TravelMove, limits: Limits, rules: TravelRules, end: Contact) -> bool:
    """Whether a travel move arrives in the configuration of its end with no jump: between two branches it cannot."""
    arrives = np.abs(kinematics.independent_of(move.joints[-1]) - end.configuration).max() < _MET
    jumps = bool(move.too_long_s) or limits.slowing_of(move.joints, 1 / rules.rate_hz) > 1 + 1e-6
    return move.exact and bool(arrives) and not jumps


def plan_branch_change(
    kinematics: Kinematics, limits: Limits, rules: TravelRules, start: Contact, end: Contact
) -> TravelMove:
    """The travel move between two contacts by way of the air; not exact where no way clear of the paper is found."""
    return plan_by_air(kinematics, limits, rules, [start], [end])[0]


def plan_by_air(
    kinematics: Kinematics, limits: Limits, rules: TravelRules, starts: Sequence[Contact], ends: Sequence[Contact]
) -> list[TravelMove]:
    """Such travel moves from each start to the end of the same index."""
    nowhere = [None] * len(starts)
    ups, downs = (
        plan_travel_moves(kinematics, limits, rules, starts, nowhere),
        plan_travel_moves(kinematics, limits, rules, nowhere, ends),
    )
    return [_by_air(kinematics, limits, rules, up, down) for up, down in zip(ups, downs, strict=True)]


def _by_air(kinematics: Kinematics, limits: Limits, rules: TravelRules, up: TravelMove, down: TravelMove) -> TravelMove:
    corners = air_way(
        kinematics, limits, rules, kinematics.independent_of(up.joints[-1]), kinematics.independent_of(down.joints[0])
    )
    joints = kinematics.arm.complete(corners)
    legs = [air_leg(limits, rules, joints[k], joints[k + 1])[1:] for k in range(len(joints) - 1)]
    return TravelMove(
        np.concatenate((up.joints, *legs, down.joints[1:])),
        up.exact and down.exact and len(legs) > 0,
        held=up.held and down.held,
        too_long_s=max(up.too_long_s, down.too_long_s),
    )
