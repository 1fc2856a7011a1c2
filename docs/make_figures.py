"""Makes the pictures of these pages by the commands that the pages are about.

    python docs/make_figures.py [NAME ...]

`postures_tradeoff.png` is of `benchmarks/tradeoff.py`.
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
FIGURES = {
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


def make(names: list[str]) -> None:
    """Figures by name, or all of them, in the folder of images."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        if main([str(GARDEN), "-o", "traj.csv", "--quiet"]):
            sys.exit(1)
        for name in names or FIGURES:
            if main(["plot", "--dpi", "100", *FIGURES[name], "-o", str(IMAGES / name)]):
                sys.exit(1)


if __name__ == "__main__":
    make(sys.argv[1:])
