"""Whether trajectories are the same, byte for byte, as those of another revision.

    python benchmarks/same_bytes.py digests.json          # write down what this tree plans
    python benchmarks/same_bytes.py digests.json --check  # hold this tree against it; exit code 1 where they differ

Three examples, all arms that come along, all methods. What cannot be planned has to be refused in the same words.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
METHODS = ("path", "nlp", "dls", "closed-form")


def digest_of(drawing: Path, arm: str, method: str, folder: Path) -> str:
    """SHA-256 of the trajectory, or the error where there is none."""
    target = folder / f"{drawing.stem}.{arm}.{method}.csv"
    command = [sys.executable, "-m", "planner.cli", str(drawing), "--arm", arm, "--method", method, "-o", str(target)]
    run = subprocess.run([*command, "--quiet", "--workers", "1"], capture_output=True, text=True, cwd=ROOT, check=False)
    if run.returncode:
        return f"exit {run.returncode}: {run.stderr.strip()}"
    return hashlib.sha256(target.read_bytes()).hexdigest()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("digests", type=Path, help="file of digests")
    parser.add_argument("--check", action="store_true", help="compare instead of writing")
    parser.add_argument("--at-once", type=int, default=2, help="plans at the same time (default: %(default)s)")
    options = parser.parse_args()
    arms = sorted(path.stem for path in (ROOT / "configs").glob("*.toml"))
    drawings = sorted((ROOT / "examples").glob("*.svg"))
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(options.at_once) as pool:
        cases = list(product(drawings, arms, METHODS))
        digests = dict(
            zip(
                (f"{drawing.name} {arm} {method}" for drawing, arm, method in cases),
                pool.map(lambda case: digest_of(*case, Path(folder)), cases),
                strict=True,
            )
        )
    if not options.check:
        options.digests.write_text(json.dumps(digests, indent=1) + "\n")
        print(f"wrote {options.digests}: {len(digests)} trajectories")
        return 0
    before = json.loads(options.digests.read_text())
    differing = sorted(case for case in before.keys() | digests if before.get(case) != digests.get(case))
    for case in differing:
        print(f"differs: {case}: {before.get(case, 'none')[:70]} -> {digests.get(case, 'none')[:70]}")
    print(f"{len(digests) - len(differing)} of {len(digests)} trajectories are the same")
    return 1 if differing else 0


if __name__ == "__main__":
    raise SystemExit(main())
