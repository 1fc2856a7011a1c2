"""Mutation score of the check: kinds of seeded faults on good trajectories of some arms, and how many it finds.

    python benchmarks/check_mutations.py --arms drawing_arm scara six_joint --rates 100 1000

Prints what got through, and which laws found each kind with --laws. Exit code 1 where anything got through, or where an
unspoilt trajectory is refused.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from planner.arms.arm_file import load_arm
from planner.drawing.svg import read_drawing
from planner.pipeline import plan
from planner.settings import PlanSettings
from tests.checking.mutations import MUTATIONS
from tests.checking.other_drawings import DRAWING, extra_plans
from tests.checking.sheet import Sheet


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--arms", nargs="+", default=["drawing_arm", "scara", "six_joint"])
    parser.add_argument("--rates", nargs="+", type=float, default=[100.0])
    parser.add_argument("--laws", action="store_true", help="print the laws that found each kind")
    options = parser.parse_args()
    asked = through = 0
    with tempfile.TemporaryDirectory() as folder:
        drawing_file, file = Path(folder, "drawing.svg"), Path(folder, "traj.csv")
        for arm in options.arms:
            for rate_hz in options.rates:
                settings = PlanSettings(arm=arm, rate_hz=rate_hz)
                drawing_file.write_text(DRAWING)
                drawing = read_drawing(drawing_file)
                planned = plan(drawing_file, settings, lambda *_: None).trajectory
                sheets = {kind: mutate(Sheet.of(planned, load_arm(arm), drawing)) for kind, mutate in MUTATIONS.items()}
                unspoilt = Sheet.of(planned, load_arm(arm), drawing).found(file)
                if unspoilt:
                    print(f"{arm} at {rate_hz:g} Hz: the unspoilt trajectory breaks {unspoilt}")
                    through += 1
                for kind, text in extra_plans(DRAWING).items():
                    drawing_file.write_text(text)
                    other = plan(drawing_file, settings, lambda *_: None).trajectory
                    sheets[kind] = Sheet.of(other, load_arm(arm), drawing)
                for kind, sheet in sheets.items():
                    if sheet is None:
                        continue
                    asked += 1
                    laws = sheet.found(file)
                    through += not laws
                    if not laws:
                        print(f"{arm} at {rate_hz:g} Hz: got through: {kind}")
                    elif options.laws:
                        print(f"{arm} at {rate_hz:g} Hz: {kind}: {', '.join(sorted(laws))}")
                kinds = sum(sheet is not None for sheet in sheets.values())
                print(f"{arm} at {rate_hz:g} Hz: {kinds} kinds", flush=True)
    print(f"{asked - through} of {asked} found")
    return 1 if through else 0


if __name__ == "__main__":
    sys.exit(main())
