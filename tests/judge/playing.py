"""What a true arm does with a record of pulses: frames, lag, dead band, play; and what that leaves on the sheet."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from planner.arrays import FloatArray, IntArray
from tests.judge.true_arm import TrueArm

_RUN_IN_S = 0.5


@dataclass(frozen=True, eq=False)
class Record:
    """What `plan run --record` wrote. times_s, stroke: (m,); meant_mm: (m, 2); pulses_us: (m, n)."""

    times_s: FloatArray
    stroke: IntArray
    meant_mm: FloatArray
    pulses_us: FloatArray


def read_record(path: Path) -> Record:
    with path.open() as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    table = np.array(rows[1:], dtype=float)
    assert rows[0][:4] == ["t_s", "stroke", "x_mm", "y_mm"], rows[0]
    return Record(table[:, 0], table[:, 1].astype(int), table[:, 2:4], table[:, 4:])


def play(
    arm: TrueArm, record: Record, times_s: FloatArray, rng: np.random.Generator | None = None, wander_rad: float = 0.0
) -> FloatArray:
    """(k, n) joints of the true arm at ascending times (k,).

    Within a frame a servo's goal is constant, so that its motor's way is exact: at full speed until the pull of the
    first-order lag is weaker, then exponentially to the edge of the dead band, where it rests. Joints rest until
    their gear comes to an end of the play. wander_rad: a slow random offset of every goal.
    """
    n = record.pulses_us.shape[1]
    joints = np.empty((len(times_s), n))
    start, end = record.times_s[0], record.times_s[-1] + _RUN_IN_S
    n_frames = int(np.ceil((end - start) / arm.frame_s)) + 2
    for k in range(n):
        frames = start - arm.frame_s + arm.phase_s[k] + arm.frame_s * np.arange(n_frames)
        row = np.clip(np.searchsorted(record.times_s, frames + 1e-9, side="right") - 1, 0, None)
        pulses = np.round(record.pulses_us[row, k] / arm.resolution_us) * arm.resolution_us
        whole = np.repeat(pulses[:, None], n, axis=1)
        goals = arm.angles(whole)[:, k]
        if rng is not None and wander_rad:
            goals = goals + wander_rad * _slow_noise(rng, n_frames, arm.frame_s)
        joints[:, k] = _one(arm, k, frames, goals, times_s)
    return joints


def _slow_noise(rng: np.random.Generator, count: int, period_s: float) -> FloatArray:
    knots = rng.normal(size=int(count * period_s / 2.0) + 3)
    return np.interp(np.arange(count) * period_s / 2.0, np.arange(len(knots)), knots)


def _one(arm: TrueArm, k: int, frames: FloatArray, goals: FloatArray, times_s: FloatArray) -> FloatArray:
    band, lag, top = float(arm.dead_band[k]), float(arm.lag_s[k]), arm.max_speed
    low, high = float(arm.play_low[k]), float(arm.play_high[k])
    one_side = high < 0
    motor = goals[0]
    joint = motor - low if one_side else motor
    begin = np.empty(len(frames))
    held = np.empty(len(frames))
    for f, goal in enumerate(goals.tolist()):
        begin[f], held[f] = motor, joint
        motor = motor + _advance(goal - motor, band, lag, top, arm.frame_s)
        joint = motor - low if one_side else min(max(joint, motor - low), motor + high)
    at = np.clip(np.searchsorted(frames, times_s, side="right") - 1, 0, len(frames) - 1)
    since = np.maximum(times_s - frames[at], 0.0)
    moved = begin[at] + _advances(goals[at] - begin[at], band, lag, top, since)
    if one_side:
        return moved - low
    return np.clip(held[at], moved - low, moved + high)


def _advance(error: float, band: float, lag: float, top: float, time: float) -> float:
    pull = abs(error) - band
    if pull <= 0:
        return 0.0
    fast = max(pull - top * lag, 0.0)
    spent = min(fast / top, time)
    way = top * spent
    if time > spent:
        way += (pull - way) * -np.expm1(-(time - spent) / lag)
    return way if error > 0 else -way


def _advances(error: FloatArray, band: float, lag: float, top: float, time: FloatArray) -> FloatArray:
    pull = np.maximum(np.abs(error) - band, 0.0)
    spent = np.minimum(np.maximum(pull - top * lag, 0.0) / top, time)
    way = top * spent
    way = way + (pull - way) * -np.expm1(-(time - spent) / lag)
    return np.sign(error) * way
