"""Taking up slack: set points that go ahead of a joint by its slack, on the side that it is driven from.

A joint with slack s follows u = q + way * s exactly for as long as it keeps its way. Where it turns back, u has to
cross 2 s while the joint stands. That takes time: the crossing is spread evenly about the turn, over as little time
as the joint's limits of speed and acceleration leave, so that the joint's own way hardly suffers.
"""

from __future__ import annotations

import numpy as np

from hardware.compensation.reversals import drive
from planner.arrays import FloatArray

_LEAST_SHARE = 0.1
"""Of the slack: turning back by less is left to the slack."""
_LONGER = 1.1
"""By how much the next crossing to be tried is longer."""
_ALLOWANCE = 1.0 + 1e-9


def taken_up(
    positions: FloatArray,
    slack: FloatArray,
    max_velocity: FloatArray,
    max_acceleration: FloatArray,
    period_s: float,
    rest: int,
) -> FloatArray:
    """Set points (n, n_joints) that make joints with `slack` (n_joints,) follow `positions` (n, n_joints).

    All in rad or mm; limits (n_joints,) per s and s2. The first and the last `rest` set points are at rest: in the
    course of those each joint, wherever in its slack it stands, is drawn to the far side and then pushed to that which
    it is needed on; in the course of these set points come back to where the joints are.
    """
    commanded = positions.copy()
    for k in np.flatnonzero(slack > 0).tolist():
        commanded[:, k] += _joint(
            positions[:, k],
            float(slack[k]),
            float(max_velocity[k]) * period_s * _ALLOWANCE,
            float(max_acceleration[k]) * period_s**2 * _ALLOWANCE,
            rest,
        )
    return commanded


def _joint(positions: FloatArray, slack: float, most_step: float, most_change: float, rest: int) -> FloatArray:
    """(n,) what is added to the set points of one joint. Limits are those of first and second differences."""
    course = drive(positions, _LEAST_SHARE * slack)
    first = int(course.way[0]) if len(course.way) else 1
    crossings = [(rest // 3, -first), (2 * rest // 3, 2 * first)]
    last = int(course.way[-1]) if len(course.way) else first
    crossings += [
        (begin, 2 * way) for begin, way in zip(course.begins.tolist()[1:], course.way.tolist()[1:], strict=True)
    ]
    crossings.append((len(positions) - rest // 2, -last))
    steps = np.diff(positions, prepend=positions[0])  # of the set points, crossings included as they are found
    for at, by in crossings:
        _cross(steps, at, by * slack, most_step, most_change)
    added: FloatArray = positions[0] + np.cumsum(steps) - positions
    return added


def _cross(steps: FloatArray, at: int, by: float, most_step: float, most_change: float) -> None:
    """Add a crossing `by` about set point `at` to the steps, as sudden as limits allow."""
    n = len(steps)
    count = max(int(np.ceil(2 * np.sqrt(abs(by) / most_change))), 1)
    while True:
        begin = min(max(at - count // 2, 0), max(n - 1 - count, 0))
        window = slice(begin + 1, min(begin + count + 1, n))
        crossing = by * np.diff(_step(np.arange(window.stop - begin) / count))
        around = steps[max(window.start - 1, 0) : min(window.stop + 1, n)].copy()
        first = window.start - max(window.start - 1, 0)
        around[first : first + len(crossing)] += crossing
        if np.abs(around).max() <= most_step and np.abs(np.diff(around)).max(initial=0.0) <= most_change:
            break
        if count >= n:  # at its limits all along: such a joint cannot be hurried
            break
        count = min(max(count + 1, int(_LONGER * count)), n)
    steps[window] += crossing


def _step(u: FloatArray) -> FloatArray:
    """From 0 at 0 to 1 at 1, with the least acceleration: 2 u^2, then the same from the end."""
    u = np.clip(u, 0.0, 1.0)
    return np.where(u < 0.5, 2 * u**2, 1 - 2 * (1 - u) ** 2)
