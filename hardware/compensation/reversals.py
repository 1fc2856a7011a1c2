"""Where joints turn back on the way that is planned for them, and on which side of its slack each is driven."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False, slots=True)
class Drive:
    """Which way one joint is driven: `way[k]`, 1 or -1, from set point `begins[k]` on. begins[0] is 0; a joint that
    never moves has none."""

    begins: IntArray
    way: IntArray


def drive(positions: FloatArray, least: float) -> Drive:
    """The ways of one joint along its set points (n,). Turning back by less than `least` is not worth the turn.

    A turn is where the joint stops going one way; a rest before it goes the other way belongs to the first.
    """
    extreme, at, way = float(positions[0]), 0, 0
    low, high = extreme, extreme
    begins: list[int] = []
    ways: list[int] = []
    # Turning points are few: only they are looked at.
    step = np.diff(positions)
    moving = np.flatnonzero(step != 0)
    if not len(moving):
        return Drive(np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64))
    turns = moving[1:][np.sign(step[moving[1:]]) != np.sign(step[moving[:-1]])]
    candidates = np.append(turns, len(positions) - 1)
    for index, value in zip(candidates.tolist(), positions[candidates].tolist(), strict=True):
        if way == 0:
            low, high = min(low, value), max(high, value)
            if high - low > least:
                way = 1 if value == high else -1
                begins.append(0)
                ways.append(way)
                extreme, at = value, index
        elif (value - extreme) * way >= 0:
            extreme, at = value, index
        elif (extreme - value) * way > least:
            way = -way
            begins.append(at)
            ways.append(way)
            extreme, at = value, index
    return Drive(np.array(begins, dtype=np.int64), np.array(ways, dtype=np.int64))
