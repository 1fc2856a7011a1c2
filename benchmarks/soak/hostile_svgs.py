"""Mutated and hostile SVGs: the lines of each are found, or it is refused in one sentence.

    python benchmarks/soak/hostile_svgs.py [FOLDER ...] --count 10000 --seed 1 --keep FOLDER

The folders hold SVGs to begin with, by default the examples; one file in five is a bomb of our own making instead.
Faults are a traceback, an exit code of a defect, more than ten seconds of processor and more than a gigabyte; their
files are kept.
"""

from __future__ import annotations

import random
import sys
from pathlib import Path

from bombs import bomb
from drawings import drawing, soak
from guarded import command, judged

_BOMBS = 0.2


def hostile(folders: tuple[Path, ...], seed: int, item: int) -> bytes:
    """The item's file."""
    chance = random.Random(f"hostile {seed}/{item}")  # noqa: S311
    return bomb(chance) if item >= 0 and chance.random() < _BOMBS else drawing(folders, seed, item)


def attempt(folders: tuple[Path, ...], seed: int, item: int, desk: Path) -> tuple[str, str]:
    """The lines of the item's file, with all that has to be found out about hidden lines and text too."""
    (desk / "drawing.svg").write_bytes(hostile(folders, seed, item))
    more = (["--occlude"] if item % 3 == 0 else []) + (["--text", "outline"] if item % 5 == 0 else [])
    code, said = command("lines", "drawing.svg", "--json", "lines.json", *more)
    return judged("lines", code, said, {0: "lines found", 2: "refused as a drawing"}), said


def write(folders: tuple[Path, ...], seed: int, item: int, keep: Path) -> None:
    (keep / f"hostile_{seed}_{item}.svg").write_bytes(hostile(folders, seed, item))


if __name__ == "__main__":
    sys.exit(soak(attempt, write, __doc__ or "", 10_000))
