"""Time of each stage of a plan, and points per second, over a folder of drawings.

    python benchmarks/stages.py FOLDER [--arm NAME] [--method NAME]

One process, one run a drawing after one that warms up; a point is a vertex of the strokes as they are drawn.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any

from planner import pipeline
from planner.errors import PlannerError
from planner.motion import held_motion, line
from planner.settings import Method, PlanSettings
from planner.trajectory import write_trajectory
from planner.travel import clear_moves

STAGES = {
    "read_drawing": "read",
    "flatten_all": "flatten",
    "join_strokes": "join",
    "ordered": "order",
    "smoothed": "smooth",
    "joint_paths": "configurations",
    "minimum_time": "timing",
    "motions": "check limits",
    "plan_travel_moves": "travel moves",
}

MODULES = (pipeline, line, held_motion, clear_moves)
"""Where these are called."""


def _counted(function: Callable[..., Any], stage: str, spent: Counter[str]) -> Callable[..., Any]:
    @wraps(function)
    def run(*arguments: Any, **options: Any) -> Any:
        began = time.perf_counter()
        try:
            return function(*arguments, **options)
        finally:
            spent[stage] += time.perf_counter() - began

    return run


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--arm", default="drawing_arm")
    parser.add_argument("--method", default="path", choices=[method.value for method in Method])
    options = parser.parse_args()
    settings = PlanSettings(arm=options.arm, method=Method(options.method))
    spent: Counter[str] = Counter()
    points = 0

    def order_and_count(*arguments: Any, **keywords: Any) -> Any:
        nonlocal points
        strokes, is_finished = order(*arguments, **keywords)
        points = sum(map(len, strokes))
        return strokes, is_finished

    order = pipeline.ordered
    pipeline.ordered = order_and_count
    for name, stage in STAGES.items():
        module = next(module for module in MODULES if hasattr(module, name))
        setattr(module, name, _counted(getattr(module, name), stage, spent))
    drawings = sorted(options.folder.glob("*.svg"))
    if not drawings:
        parser.error(f"no .svg files in {options.folder}")
    columns = [*STAGES.values(), "write", "total"]
    print("| drawing | points | points/s |" + "".join(f" {column} s |" for column in columns) + " peak MB |")
    print("|---|" + "---:|" * (len(columns) + 3))
    pipeline.plan(drawings[0], settings, lambda *_: None)
    for drawing in drawings:
        spent.clear()
        began = time.perf_counter()
        try:
            planned = pipeline.plan(drawing, settings, lambda *_: None)
        except PlannerError as error:
            print(f"| {drawing.name} | {error} |")
            continue
        with tempfile.TemporaryDirectory() as folder:
            wrote = time.perf_counter()
            write_trajectory(planned.trajectory, Path(folder) / "traj.csv")
            spent["write"] = time.perf_counter() - wrote
        spent["total"] = time.perf_counter() - began
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
        times = "".join(f" {spent[column]:.2f} |" for column in columns)
        print(f"| {drawing.name} | {points} | {points / spent['total']:.0f} |{times} {peak} |", flush=True)


if __name__ == "__main__":
    main()
