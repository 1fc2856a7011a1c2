"""Drawings on streaming controllers that die or are reset at random, resumed until they are done.

    python -m benchmarks.soak.streaming --drawings 300

Each drawing is interrupted about five times, at any byte, while its line stays up. What is on the paper at the end is
held against the plan: nothing may be lost, nothing be further off than the controller's resolution lets it be, nothing
claimed before it is there, nothing drawn twice that no journal had in doubt. Time, line and controller are models; the
rest is `plan run`. A few of them are in the tests.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import sys
import tempfile
from pathlib import Path

import numpy as np

from planner.cli import main as plan
from tests.hardware.drivers.streaming.soak import Outcome, Soak

_DRIVERS = ("maestro", "ssc32")
_STROKES = "".join(f"M{x} {5 + x % 4}v8" for x in range(5, 85, 2)) + "".join(f"M{x} 20h0" for x in range(5, 85, 8))
_DRAWING = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 30"><path d="{_STROKES}"/></svg>'
"""Forty short strokes and ten taps."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--drawings", type=int, default=300, help="for each driver")
    parser.add_argument("--seed", type=int, default=0, help="of the first drawing")
    options = parser.parse_args()
    faults = 0
    with tempfile.TemporaryDirectory() as folder:
        drawing, csv = Path(folder, "drawing.svg"), Path(folder, "traj.csv")
        drawing.write_text(_DRAWING)
        plan([str(drawing), "-o", str(csv), "--quiet"])
        for driver in _DRIVERS:
            with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
                soak = Soak(csv, driver)
                outcomes = [soak.draw(np.random.default_rng(options.seed + k)) for k in range(options.drawings)]
            bad = [options.seed + k for k, outcome in enumerate(outcomes) if not _is_sound(outcome, soak.bound_mm)]
            faults += len(bad)
            print(_row(driver, outcomes, soak.bound_mm) + (f"; unsound by seeds {bad}" if bad else ""), flush=True)
    return 1 if faults else 0


def _is_sound(outcome: Outcome, bound_mm: float) -> bool:
    return not (outcome.lost or outcome.claimed or outcome.undoubted) and outcome.off_mm <= bound_mm


def _row(driver: str, outcomes: list[Outcome], bound_mm: float) -> str:
    dead, reset, twice = (sum(getattr(one, name) for one in outcomes) for name in ("dead", "reset", "twice"))
    lost, claimed, undoubted = (
        sum(len(getattr(one, name)) for one in outcomes) for name in ("lost", "claimed", "undoubted")
    )
    return (
        f"{driver}: {len(outcomes)} drawings, {dead} deaths and {reset} resets; {lost} strokes lost, {claimed} "
        f"claimed too early, {twice} drawn twice, {undoubted} of them not in doubt; ink off by "
        f"{max(one.off_mm for one in outcomes):.3f} mm at the most, of {bound_mm:.3f} mm that rounding may come to"
    )


if __name__ == "__main__":
    sys.exit(main())
