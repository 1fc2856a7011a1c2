"""Robot descriptions of a folder, each as a user would bring it: imported, a drawing planned with it, and checked.

Prints a line an arm: which links, how many joints, what came of it and how long it took, or the sentence that refused
it; then how many drew. Packages such as example-robot-data, rtb-data and airo-models hold descriptions: unpack one and
name the folder.

python benchmarks/urdf_arms.py FOLDER --pen-length 100 --only panda ur5
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
_LONGEST = 150
_LINKS = {
    "alex_nub_hands": ("Torso", "LeftGripperYawLink"),
    "baxter": ("torso", "left_wrist"),
    "centauro": ("torso_2", "arm1_7"),
    "g1_29dof_rev_1_0": ("torso_link", "left_rubber_hand"),
    "human": ("left_clavicle", "left_hand"),
    "icub": ("chest", "l_hand"),
    "pr2": ("torso_lift_link", "l_wrist_roll_link"),
    "romeo": ("torso", "l_wrist"),
    "simple_humanoid": ("torso", "l_wrist"),
    "so100": ("base", "gripper"),
    "talos_reduced": ("torso_2_link", "arm_left_7_link"),
    "tiago_dual": ("torso_lift_link", "arm_left_7_link"),
    "tiago_pro": ("torso_lift_link", "arm_left_7_link"),
    "z1": ("link00", "link06"),
}
"""Base and tip of one arm of robots that have several, or a gripper that looks like a joint of the arm."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--pen-length", default="100")
    parser.add_argument("--drawing", type=Path, default=ROOT / "examples" / "garden.svg")
    parser.add_argument("--only", nargs="+", default=[], help="parts of file names")
    parser.add_argument("--options", nargs="+", default=[], help="more options of plan, such as --method nlp")
    options = parser.parse_args()
    outcomes: Counter[str] = Counter()
    for source in sorted(options.folder.resolve().rglob("*.urdf")):
        if options.only and not any(part in source.name for part in options.only):
            continue
        outcome, told = _tried(source, options)
        outcomes[outcome] += 1
        print(f"{outcome:8} {source.name:34} {told}", flush=True)
    print(", ".join(f"{count} {outcome}" for outcome, count in outcomes.most_common()))


def _tried(source: Path, options: argparse.Namespace) -> tuple[str, str]:
    """What came of a description: drawn, refused by import, plan or check, or a traceback; and what is to be told."""
    with tempfile.TemporaryDirectory() as folder:
        arm, trajectory = f"{folder}/arm.toml", f"{folder}/traj.csv"
        links = [word for pair in zip(("--base", "--tip"), _LINKS.get(source.stem, ()), strict=False) for word in pair]
        made = _plan("arm", "--urdf", source, *links, "--pen-length", options.pen_length, "-o", arm)
        if made.returncode:
            return _fault(made, "no arm")
        chain = made.stdout.strip().partition(": ")[2]
        begin_s = os.times().children_user
        planned = _plan(options.drawing.resolve(), "--arm", arm, "-o", trajectory, "--quiet", *options.options)
        took_s = os.times().children_user - begin_s
        if planned.returncode:
            outcome, told = _fault(planned, "no plan")
            return outcome, f"{chain}: {told}"
        checked = _plan("check", trajectory, "--drawing", options.drawing.resolve())
        if checked.returncode:
            return "FAILED", f"{chain}: {checked.stdout[:_LONGEST]}"
        return "drawn", f"{chain}, {took_s:.1f} s of processor; {checked.stdout.strip()[:_LONGEST]}"


def _fault(process: subprocess.CompletedProcess[str], refused: str) -> tuple[str, str]:
    told = (process.stderr.strip().splitlines() or [""])[-1]
    defect = process.returncode not in (2, 3) or "Traceback" in process.stderr
    return "DEFECT" if defect else refused, told.partition("error: ")[2][:_LONGEST]


def _plan(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "planner", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)


if __name__ == "__main__":
    main()
