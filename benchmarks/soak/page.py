"""Sequences of starts, stops and reloads, made by hypothesis, against one server, and what its memory does meanwhile.

python benchmarks/soak/page.py [--sequences 1000] [--seed 1]
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import hypothesis

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from tests.serve.sequences import STEPS, follow  # noqa: E402
from tests.serve.served import Server  # noqa: E402

_TOLD_EVERY = 50


def resident_mb(process: int) -> float:
    pages = int(Path(f"/proc/{process}/statm").read_text(encoding="ascii").split()[1])
    return pages * 4096 / 2**20


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sequences", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, Server(Path(folder), "--demo") as server:
        key = server.planned()["id"]
        done = 0

        @hypothesis.seed(options.seed)
        @hypothesis.settings(
            max_examples=options.sequences,
            deadline=None,
            database=None,
            suppress_health_check=list(hypothesis.HealthCheck),
        )
        @hypothesis.given(STEPS)
        def leaves_no_stuck_state(steps: list[str]) -> None:
            nonlocal done
            follow(server, key, steps)
            done += 1
            if done % _TOLD_EVERY == 0:
                print(f"{done} sequences, server {resident_mb(server.process.pid):.0f} MB", flush=True)

        leaves_no_stuck_state()
        print(f"{done} sequences left no stuck state, server {resident_mb(server.process.pid):.0f} MB")


if __name__ == "__main__":
    main()
