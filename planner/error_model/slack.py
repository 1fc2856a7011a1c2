"""Slack between what a servo is told and where its joint stands: the play operator.

A joint with slack s stays where it is while its set point u moves within s of it, and is dragged along beyond:
`p <- min(max(p, u - s), u + s)`. Play of the gears and the dead band of the servo, one after the other, are one such
slack: the sum of the two. Where a joint stands depends on the turning points of its set points alone, not on time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False, slots=True)
class Course:
    """The course of one joint's set points, told by its turning points, up to some moments.

    turns: indices of set points, ascending: the first one, every turning point, and the moments. moments: (m,) places
    in `turns` of the set points that are asked about.
    """

    turns: IntArray
    moments: IntArray

    @staticmethod
    def of(told: FloatArray, rows: IntArray) -> Course:
        """told: (n,) what one servo is told, in any unit that its position goes with one way. rows: (m,)."""
        moving = np.flatnonzero(np.diff(told, prepend=told[0]) != 0)  # first set points after a change
        way = np.sign(np.diff(told, prepend=told[0]))[moving]
        turning = moving[1:][way[1:] != way[:-1]] - 1  # a rest before a turn counts to the turn
        turns = np.unique(np.concatenate(([0], turning, rows)))
        return Course(turns, np.searchsorted(turns, rows))

    def standing(self, set_points: FloatArray, slack: float) -> tuple[FloatArray, IntArray, FloatArray]:
        """Where the joint stands at the moments, and what brought it there.

        set_points: (n_turns,) of the joint, at `turns`. Returns its positions (m,), the place in `turns` of the set
        point that moved it last (m,), and on which side of that it stands (m,): position = set point + side * slack.
        """
        position, mover, side = set_points[0], 0, 0.0
        positions, movers, sides = (
            np.empty(len(self.turns)),
            np.empty(len(self.turns), dtype=np.int64),
            np.empty(len(self.turns)),
        )
        for k, u in enumerate(set_points.tolist()):
            if position < u - slack:
                position, mover, side = u - slack, k, -1.0
            elif position > u + slack:
                position, mover, side = u + slack, k, 1.0
            positions[k], movers[k], sides[k] = position, mover, side
        return positions[self.moments], movers[self.moments], sides[self.moments]


def followed(set_points: FloatArray, slack: FloatArray) -> FloatArray:
    """(n, n_joints) where joints stand that are told to be at `set_points` (n, n_joints), with slack (n_joints,)."""
    positions = np.empty_like(set_points)
    now = set_points[0]
    for k, u in enumerate(set_points):
        now = np.minimum(np.maximum(now, u - slack), u + slack)
        positions[k] = now
    return positions
