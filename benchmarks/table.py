"""The planner beside its targets and its rivals, as one table: same machine, same run.

    python benchmarks/table.py FOLDER_OF_DRAWINGS [-o docs/benchmarks.md] [--only ROWS ...] [--drawing NAME ...]

The rivals come with the extra `benchmark`; a row whose rival is not installed says so. Rows about one drawing take
prague.svg of the folder, or the drawing with the most bytes. Without --only all is measured but million-points,
long-stroke and redundancy, which take long.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
import time
from collections.abc import Callable, Sequence
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from benchmarks.targets import (
    art,
    commands,
    configurations,
    copp_socp,
    far,
    joint,
    order,
    redundancy,
    scale,
    speed,
    spiral,
    third_order,
    whole,
)
from benchmarks.targets.row import Row, Table, markdown
from benchmarks.targets.strokes import drawings
from planner.arms.arm_file import load_arm
from planner.errors import PlannerError
from planner.motion.speed_limit import pen_speed_mm_s
from planner.settings import PlanSettings

Measure = Callable[[Sequence[Path], Path, PlanSettings], Sequence[Row | Table]]
"""Drawings, the one drawing, and settings to what is measured."""

MEASURES: dict[str, Measure] = {
    "art": lambda files, _, settings: art.art(files, settings),
    "pen-down": lambda _, drawing, settings: art.pen_down(drawing, settings),
    "joint": lambda _, drawing, settings: joint.against_joint_optimum(drawing, settings),
    "spiral": lambda _, __, settings: spiral.against_optimum(settings),
    "optimum": lambda files, _, settings: third_order.against_optimum(files, settings),
    "copp": lambda _, __, settings: copp_socp.against_copp(settings),
    "between": lambda files, _, settings: whole.limits_between(files, settings),
    "dls": lambda _, drawing, settings: configurations.against_dls(drawing, settings),
    "redundancy": lambda _, drawing, settings: redundancy.against_brute_force(drawing, settings),
    "limits": lambda _, drawing, settings: configurations.limits_of_narrow_arms(drawing, settings),
    "order": lambda files, _, settings: order.against_lkh(files, settings),
    "tolerance": lambda _, drawing, settings: whole.tolerances(drawing, settings),
    "configurations": lambda _, drawing, settings: speed.configurations(drawing, settings),
    "far": lambda _, __, ___: far.far_targets(),
    "small-again": lambda _, __, settings: commands.small_again(settings),
    "icons": lambda _, __, settings: commands.icons(settings),
    "end-to-end": lambda _, drawing, settings: commands.end_to_end(drawing, settings),
    "million-points": lambda _, drawing, settings: scale.many_strokes(drawing, settings),
    "long-stroke": lambda _, __, settings: scale.one_stroke(settings),
}
LONG = ("million-points", "long-stroke", "redundancy")
"""Take long, change seldom, and are measured only where they are named."""
MARK = "<!-- from here on by benchmarks/table.py -->"
"""What stands above it on a page is kept."""
LIBRARIES = ("numpy", "scipy", "casadi", "ruckig", "toppra", "copp-py", "elkai")


def machine() -> str:
    """Processor, cores, Python and library versions."""
    versions = []
    for library in LIBRARIES:
        try:
            versions.append(f"{library} {version(library)}")
        except PackageNotFoundError:
            versions.append(f"no {library}")
    return (
        f"{_processor()}, {os.cpu_count()} cores; {platform.system()}, Python {platform.python_version()}; "
        + ", ".join(versions)
    )


def _processor() -> str:
    try:
        described = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in described if line.startswith("model name")]
    return names[0] if names else platform.machine()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", type=Path, help="Markdown file; without it, standard output")
    parser.add_argument("--only", action="append", choices=list(MEASURES), help="measure this alone; may be repeated")
    parser.add_argument("--drawing", action="append", help="take this drawing alone, by its name; may be repeated")
    parser.add_argument("--arm", default=PlanSettings().arm)
    options = parser.parse_args()
    found = [one for one in drawings(options.folder) if options.drawing is None or one.stem in options.drawing]
    if not found:
        parser.error(f"no such .svg files in {options.folder}")
    drawing = next((one for one in found if one.stem == "prague"), max(found, key=lambda one: one.stat().st_size))
    settings = PlanSettings(arm=options.arm)
    rows: list[Row | Table] = []
    for name in options.only or [name for name in MEASURES if name not in LONG]:
        began = time.perf_counter()
        try:
            measured = list(MEASURES[name](found, drawing, settings))
        except PlannerError as error:
            measured = [Row(name, "", str(error))]
        rows += measured
        print(
            f"{name}: {time.perf_counter() - began:.1f} s",
            *(row.markdown() for row in measured),
            sep="\n",
            file=sys.stderr,
            flush=True,
        )
    text = "\n".join(
        [
            f"{datetime.now(UTC):%Y-%m-%d}. {machine()}.",
            "",
            f"Arm {settings.arm}, {len(found)} drawings, tolerance {settings.tolerance_mm:g} mm, pen at most"
            f" {pen_speed_mm_s(load_arm(settings.arm), settings):g} mm/s. Made by `python benchmarks/table.py`.",
            "",
            markdown(rows),
            "",
        ]
    )
    if options.output is None:
        print(text)
    else:
        options.output.write_text(f"{_kept(options.output)}{MARK}\n\n{text}", encoding="utf-8")


def _kept(page: Path) -> str:
    """What a page that is there already says before its table."""
    return page.read_text(encoding="utf-8").partition(MARK)[0] if page.exists() else "# Benchmarks\n\n"


if __name__ == "__main__":
    main()
