"""Sequences of starts, stops and reloads against one server, and what its memory does meanwhile.

python benchmarks/soak/page.py [--sequences 1000] [--seed 1]
"""

from __future__ import annotations

import argparse
import json
import random
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from tests.serve.sequences import NAMES, follow  # noqa: E402
from tests.serve.served import Server  # noqa: E402

_MOST_STEPS = 8
_TOLD_EVERY = 50


def resident_mb(process: int) -> float:
    pages = int(Path(f"/proc/{process}/statm").read_text(encoding="ascii").split()[1])
    return pages * 4096 / 2**20


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sequences", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    chance = random.Random(options.seed)  # noqa: S311
    with tempfile.TemporaryDirectory() as folder, Server(Path(folder), "--demo") as server:
        key = server.planned()["id"]
        for number in range(options.sequences):
            steps = chance.choices(NAMES, k=chance.randint(1, _MOST_STEPS))
            try:
                follow(server, key, steps)
            except AssertionError as error:
                print(json.dumps({"sequence": number, "steps": steps, "fault": str(error)[:300]}), flush=True)
                raise SystemExit(1) from error
            if (number + 1) % _TOLD_EVERY == 0:
                print(f"{number + 1} sequences, server {resident_mb(server.process.pid):.0f} MB", flush=True)


if __name__ == "__main__":
    main()
