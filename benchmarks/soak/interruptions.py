"""Drawings on the emulated firmware, interrupted again and again, and what the pins drew of them.

    python benchmarks/soak/interruptions.py [-n 1000] [--seed 0] [--only KIND ...] [--drawing DRAWING.svg]

Every run of `plan run --resume` is interrupted after a random time by something of a random kind, until the drawing is
done; then the next drawing begins. The ink on the pins is laid beside the plan: nothing may be missing, none may be
beside its line, and none drawn twice beyond what was in doubt. The exit code is 1 where that does not hold.
Needs what the tests of the firmware need: gcc, avr-gcc, avr-libc and simavr.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from benchmarks.soak.coverage import coverage
from benchmarks.soak.interrupted_host import Host, Kind
from hardware.simulation.ink import drawn_lines
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.cli import main
from planner.trajectory import read_trajectory
from tests.hardware.drivers.native.paper import ink
from tests.hardware.emulator.emulator import Build, LockStep, build, in_lock_step

_CONFIGS = Path(__file__).resolve().parents[2] / "configs"
_DRAWING = (
    '<svg xmlns="http://www.w3.org/2000/svg" fill="none" stroke="red" viewBox="0 0 90 40"><path d="'
    + "".join(f"M{x} 5v8" for x in range(5, 85, 4))
    + '"/>'
    + "".join(f'<path d="M{x} 18c4 -4 8 6 12 0"/>' for x in range(5, 80, 16))
    + '<path d="M10 30h0M20 30h0M30 30h0"/><path d="M36 28l6 8 6 -8 6 8 6 -8 6 8 6 -8 6 8"/></svg>'
)
_MARGIN_MM = 30
_STRIKES_WITHIN_S = 5.0
_LEFT_ALONE_S = (0.0, 0.5, 8.0)
"""At most so long passes before somebody resumes: the controller may still play, stand, or have given its host up."""
_STARTS_S = 0.3
_OFF_MM, _WORST_MM = 0.07, 0.1
"""Beside its line, of 999 in 1000 pieces of ink and of all: rounding to half microseconds comes to 0.022 mm at most,
and pulses that are 20 ms apart, one servo's after another's, to some 0.05 mm more where the pen is lifted in a tenth of
a second."""
_RUNS_PER_DRAWING = 400
_FASTEST_MM_S = 80.0
_SET_POINT_S = 0.012
_TOLD_S = 0.025
"""So long after it has come somewhere a controller says so, once all servos have been told."""
_DOUBT_S = {
    Kind.RESET: _SET_POINT_S + _TOLD_S,
    Kind.KILL_AND_RESET: _SET_POINT_S + _TOLD_S,
    Kind.POWER: 0.1,
    Kind.KILL_AND_POWER: 0.75,
}
"""Of drawing, that may be drawn twice: where the controller lost its memory what was not noted, where it was reset
while it moved what not all servos had been told, else one set point."""
_ENDINGS = {
    Kind.KILL: {-9},
    Kind.KILL_AND_RESET: {-9},
    Kind.KILL_AND_POWER: {-9},
    Kind.HANG_UP: {0, 130},
    Kind.TERMINATE: {0, 130},
    Kind.CABLE: {4},
    Kind.RESET: {0, 4},
    Kind.POWER: {0, 4},
    Kind.ERRORS: {0, 4},
    Kind.DISK: {0, 2},
    Kind.SECOND: {0},
}
"""Exit codes; those of a run that several things befell are of any of them. 0 after a reset, too: it may come before
the run has set out."""


@dataclass
class Row:
    """What is known of one kind: how often it struck, how the runs ended that it befell last, and the ink drawn
    twice after each of them, in mm."""

    struck: int = 0
    endings: Counter[int] = field(default_factory=Counter)
    again_mm: list[float] = field(default_factory=list)

    def cells(self, kind: Kind) -> list[str]:
        ends = ", ".join(f"{code}: {times}" for code, times in sorted(self.endings.items()))
        again_mm = self.again_mm or [0.0]
        return [
            kind.value,
            str(self.struck),
            ends,
            str(sum(mm > 0 for mm in self.again_mm)),
            f"{np.mean(again_mm):.2f}",
            f"{max(again_mm):.1f}",
            f"{_allowed_mm(kind):.1f}",
        ]


@dataclass(frozen=True)
class Subject:
    """What is drawn: the trajectory, the arm and its file, and the lines that are wanted."""

    csv: Path
    arm: Arm
    arm_file: Path
    wanted: list[FloatArray]


def _allowed_mm(kind: Kind) -> float:
    return _FASTEST_MM_S * _DOUBT_S.get(kind, _SET_POINT_S)


def subject_in(folder: Path, drawing: Path | None) -> Subject:
    """An arm whose servos turn little in many microseconds: half of one, which the pins are right to, is little."""
    svg, csv = folder / "drawing.svg", folder / "traj.csv"
    svg.write_text(drawing.read_text() if drawing else _DRAWING)
    # What is allowed beside lines is for set points a hundredth of a second apart.
    if main([str(svg), "-o", str(csv), "--quiet", "--rate", "100", "--margin", str(_MARGIN_MM)]):
        sys.exit(2)
    trajectory = read_trajectory(csv)
    low, high = trajectory.positions.min(axis=0), trajectory.positions.max(axis=0)
    us_per_deg = np.minimum(1800.0 / (high - low), 75.0)
    channels = iter(range(len(low)))

    def servo(_: re.Match[str]) -> str:
        channel = next(channels)
        zero_us = 1500.0 - us_per_deg[channel] * (low + high)[channel] / 2
        return (
            f"servo = {{ channel = {channel}, pulse_at_zero_us = {zero_us:.3f}, "
            f"us_per_deg = {us_per_deg[channel]:.3f}, pulse_range_us = [400.0, 2600.0] }}"
        )

    arm_file = folder / "drawing_arm.toml"
    arm_file.write_text(re.sub(r"^servo = .*$", servo, (_CONFIGS / "drawing_arm.toml").read_text(), flags=re.MULTILINE))
    arm = load_arm(str(arm_file))
    return Subject(csv, arm, arm_file, drawn_lines(arm, arm.from_file_units(trajectory.positions)))


class Soak:
    """Draws one drawing after the other, and keeps the account."""

    def __init__(
        self, built: Build, subject: Subject, folder: Path, random: np.random.Generator, kinds: list[Kind]
    ) -> None:
        self._built, self._subject, self._folder, self._random, self._kinds = built, subject, folder, random, kinds
        self.rows = {kind: Row() for kind in kinds}
        self.wrong: list[str] = []
        self.drawings = 0
        self.off_mm: list[FloatArray] = []
        self.missing_mm = 0.0

    @property
    def struck(self) -> int:
        return sum(row.struck for row in self.rows.values())

    def draw(self) -> None:
        """One drawing to its end."""
        folder = self._folder / str(self.drawings)
        folder.mkdir()
        csv = folder / "traj.csv"
        csv.write_bytes(self._subject.csv.read_bytes())
        controller = in_lock_step(self._built, folder)
        controller.sleep_until(_STARTS_S)
        ended: list[tuple[list[Kind], int]] = []  # what befell each run, and how many lines there were at its end
        code, begun = -1, 0
        kinds: list[Kind] = []
        for _ in range(_RUNS_PER_DRAWING):
            resume = ["--resume"] if csv.with_name("traj.csv.journal").exists() else []
            strikes_s = controller.now_s() + self._random.uniform(0.0, _STRIKES_WITHIN_S)
            code, told = Host(
                controller,
                [
                    "run",
                    str(csv),
                    "--driver",
                    "native",
                    "--port",
                    str(folder / "emulated"),
                    "--arm",
                    str(self._subject.arm_file),
                    "--quiet",
                    *resume,
                ],
                folder / "log.txt",
                self._random.spawn(1)[0],
                self._kinds,
                strikes_s,
            ).run()
            controller.catch_up()
            kinds = self._note(told, code)
            if code == 0:
                break
            self._leave_alone(controller, kinds)
            lines = len(ink(controller.emulator, self._subject.arm))
            if csv.with_name("traj.csv.journal").exists():
                ended.append((kinds, lines - begun))
            else:  # as it has said: the disk was full from the first, and the next run begins anew on another sheet
                ended, begun = [], lines
        controller.sleep_until(controller.now_s() + 0.1)
        if code != 0:
            self.wrong.append(f"drawing {self.drawings} was not done after {_RUNS_PER_DRAWING} runs")
        self._examine(ink(controller.emulator, self._subject.arm)[begun:], ended, kinds)
        controller.emulator.end()
        self.drawings += 1

    def _note(self, told: list[str], code: int) -> list[Kind]:
        """What befell the run, which ended so."""
        self.wrong += [f"drawing {self.drawings}: {line[2:]}" for line in told if line.startswith("! ")]
        kinds = [Kind[line] for line in told if not line.startswith("! ")]
        for kind in kinds:
            self.rows[kind].struck += 1
        if kinds:
            self.rows[kinds[-1]].endings[code] += 1
        allowed = set().union(*(_ENDINGS[kind] for kind in kinds)) if kinds else {0}
        if code not in allowed:
            self.wrong.append(f"drawing {self.drawings}: after {', '.join(kinds) or 'nothing'} a run ended with {code}")
        return kinds

    def _leave_alone(self, controller: LockStep, kinds: list[Kind]) -> None:
        """Until somebody resumes."""
        controller.sleep_until(controller.now_s() + self._random.uniform(0.0, self._random.choice(_LEFT_ALONE_S)))
        for kind, what in (
            (Kind.KILL_AND_RESET, controller.emulator.reset),
            (Kind.KILL_AND_POWER, controller.emulator.lose_power),
        ):
            if kind in kinds:
                what()
                controller.sleep_until(controller.now_s() + _STARTS_S)

    def _examine(self, lines: list[FloatArray], ended: list[tuple[list[Kind], int]], last: list[Kind]) -> None:
        """`ended`: what befell each run, and how many lines there were at its end; `last`: what befell the one that
        drew the rest."""
        found = coverage(lines, self._subject.wanted)
        self.off_mm.append(found.off_mm)
        self.missing_mm = max(self.missing_mm, found.missing_mm)
        most_mm, worst_mm = _most_and_worst(found.off_mm)
        for excess, what in (
            (max(most_mm - _OFF_MM, worst_mm - _WORST_MM), f"{worst_mm:.3f} mm beside its line"),
            (found.missing_mm, f"{found.missing_mm:.1f} mm missing"),
        ):
            if excess > 0:
                self.wrong.append(f"drawing {self.drawings}: {what}")
        doubted: list[Kind] = []
        for (kinds, begin), (own, end) in pairwise([*ended, (last, len(lines))]):
            doubted += kinds
            again_mm = sum(found.again_mm[begin:end])
            # Without power before it has told how far an earlier run came, the controller does not know.
            cause = Kind.KILL_AND_POWER if Kind.POWER in own else max(doubted, key=_allowed_mm, default=None)
            if cause in self.rows:
                self.rows[cause].again_mm.append(again_mm)
            if again_mm > (_allowed_mm(cause) if cause is not None else 0.0):
                self.wrong.append(f"drawing {self.drawings}: after {', '.join(doubted)} {again_mm:.1f} mm twice")
            if end > begin and not again_mm:  # else what was in doubt may still have to be drawn again, by a later run
                doubted = []


def _most_and_worst(off_mm: FloatArray) -> tuple[float, float]:
    return float(np.percentile(off_mm, 99.9)), float(off_mm.max())


def _table(soak: Soak) -> str:
    head = ["interrupted by", "times", "exit codes", "drawn again after", "mm on average", "mm at most", "in doubt, mm"]
    rows = [head, *(row.cells(kind) for kind, row in soak.rows.items())]
    widths = [max(len(row[column]) for row in rows) for column in range(len(head))]
    lines = ("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows)
    return "\n".join(line.rstrip() for line in lines)


def _main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-n", type=int, default=1000, help="interruptions (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument(
        "--only",
        nargs="+",
        choices=[kind.name for kind in Kind],
        default=[kind.name for kind in Kind],
        metavar="KIND",
        help=", ".join(kind.name for kind in Kind),
    )
    parser.add_argument("--drawing", type=Path, help="instead of its own; its lines keep away from each other")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="journals, logs and pins stay there")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        soak = Soak(
            build(folder / "build"),
            subject_in(folder, options.drawing),
            folder,
            np.random.default_rng(options.seed),
            [Kind[name] for name in options.only],
        )
        while soak.struck < options.n:
            known = len(soak.wrong)
            soak.draw()
            print("\n".join(soak.wrong[known:]), end="\n" * (len(soak.wrong) > known), file=sys.stderr)
            print(
                f"{soak.struck} interruptions, {soak.drawings} drawings, {len(soak.wrong)} wrong",
                file=sys.stderr,
                flush=True,
            )
    print(_table(soak))
    most_mm, worst_mm = _most_and_worst(np.concatenate(soak.off_mm))
    print(
        f"{soak.struck} interruptions of {soak.drawings} drawings; 999 in 1000 pieces of ink within {most_mm:.3f} mm "
        f"of their line, all within {worst_mm:.3f} mm; {soak.missing_mm:.1f} mm missing at most; "
        f"{len(soak.wrong)} wrong"
    )
    print("\n".join(soak.wrong))
    return 1 if soak.wrong else 0


if __name__ == "__main__":
    sys.exit(_main())
