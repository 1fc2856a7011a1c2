"""What the pen of a true arm leaves on the sheet: wherever its nib is on the paper, wanted or not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from tests.judge.playing import Record, play
from tests.judge.true_arm import TrueArm

_STEP_S = 0.005
_LINE_MM, _BLOT_MM = 0.35, 0.25
_SOAKING_S = 0.3
_FINE_MM = 0.03


@dataclass(frozen=True, eq=False)
class Nib:
    """A sprung felt nib: it touches at the height 0 of the tip, and gives below. It blots where it rests.

    give_mm: how far behind the holder friction keeps it.
    """

    give_mm: float = 0.1


@dataclass(frozen=True, eq=False)
class Trace:
    """Ink along a polyline. points_mm: (n, 2) on the sheet; width_mm: (n,)."""

    points_mm: FloatArray
    width_mm: FloatArray


def inked(arm: TrueArm, record: Record, nib: Nib | None = None) -> list[Trace]:
    """All that is on the sheet after a record was played, in the order that it was drawn in."""
    times_s = np.arange(record.times_s[0], record.times_s[-1], _STEP_S)
    return traces(arm.tip_mm(play(arm, record, times_s)), _STEP_S, nib)


def traces(tips_mm: FloatArray, step_s: float, nib: Nib | None = None) -> list[Trace]:
    """What a tip that was at (m, 3) mm over the sheet, so many seconds after each other, leaves on it."""
    down = tips_mm[:, 2] <= 0.0
    starts, ends = (np.flatnonzero(np.diff(np.concatenate(([0], down.astype(int), [0]))) == sign) for sign in (1, -1))
    return [_trace(tips_mm[start:end, :2], step_s, nib or Nib()) for start, end in zip(starts, ends, strict=True)]


def _trace(holder_mm: FloatArray, step_s: float, nib: Nib) -> Trace:
    """The ink of one touch of the paper, from first to last contact."""
    place = holder_mm[0].copy()
    points, rests = [place.copy()], [0.0]
    for at in holder_mm:
        away = at - place
        behind = float(np.hypot(*away))
        if behind > nib.give_mm:
            place = place + away * (1 - nib.give_mm / behind)
        if np.hypot(*(place - points[-1])) > _FINE_MM:
            points.append(place.copy())
            rests.append(0.0)
        rests[-1] += step_s
    soaked = -np.expm1(-np.array(rests) / _SOAKING_S)
    return Trace(np.array(points), _LINE_MM + _BLOT_MM * soaked)
