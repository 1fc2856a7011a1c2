"""Makes the pictures of these pages by the commands that the pages are about.

    python docs/make_figures.py [NAME ...]

`configurations_tradeoff.png` is of `benchmarks/tradeoff.py`.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from planner.cli import main

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"
GARDEN = ROOT / "examples" / "garden.svg"
PLOTS = {
    "garden.png": ["traj.csv", "--kind", "drawing", "--drawing", str(GARDEN)],
    "speed.png": ["traj.csv", "--kind", "speed"],
    "error.png": ["traj.csv", "--kind", "error", "--drawing", str(GARDEN)],
    "phase.png": ["traj.csv", "--kind", "phase"],
    "timeline.png": ["traj.csv", "--kind", "timeline"],
    "profiles.png": ["traj.csv", "--from", "0", "--to", "10"],
    "workspace.png": ["--kind", "workspace"],
    "film.gif": ["traj.csv", "--speed-factor", "5", "--fps", "8", "--quiet", "--dpi", "50"],
}
"""What follows `plan plot` for each."""
COMPARISONS = {
    "compare_target.png": ["--target", "53", "47.8", "0"],
    "compare_drawing.png": [str(ROOT / "examples" / "harbour.svg")],
    "compare_random.png": ["--random", "100", "--seed", "7"],
}
"""What follows `plan compare`."""


def make(names: list[str]) -> None:
    """Figures by name, or all of them, in the folder of images."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        _run([str(GARDEN), "-o", "traj.csv", "--quiet"])
        for name in names or [*PLOTS, *COMPARISONS]:
            if name in PLOTS:
                _run(["plot", "--dpi", "100", *PLOTS[name], "-o", str(IMAGES / name)])
            else:
                _run(["compare", *COMPARISONS[name], "--plot", str(IMAGES / name)])


def _run(arguments: list[str]) -> None:
    if main(arguments):
        sys.exit(1)


if __name__ == "__main__":
    make(sys.argv[1:])
