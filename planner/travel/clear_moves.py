"""Travel moves as a drawing needs them: with a change of branch where there has to be one, and told where links would
collide."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from planner.kinematics.link_clearance import LinkClearance
from planner.motion.timed_stroke import Contact
from planner.redundancy.arm_model import ArmModel
from planner.settings import Timing
from planner.travel.branch_change import keeps_branch, plan_branch_change, plan_by_air
from planner.travel.travel_moves import TravelMove, TravelRules, plan_travel_moves, require_bounded_travel_moves


def clear_travel_moves(
    model: ArmModel, rules: TravelRules, starts: Sequence[Contact | None], ends: Sequence[Contact | None]
) -> list[TravelMove]:
    """The travel move from each start to the end of the same index, as `plan_travel_moves` has them. Errors: UsageError
    where one would last for longer than a move may."""
    kinematics, limits = model.kinematics, model.limits
    if rules.timing is Timing.RUCKIG:
        return _by_air(model, rules, starts, ends)
    moves = _with_collisions(model.clearance, plan_travel_moves(kinematics, limits, rules, starts, ends))
    for index, (move, start, end) in enumerate(zip(moves, starts, ends, strict=True)):
        if start and end:
            stays = keeps_branch(kinematics, move, limits, rules, end)
            if not stays or move.collision:
                change = plan_branch_change(kinematics, limits, rules, start, end)
                moves[index] = change if change.exact or not stays else move
    require_bounded_travel_moves(moves, rules)
    return _with_collisions(model.clearance, moves)


def _by_air(
    model: ArmModel, rules: TravelRules, starts: Sequence[Contact | None], ends: Sequence[Contact | None]
) -> list[TravelMove]:
    """Up, straight in joint space at rest to rest, and down; as usual where there is no such way."""
    usual = replace(rules, timing=Timing.OPTIMAL)
    both = [index for index, pair in enumerate(zip(starts, ends, strict=True)) if all(pair)]
    moves = clear_travel_moves(model, usual, starts, ends)
    by_air = plan_by_air(
        model.kinematics,
        model.limits,
        rules,
        [start for start in (starts[index] for index in both) if start],
        [end for end in (ends[index] for index in both) if end],
    )
    for index, move in zip(both, _with_collisions(model.clearance, by_air), strict=True):
        if move.exact and not (move.collision or move.too_long_s):
            moves[index] = move
    return moves


def _with_collisions(clearance: LinkClearance, moves: Sequence[TravelMove]) -> list[TravelMove]:
    collisions = clearance.collisions([move.joints for move in moves])
    return [replace(move, collision=collision) for move, collision in zip(moves, collisions, strict=True)]
