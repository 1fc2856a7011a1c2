"""False alarms of the check: random drawings are planned, written, read and checked; none may be refused.

    python benchmarks/check_alarms.py --count 500 --seed 1

Each trajectory has an arm, a method, a rate, a tolerance and a number of decimals of its own. What the planner cannot
plan does not count.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from planner.arms.arm_file import load_arm
from planner.drawing.svg import read_drawing
from planner.errors import PlannerError
from planner.pipeline import plan
from planner.settings import Method, PlanSettings
from tests.checking.scribbles import random_drawing
from tests.checking.sheet import Sheet

ARMS = ("drawing_arm", "scara", "six_joint", "three_joint", "stanford", "so101", "drawing_arm_2022")
METHODS = (Method.PATH, Method.PATH, Method.PATH, Method.DLS, Method.NLP, Method.CLOSED_FORM)
RATES_HZ = (100.0, 100.0, 100.0, 100.0, 100.0, 73.0, 200.0, 500.0, 1000.0)
DECIMALS = (6, 7, 9, 9)
TOLERANCES_MM = (0.05, 0.05, 0.05, 0.1, 0.5)
EXAMPLES = tuple(sorted((Path(__file__).resolve().parent.parent / "examples").glob("*.svg")))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    good = refused = unplanned = 0
    began_s = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        drawing_file, file = Path(folder, "drawing.svg"), Path(folder, "traj.csv")
        for index in range(options.count):
            settings = PlanSettings(
                arm=str(rng.choice(ARMS)),
                method=Method(rng.choice(METHODS)),
                rate_hz=float(rng.choice(RATES_HZ)),
                tolerance_mm=float(rng.choice(TOLERANCES_MM)),
                rotate_deg=float(rng.choice((0.0, 0.0, 90.0, 17.5))),
                fit=bool(rng.random() < 0.8),
                skip_unreachable=bool(rng.random() < 0.2),
            )
            n_things = int(rng.integers(1, 6))
            text = EXAMPLES[index].read_text() if index < len(EXAMPLES) else random_drawing(rng, n_things)
            drawing_file.write_text(text)
            try:
                trajectory = plan(drawing_file, settings, lambda *_: None).trajectory
            except PlannerError as error:
                unplanned += 1
                print(f"{index}: not planned: {str(error)[:150]}", flush=True)
                continue
            decimals = int(rng.choice(DECIMALS))
            sheet = Sheet.of(trajectory, load_arm(settings.arm), read_drawing(drawing_file), decimals)
            laws = sheet.found(file, settings.tolerance_mm)
            good += not laws
            if good % 50 == 0:
                print(f"{good} passed after {time.monotonic() - began_s:.0f} s", flush=True)
            if laws:
                refused += 1
                kept = Path(tempfile.gettempdir(), f"alarm_{options.seed}_{index}.svg")
                kept.write_text(text)
                print(f"{index}: {settings}, {decimals} decimals\n  {kept}: {laws}", flush=True)
    print(f"{good} passed, {refused} refused, {unplanned} could not be planned; {time.monotonic() - began_s:.0f} s")


if __name__ == "__main__":
    main()
