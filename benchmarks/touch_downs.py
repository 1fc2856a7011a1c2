"""Two ways for a pen to feel how high it is over the paper, on true arms that were never calibrated.

    python benchmarks/touch_downs.py [--arms 8] [--marks 30]

A slanted stroke, whose ink begins the later the higher the tip is, and a row of taps, each half a millimetre lower,
of which the first that leaves ink tells the height. Both come from above to the same place, at which the tip's true
height is known. What is told is where the ink is on the sheet, and nothing of the arm.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from hardware.compensation.servo_values import pulse_calibration  # noqa: E402
from planner.arms.arm_file import load_arm  # noqa: E402
from planner.arrays import FloatArray  # noqa: E402
from planner.error_model.pattern.candidates import candidates  # noqa: E402
from planner.error_model.pattern.touch import SLOPE, Heights  # noqa: E402
from planner.kinematics.projection import project  # noqa: E402
from planner.redundancy.arm_model import ArmModel  # noqa: E402
from tests.judge.playing import Record, play  # noqa: E402
from tests.judge.true_arm import TrueArm, random_arm  # noqa: E402

RATE_HZ = 100.0
STEP_MM = 0.5
TAP_S, STROKE_S, DWELL_S = 0.35, 1.5, 1.0
TAPPED_FROM_MM = 5.0


def legs(corners: FloatArray, durations_s: FloatArray) -> FloatArray:
    """(n, 3) tips from corner to corner (k, 3), from rest to rest."""
    ways = []
    for begin, end, duration in zip(corners[:-1], corners[1:], durations_s, strict=True):
        u = np.arange(1, round(duration * RATE_HZ) + 1)[:, None] / round(duration * RATE_HZ)
        ways.append(begin + u**3 * (10 - 15 * u + 6 * u**2) * (end - begin))
    return np.concatenate((corners[:1], *ways))


def slanted(mark: FloatArray, way: FloatArray, heights: Heights) -> FloatArray:
    begin, reach = mark - heights.length_mm * way, heights.reach_mm
    end = (*mark, -reach)
    corners = np.array([(*begin, heights.lift_mm), (*begin, reach), end, end])
    return legs(corners, np.array([0.4, STROKE_S, DWELL_S]))


def taps(mark: FloatArray, way: FloatArray, heights: Heights) -> tuple[FloatArray, FloatArray]:
    """Tips, and the depths that the taps go to, ascending in time."""
    depths = np.arange(heights.reach_mm, -heights.reach_mm - 1e-9, -STEP_MM)
    places = mark - 0.8 * np.arange(len(depths))[::-1, None] * way
    corners = [(*places[0], heights.lift_mm)]
    for place, depth in zip(places, depths, strict=True):
        corners += [(*place, depth + TAPPED_FROM_MM), (*place, depth)]
    corners.append(corners[-1])
    return legs(np.array(corners), np.array([TAP_S] * (len(corners) - 2) + [DWELL_S])), depths


class Trial:
    """A true arm that is told to move its tip as an arm file has it."""

    def __init__(self, model: ArmModel, true: TrueArm) -> None:
        self._model, self._true = model, true

    def drawn(self, tips_mm: FloatArray, free: FloatArray) -> FloatArray | None:
        """(n, 3) the tips that come of it; None where the arm cannot."""
        arm = self._model.arm
        found, exact = project(self._model.kinematics, np.repeat(free[None], len(tips_mm), axis=0), tips_mm)
        joints = arm.complete(found)
        if not exact.all() or (joints < arm.minimum).any() or (joints > arm.maximum).any():
            return None
        n = len(tips_mm)
        times_s = np.arange(n) / RATE_HZ
        told = Record(times_s, np.zeros(n, dtype=np.int64), tips_mm[:, :2], pulse_calibration(arm).to_servos(joints))
        return self._true.tip_mm(play(self._true, told, times_s))


def by_stroke(tips: FloatArray, way: FloatArray, paper_mm: float) -> float | None:
    """What a stroke tells of the height at its end."""
    down = tips[:, 2] <= paper_mm
    if down[40] or not down[-1]:
        return None
    begin = tips[int(np.argmax(down)), :2]
    return -SLOPE * float((tips[-1, :2] - begin) @ way)


def by_taps(tips: FloatArray, depths: FloatArray, paper_mm: float) -> float | None:
    """What a row of taps tells of the height at the last one."""
    samples = round(TAP_S * RATE_HZ)
    lowest = [
        tips[2 * samples * k + samples : 2 * samples * (k + 1) + samples + 1, 2].min() for k in range(len(depths))
    ]
    inked = np.flatnonzero(np.array(lowest) <= paper_mm)
    if not len(inked) or inked[0] == 0:
        return None
    return float(depths[-1] - depths[inked[0]]) - STEP_MM / 2


def compare(n_arms: int, n_marks: int) -> None:
    arm = load_arm("drawing_arm_2022")
    model, heights, random = ArmModel(arm), Heights.for_arm(arm), np.random.default_rng(0)
    pool = candidates(model, heights, 1.0, n_marks, random)
    errors: dict[str, list[float]] = {"slanted stroke": [], "row of taps": []}
    for seed in range(n_arms):
        trial = Trial(model, random_arm(arm, np.random.default_rng(seed)))
        for mark, begin, free in zip(pool.tips_mm, pool.begins_mm, pool.free, strict=True):
            way = (mark - begin) / np.linalg.norm(mark - begin)
            tapped, depths = taps(mark, way, heights)
            ways = [trial.drawn(tips, free) for tips in (slanted(mark, way, heights), tapped)]
            if ways[0] is None or ways[1] is None:
                continue
            # As the card leaves it: the paper is where this arm's tip is on average meant to be.
            paper_mm = float(ways[0][-1, 2]) + heights.reach_mm + random.normal(0.0, 1.5)
            found = by_stroke(ways[0], way, paper_mm), by_taps(ways[1], depths, paper_mm)
            for name, told, tips in zip(errors, found, ways, strict=True):
                if told is not None:
                    errors[name].append(told - float(tips[-1, 2] - paper_mm))
    print("| | heights told | off by, rms | median | mean |\n|---|---|---|---|---|")
    for name, off in errors.items():
        figures = np.sqrt(np.mean(np.square(off))), np.median(np.abs(off)), np.mean(off)
        print(f"| {name} | {len(off)} | " + " | ".join(f"{value:.2f} mm" for value in figures) + " |")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arms", type=int, default=8)
    parser.add_argument("--marks", type=int, default=30)
    given = parser.parse_args()
    compare(given.arms, given.marks)
