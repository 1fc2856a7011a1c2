"""Between two pens: from the end of what one drew to the park pose, a rest there, and on to where the next begins."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from planner.errors import PlanError
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits
from planner.travel.air_way import air_leg, air_way
from planner.travel.travel_moves import TravelRules

_REST_S = 0.4
"""At rest there: who plays it holds in the middle. Set points go ahead of joints by a part of that at most."""


@dataclass(frozen=True, eq=False, slots=True)
class PenChange:
    """joints: (n, n_joints) from rest to rest, both ends included. rest: the sample at which somebody changes the pen;
    None where nobody does."""

    joints: FloatArray
    rest: int | None


def plan_pen_change(
    before: Kinematics,
    after: Kinematics,
    limits: Limits,
    rules: TravelRules,
    start: FloatArray,
    end: FloatArray,
    park: FloatArray | None,
    delay_s: float = 0.0,
) -> PenChange:
    """From configuration `start` (n_joints,) through `park`, or straight where it is None, to `end`, and a rest there.
    before, after: of the arm with the one pen and with the other. Errors: PlanError where no way clear of the paper is
    found."""
    delay = np.repeat(end[None], round(delay_s * rules.rate_hz), axis=0)
    if park is None:
        return PenChange(np.concatenate((start[None], _leg(after, limits, rules, start, end), delay)), None)
    out, back = _leg(before, limits, rules, start, park), _leg(after, limits, rules, park, end)
    n_rest = max(round(_REST_S * rules.rate_hz), 3)
    rest = np.repeat(park[None], n_rest, axis=0)
    joints = np.concatenate((start[None], out, rest, back, delay))
    return PenChange(joints, 1 + len(out) + n_rest // 2)


def _leg(kinematics: Kinematics, limits: Limits, rules: TravelRules, start: FloatArray, end: FloatArray) -> FloatArray:
    """(n, n_joints) samples after `start` up to `end`; none where they are the same."""
    if np.allclose(start, end, rtol=0.0, atol=1e-9):
        return np.empty((0, len(start)))
    corners = kinematics.arm.complete(
        air_way(kinematics, limits, rules, kinematics.independent_of(start), kinematics.independent_of(end))
    )
    if len(corners) < 2:
        raise PlanError(
            f"no way clear of the paper was found to the park pose of {kinematics.arm.name}, where pens are changed;"
            " give its file another [park], or plan each pen by itself (--layers)"
        )
    return np.concatenate([air_leg(limits, rules, corners[k], corners[k + 1])[1:] for k in range(len(corners) - 1)])
