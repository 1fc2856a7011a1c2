"""How well it drew, and what a photo or a ruler would find."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from planner.arrays import FloatArray
from tests.judge.playing import Record, play
from tests.judge.true_arm import TrueArm

INK_MM = 1.5
"""A sprung pen leaves ink up to so far above the paper, and is crushed so far below."""
_WINDOW = 30


@dataclass(frozen=True)
class Verdict:
    """Errors of the tip across the sheet, in the sheet's own frame, in mm, and shares of the drawn time.

    rms, p95: against where the pen was to be at that moment. path_rms: against the nearest point of the line that was
    to be drawn, within a third of a second.
    """

    rms: float
    p95: float
    path_rms: float
    path_p95: float
    missing: float
    crushed: float
    height_sd: float


def judge(arm: TrueArm, record: Record, rng: np.random.Generator | None = None, wander_rad: float = 0.0) -> Verdict:
    tip = arm.tip_mm(play(arm, record, record.times_s, rng, wander_rad))
    drawn = record.stroke >= 0
    error = tip[:, :2] - record.meant_mm
    size = np.hypot(*error[drawn].T)
    near = _to_line(tip[:, :2], record)[drawn]
    height = tip[drawn, 2]
    return Verdict(
        float(np.sqrt(np.mean(size**2))),
        float(np.percentile(size, 95)),
        float(np.sqrt(np.mean(near**2))),
        float(np.percentile(near, 95)),
        float(np.mean(height > INK_MM)),
        float(np.mean(height < -INK_MM)),
        float(height.std()),
    )


def _to_line(tip_mm: FloatArray, record: Record) -> FloatArray:
    """(m,) distance of each tip to the meant line of its own stroke nearby in time."""
    m = len(tip_mm)
    best = np.full(m, np.inf)
    rows = np.arange(m)
    for shift in range(-_WINDOW, _WINDOW):
        a, b = np.clip(rows + shift, 0, m - 1), np.clip(rows + shift + 1, 0, m - 1)
        same = (record.stroke[a] == record.stroke) & (record.stroke[b] == record.stroke)
        p, q = record.meant_mm[a], record.meant_mm[b]
        along = q - p
        t = np.clip(((tip_mm - p) * along).sum(1) / np.maximum((along**2).sum(1), 1e-12), 0, 1)
        away = np.hypot(*(tip_mm - p - t[:, None] * along).T)
        best = np.where(same, np.minimum(best, away), best)
    return best


def measured(
    arm: TrueArm,
    record: Record,
    times_s: FloatArray,
    rng: np.random.Generator,
    sd_mm: float = 0.15,
    height_sd_mm: float | None = None,
) -> FloatArray:
    """(k, 3) x, y, h of the tip at the marks' times, with noise, as a photo or a ruler gives them."""
    order = np.argsort(times_s)
    tips = np.empty((len(times_s), 3))
    tips[order] = arm.tip_mm(play(arm, record, times_s[order]))
    spread = np.array([sd_mm, sd_mm, sd_mm if height_sd_mm is None else height_sd_mm])
    return tips + rng.normal(size=tips.shape) * spread
