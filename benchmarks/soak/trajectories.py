"""Mutated trajectories: each is used or refused in one sentence by every command that reads one.

    python benchmarks/soak/trajectories.py --count 2000 --seed 1 --keep FOLDER

They begin as plans of a small drawing for arms of all kinds. Each goes through `plan check`, `plan run --dry-run`, a
run on the simulated arm, and one in four through `plan plot`. Faults are as with drawings; their files are kept.
"""

from __future__ import annotations

import argparse
import random
import re
import sys
import tempfile
from functools import partial
from pathlib import Path

from guarded import command, judged, outcomes, told
from mutations import mutated

_ARMS = ("drawing_arm", "scara", "three_joint", "so101")
_DRAWING = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 40"><path d="M2 2l9 5-9 5"/><path d="M20 20h0"/>'
    '<path d="M30 30q5 5 0 9"/></svg>'
)
_PIECES = tuple(
    re.compile(pattern, re.MULTILINE)
    for pattern in (rb"^.*\n", rb"^(?:.*\n){1,20}", rb"^#.*\n", rb",[^,\n]*", rb"[\w.-]+", rb"^(?:.*\n){50,200}")
)
_WORDS = tuple(
    word.encode()
    for word in (
        ",",
        "\n",
        "\r\n",
        "#",
        "# rate_hz: 1e5\n",
        "# rate_hz: 0\n",
        "# arm: ../../etc/passwd\n",
        "# arm: six_joint\n",
        "# trajectory: 2\n",
        "# duration_s: 1e99\n",
        "# svg_to_arm_mm: 0 0 0 0 0 0\n",
        "# svg_to_arm_mm: 1e300 1 1 1e300 0 0\n",
        "nan",
        "inf",
        "\0",
        "\ufeff",
        "q1_deg",
        "pen",
        "stroke",
        "-1",
        "1e9",
        "999999999999",
        '"',
        ";",
        " ",
    )
)
_KINDS = ("profiles", "drawing", "speed", "error", "phase", "timeline", "film")


def seeds(folder: Path) -> None:
    """Plan the trajectories that the items begin as."""
    (folder / "drawing.svg").write_text(_DRAWING)
    for arm in _ARMS:
        code, said = command(str(folder / "drawing.svg"), "-o", str(folder / f"{arm}.csv"), "--arm", arm, "--quiet")
        if code:
            raise SystemExit(said)


def trajectory(folder: Path, seed: int, item: int) -> bytes:
    """The item's file; the one before the first is whole."""
    texts = [(folder / f"{arm}.csv").read_bytes() for arm in _ARMS]
    chance = random.Random(f"{seed}/{item}")  # noqa: S311
    return texts[0] if item < 0 else mutated(chance.choice(texts), texts, _PIECES, _WORDS, chance)


def attempt(folder: Path, seed: int, item: int, desk: Path) -> tuple[str, str]:
    """Put the item's trajectory through all commands: kind of outcome and message."""
    (desk / "traj.csv").write_bytes(trajectory(folder, seed, item))
    drawing = str(folder / "drawing.svg")
    commands = [
        (("check", "traj.csv", "--drawing", drawing), {0: "passes", 1: "fails the check", 2: "refused"}),
        (("run", "traj.csv", "--dry-run"), {0: "passes", 2: "refused"}),
        (("run", "traj.csv", "--fast", "--quiet", "--servos", "real" if item % 2 else "ideal"), {0: "", 2: ""}),
    ]
    if item % 4 == 0:
        kind = _KINDS[item // 4 % len(_KINDS)]
        extra = {"error": ("--drawing", drawing), "film": ("--fps", "1")}.get(kind, ())
        target = "film.gif" if kind == "film" else "picture.png"
        commands.append((("plot", "traj.csv", "-o", target, "--kind", kind, *extra), {0: "", 2: "", 3: ""}))
    outcome = ""
    for arguments, allowed in commands:
        code, said = command(*arguments)
        kind = judged(" ".join(arguments), code, said, allowed)
        if not kind.startswith("fine"):
            return kind, said
        outcome = outcome or kind
    return outcome, ""


def write(folder: Path, seed: int, item: int, keep: Path) -> None:
    (keep / f"{seed}_{item}.csv").write_bytes(trajectory(folder, seed, item))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--from", dest="begin", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=Path("faults"))
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    items = range(options.begin, options.begin + options.count)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        seeds(folder)
        found = outcomes(partial(attempt, folder, options.seed), items, folder, options.processes)
        return told(found, options.keep.resolve(), partial(write, folder, options.seed), options.count)


if __name__ == "__main__":
    sys.exit(main())
