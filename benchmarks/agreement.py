"""Plans with random options, and what `plan check` says of them: every plan that comes out has to pass.

    python benchmarks/agreement.py --plans 400 --seed 1

Arm, method, rate, tolerance, speeds and drawing are drawn at random. A plan that is refused with a sentence counts as
refused; one that the check faults, and any other exception, is a failure and is listed with all that is needed to make
it again.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from planner.arms.arm_file import known_arms, load_arm
from planner.arrays import FloatArray
from planner.checking.check import check_trajectory
from planner.drawing.svg import read_drawing
from planner.errors import PlannerError
from planner.pipeline import plan
from planner.settings import Method, PlanSettings

_SLOW_S = 10.0


def drawing_of(rng: np.random.Generator) -> str:
    """An SVG of a few strokes of any kind: straight, round, jagged, there and back, tiny, a tap."""
    strokes = [_stroke(rng) for _ in range(rng.integers(1, 5))]
    paths = "".join("<path d='M" + " L".join(f"{x:.5g} {y:.5g}" for x, y in stroke) + "'/>" for stroke in strokes)
    return f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>{paths}</svg>"


def _stroke(rng: np.random.Generator) -> FloatArray:
    start, end = rng.uniform(0.0, 100.0, (2, 2))
    match rng.integers(6):
        case 0:
            return np.stack((start, end))
        case 1:
            angles = np.linspace(0.0, rng.uniform(1.0, 7.0), 60)
            return start + rng.uniform(0.05, 30.0) * np.column_stack((np.cos(angles), np.sin(angles)))
        case 2:
            return start + np.cumsum(rng.normal(scale=10.0 ** rng.uniform(-2.0, 1.0), size=(20, 2)), axis=0)
        case 3:
            return np.stack((start, end, start + rng.normal(scale=0.05, size=2)))
        case 4:
            return np.stack((start, start + rng.normal(scale=0.02, size=2)))
        case _:
            return np.stack((start, start))


def settings_of(rng: np.random.Generator) -> PlanSettings:
    return PlanSettings(
        arm=str(rng.choice(known_arms())),
        method=Method(rng.choice([method.value for method in Method])),
        rate_hz=float(np.round(10.0 ** rng.uniform(np.log10(50.0), 3.0), 3)),
        tolerance_mm=float(np.round(10.0 ** rng.uniform(np.log10(0.005), np.log10(0.1)), 5)),
        speed_mm_s=float(np.round(10.0 ** rng.uniform(1.0, 2.6), 2)),
        lowering_speed_mm_s=float(np.round(10.0 ** rng.uniform(0.7, 2.3), 2)),
        margin_mm=float(rng.choice([0.0, 5.0])),
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--plans", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first plan")
    options = parser.parse_args()
    counts: Counter[str] = Counter()
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "drawing.svg"
        for number in range(options.first, options.first + options.plans):
            rng = np.random.default_rng((options.seed, number))
            settings, svg = settings_of(rng), drawing_of(rng)
            file.write_text(svg, encoding="utf-8")
            started = time.perf_counter()
            counts[_outcome(file, settings, number)] += 1
            if time.perf_counter() - started > _SLOW_S:
                print(f"{number} took {time.perf_counter() - started:.0f} s: {settings}")
    print(
        ", ".join(f"{count} {outcome}" for outcome, count in sorted(counts.items())),
        f"in {time.perf_counter() - begin:.0f} s",
    )


def _outcome(file: Path, settings: PlanSettings, number: int) -> str:
    try:
        planned = plan(file, settings, lambda *_: None)
    except PlannerError as error:
        print(f"{number} refused: {settings.arm} {settings.method}: {error}")
        return "refused with a sentence"
    except Exception as error:
        print(f"{number} BROKE: {type(error).__name__}: {error}\n  {settings}\n  {file.read_text()}", flush=True)
        return "BROKEN"
    check_result = check_trajectory(
        planned.trajectory, load_arm(settings.arm), read_drawing(file), settings.tolerance_mm
    )
    for warning in planned.summary.warnings:
        print(f"{number} says: {warning}")
    if check_result.passed:
        return "passed"
    faults = "\n  ".join(map(str, check_result.faults))
    print(f"{number} FAULTED: {settings}\n  {faults}\n  {file.read_text()[:1500]}", flush=True)
    return "FAULTED"


if __name__ == "__main__":
    main()
