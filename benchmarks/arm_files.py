"""A soak: thousands of damaged arm files, each described and planned for, in a process of its own.

    python benchmarks/arm_files.py [COUNT] [SEED]

Every outcome has to be a plan or one sentence with exit code 2 or 3. What is not is printed with the text of the file,
and makes the exit code 1. Mutations are drawn from those of `damaged`, over all arms that come along.
"""

from __future__ import annotations

import random
import re
import resource
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

from planner.arms.arm_file import arms_folder, known_arms

LONGEST_S, MOST_BYTES = 10.0, 1 << 30

_DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 10" fill="none" stroke="black">\
<path d="M1 1L19 9"/></svg>"""

VALUES = (
    "nan",
    "inf",
    "-inf",
    "0",
    "-0.0",
    "1e-320",
    "1e9",
    "-1e9",
    "1e308",
    "1" + "0" * 400,
    "-5",
    "7.5",
    '"text"',
    "true",
    "[]",
    "{}",
    "[1, 2, 3]",
    "[[]]",
    "2026-01-01",
    "''",
    '"' + "x" * 300 + '"',
    '"\\u0000"',
    '"continuous"',
    '"revolute"',
    '"prismatic"',
    '"q1"',
    '"tool_axis"',
    '"free"',
    '"coupling"',
    "[0.0, 0.0, 1.0]",
    "1e-6",
    "360",
)


def damaged(text: str, chance: random.Random) -> str:
    """The text of an arm file with one to three faults."""
    for _ in range(chance.randint(1, 3)):
        lines = text.splitlines()
        at = chance.randrange(len(lines))
        match chance.randrange(9):
            case 0:
                del lines[at]
            case 1:
                lines.insert(at, lines[chance.randrange(len(lines))])
            case 2 | 3 | 4:
                keyed = [index for index, line in enumerate(lines) if re.match(r"\w+ *=", line)] or [at]
                at = chance.choice(keyed)
                lines[at] = lines[at].split("=")[0] + "= " + chance.choice(VALUES)
            case 5:
                lines[at] = re.sub(
                    r"-?\d+\.?\d*", lambda found: f"{float(found[0]) * 10 ** chance.uniform(-3, 3):.6g}", lines[at]
                )
            case 6:
                joints = "\n".join(lines).split("[[joints]]")
                kept = chance.sample(range(1, len(joints)), chance.randint(0, len(joints) - 1)) if joints[1:] else []
                lines = "[[joints]]".join([joints[0], *(joints[index] for index in kept)]).splitlines() or [""]
            case 7:
                lines[at] = lines[at][: chance.randint(0, len(lines[at]))] + chance.choice("[]{}=\"',\x00é#.")
            case _:
                lines[at] = re.sub(r"[a-z]\w*", "unheard_of", lines[at], count=1)
        text = "\n".join(lines) + "\n"
    return text


def outcome(command: list[str], folder: Path) -> tuple[int, str]:
    """Exit code and last line on standard error; 124 where time runs out."""

    def bounded() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (int(LONGEST_S), int(LONGEST_S) + 1))

    ended = subprocess.run(
        [sys.executable, "-m", "planner.cli", *command],
        cwd=folder,
        capture_output=True,
        text=True,
        preexec_fn=bounded,
        check=False,
    )
    code = 124 if ended.returncode in (-9, -24) else ended.returncode
    return code, ended.stderr.strip()


def main() -> int:
    count, seed = (int(argument) for argument in (*sys.argv[1:3], *("2000", "0")[len(sys.argv) - 1 :]))
    chance = random.Random(seed)  # noqa: S311  # the same files for the same seed
    texts = [(arms_folder() / f"{name}.toml").read_text(encoding="utf-8") for name in known_arms()]
    codes: Counter[int] = Counter()
    bad = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "line.svg").write_text(_DRAWING, encoding="utf-8")
        for index in range(count):
            text = damaged(chance.choice(texts), chance)
            (folder / "arm.toml").write_text(text, encoding="utf-8")
            code, said = outcome(["line.svg", "--arm", "arm.toml", "--quiet", "-o", "line.csv"], folder)
            if code == 0:
                code = 10 * outcome(["check", "line.csv", "--drawing", "line.svg"], folder)[0]
            codes[code] += 1
            if code not in (0, 2, 3) or (code and len(said.splitlines()) != 1):
                bad += 1
                print(f"--- {index}: exit {code}\n{said}\n{text}", flush=True)
            elif len(sys.argv) > 3:  # any third argument: say all
                print(index, code, said)
    print(f"{count} files, seed {seed}: " + ", ".join(f"exit {code}: {n}" for code, n in sorted(codes.items())))
    peak_kb = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    print(f"most memory: {peak_kb / 1024:.0f} MB")
    return 1 if bad or peak_kb * 1024 > MOST_BYTES else 0


if __name__ == "__main__":
    sys.exit(main())
