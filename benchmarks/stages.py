"""Where the time of a plan goes, stage by stage, over a folder of drawings.

    python benchmarks/stages.py FOLDER [--arm NAME] [--method NAME]

One process, one run a drawing after one that warms up, each under a profiler, which makes them slower. Stages hold what
they call.
"""

from __future__ import annotations

import argparse
import cProfile
import pstats
import tempfile
import time
from collections.abc import Mapping
from pathlib import Path

from planner.drawing.svg import read_drawing
from planner.errors import PlannerError
from planner.execution.work_chunks import planned_travel_moves, timed_strokes
from planner.inverse_kinematics.stroke_configurations import joint_paths
from planner.motion.between_samples import stroke_excess
from planner.pen_drawing import PenDrawing
from planner.pipeline import plan
from planner.placement.pen_path import smoothed
from planner.progress import unreported
from planner.settings import Method, PlanSettings
from planner.timing.path_timing import minimum_time
from planner.trajectory import write_trajectory

STAGES = {
    "read": read_drawing,
    "join": PenDrawing.take,
    "order": PenDrawing.order,
    "strokes": timed_strokes,
    "of these: smooth": smoothed,
    "configurations": joint_paths,
    "timing": minimum_time,
    "tolerance": stroke_excess,
    "pen-up moves": planned_travel_moves,
    "write": write_trajectory,
}


def stages_of(drawing: Path, settings: PlanSettings) -> Mapping[str, float]:
    """Seconds of each of STAGES, and of the whole. Errors: PlannerError."""
    profile = cProfile.Profile()
    began = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder:
        profile.enable()
        try:
            write_trajectory(plan(drawing, settings, unreported).trajectory, Path(folder) / "traj.csv")
        finally:
            profile.disable()
    whole_s = time.perf_counter() - began
    spent = {
        (file, line): cumulative for (file, line, _), (_, _, _, cumulative, _) in pstats.Stats(profile).stats.items()
    }
    codes = {stage: function.__code__ for stage, function in STAGES.items()}
    return {
        **{stage: spent.get((code.co_filename, code.co_firstlineno), 0.0) for stage, code in codes.items()},
        "whole": whole_s,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--arm", default="drawing_arm")
    parser.add_argument("--method", default="path", choices=[method.value for method in Method])
    options = parser.parse_args()
    settings = PlanSettings(arm=options.arm, method=Method(options.method))
    drawings = sorted(options.folder.glob("*.svg"))
    if not drawings:
        parser.error(f"no .svg files in {options.folder}")
    columns = [*STAGES, "whole"]
    print("| drawing |" + "".join(f" {column} s |" for column in columns))
    print("|---|" + "---:|" * len(columns))
    plan(drawings[0], settings, unreported)
    for drawing in drawings:
        try:
            spent = stages_of(drawing, settings)
        except PlannerError as error:
            print(f"| {drawing.name} | {error} |")
            continue
        print(f"| {drawing.name} |" + "".join(f" {spent[column]:.2f} |" for column in columns), flush=True)


if __name__ == "__main__":
    main()
