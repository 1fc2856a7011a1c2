"""Mutated drawings: each is planned or refused in one sentence, and what is planned passes the check.

    python benchmarks/soak/drawings.py [FOLDER ...] --count 10000 --seed 1 --keep FOLDER

The folders hold SVGs to begin with, by default the examples. Faults are a traceback, an exit code of a defect, more
than ten seconds of processor, more than a gigabyte, and a plan that the check refuses; their files are kept.
"""

from __future__ import annotations

import argparse
import random
import re
import sys
import tempfile
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

from guarded import command, judged, outcomes, told
from mutations import mutated

Attempt = Callable[[tuple[Path, ...], int, int, Path], tuple[str, str]]
"""attempt(folders, seed, item, desk): the kind of outcome, and what was said."""
Write = Callable[[tuple[Path, ...], int, int, Path], None]
"""write(folders, seed, item, keep): keep the item's file there."""
EXAMPLES = Path(__file__).parents[2] / "examples"
_LARGEST_BYTES = 30_000
_PIECES = tuple(
    re.compile(pattern, re.DOTALL)
    for pattern in (
        rb"<[a-zA-Z][^<>]*/>",
        rb'\s[\w:-]+="[^"]*"',
        rb'"[^"]*"',
        rb"[MmLlHhVvCcSsQqTtAaZz][^\"MmLlHhVvCcSsQqTtAaZz]*",
        rb"<(\w+)[^<>]*>[^<>]*</\1>",
        rb"</?[a-zA-Z][^<>]*>",
    )
)
_WORDS = tuple(
    word.encode()
    for word in (
        '<use href="#a"/>',
        '<g transform="scale(1e9)">',
        "</g>",
        "<g>",
        'transform="matrix(0 0 0 0 0 0)"',
        "skewX(90)",
        'clip-path="url(#a)"',
        'mask="url(#a)"',
        'id="a"',
        '<path d="M1 1h0"/>',
        "M0 0",
        "z",
        "A1 1 0 0 1",
        "A1e9 1e-9 7 1 0",
        'stroke-dasharray="1e-9"',
        "<!--",
        "]]>",
        "<![CDATA[",
        "&#0;",
        "&amp;",
        "\0",
        "\ufeff",
        'viewBox="0 0 0 0"',
        'preserveAspectRatio="xMaxYMin slice"',
        'width="1e9"',
        "<symbol>",
        "<marker id='a'>",
        "<style>*{marker:url(#a)}</style>",
        "<text>a</text>",
        '<image href="x"/>',
        "<switch>",
        '<svg viewBox="0 0 1 1">',
        "</svg>",
        'style="display:none"',
        "%",
        'fill="url(#a)"',
        '<pattern id="a">',
        'xml:space="preserve"',
        'font-size="1e9"',
        'd="M0 0L1e8 1e-8"',
    )
)


@cache
def seeds(folders: tuple[Path, ...]) -> list[bytes]:
    found = sorted(path for folder in folders for path in folder.rglob("*.svg"))
    texts = [path.read_bytes() for path in found if path.stat().st_size <= _LARGEST_BYTES]
    if not texts:
        raise SystemExit(f"no SVG of up to {_LARGEST_BYTES} bytes in {', '.join(map(str, folders))}")
    return texts


def drawing(folders: tuple[Path, ...], seed: int, item: int) -> bytes:
    """The item's drawing; the one before the first is whole."""
    texts = seeds(folders)
    chance = random.Random(f"{seed}/{item}")  # noqa: S311
    return texts[0] if item < 0 else mutated(chance.choice(texts), texts, _PIECES, _WORDS, chance)


def attempt(folders: tuple[Path, ...], seed: int, item: int, desk: Path) -> tuple[str, str]:
    """Plan the item's drawing and check the plan: kind of outcome and message."""
    (desk / "drawing.svg").write_bytes(drawing(folders, seed, item))
    code, said = command("drawing.svg", "-o", "traj.csv", "--workers", "1", "--quiet")
    kind = judged("plan", code, said, {0: "planned", 2: "refused as a drawing", 3: "refused as beyond the arm"})
    if code != 0 or not kind.startswith("fine"):
        return kind, said
    code, said = command("check", "traj.csv", "--drawing", "drawing.svg")
    return judged("check", code, said, {0: "planned, and passes the check"}), said


def write(folders: tuple[Path, ...], seed: int, item: int, keep: Path) -> None:
    (keep / f"{seed}_{item}.svg").write_bytes(drawing(folders, seed, item))


def soak(attempt: Attempt, write: Write, description: str, count: int) -> int:
    """Try as many files, made of the SVGs of the folders that the command line names; the exit code."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=Path, default=[EXAMPLES])
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--from", dest="begin", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", type=Path, default=Path("faults"))
    parser.add_argument("--processes", type=int, default=2)
    options = parser.parse_args()
    folders = tuple(folder.resolve() for folder in options.folders)
    items = range(options.begin, options.begin + options.count)
    with tempfile.TemporaryDirectory() as desks:
        found = outcomes(partial(attempt, folders, options.seed), items, Path(desks), options.processes)
        return told(found, options.keep.resolve(), partial(write, folders, options.seed), options.count)


if __name__ == "__main__":
    sys.exit(soak(attempt, write, __doc__ or "", 1000))
