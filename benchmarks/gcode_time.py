"""What a GRBL-like controller makes of exported G-code: how much longer its own planner takes than the trajectory.

Its planner, as GRBL 1.1's planner.c has it: a block a line, its speed what F asks for, no axis beyond its acceleration,
corners as fast as the junction deviation allows, and always so slow that it can stop at the end of the last block that
it has in its buffer. The program is read by a parser of its own, which knows nothing of the exporter.

python benchmarks/gcode_time.py traj.csv --controller grblhal --blocks 16 35 100
"""

from __future__ import annotations

import argparse
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.trajectory import read_trajectory

_WORD = re.compile(r"([A-Z])\s*([-+]?[0-9.]+)")
JUNCTION_DEVIATION = 0.01
"""GRBL's $11, in the units of the axes."""


@dataclass(frozen=True, eq=False)
class Program:
    """What a program amounts to after the way to its first point. positions: (n + 1, n_axes) where lines begin and end,
    in the units of the program. asked_s: (n,) the time that each line asks for. is_wait: (n,) where nothing moves.
    """

    axes: str
    positions: FloatArray
    asked_s: FloatArray
    is_wait: np.ndarray

    @property
    def times_s(self) -> FloatArray:
        """(n + 1,)"""
        return np.concatenate(([0.0], np.cumsum(self.asked_s)))


def read_program(lines: Iterable[str], axes: str, *, marlin: bool = False) -> Program:
    """Axes are those of the joints; other words (a pen's) are passed over. Lines that a controller would refuse raise
    ValueError."""
    inverse_time, at = False, dict.fromkeys(axes, 0.0)
    positions: list[list[float]] = []
    asked_s, is_wait = [], []
    for line in lines:
        words = [(letter, float(value)) for letter, value in _WORD.findall(line.split(";")[0])]
        if not words:
            continue
        values = dict(words)
        code = f"{words[0][0]}{words[0][1]:g}"
        if code in ("G93", "G94"):
            inverse_time = code == "G93"
        elif code == "G4":
            asked_s.append(values["P"] / (1000 if marlin else 1))
            is_wait.append(True)
            positions.append(list(at.values()))
        elif code == "G1":
            before = np.array(list(at.values()))
            at |= {letter: values[letter] for letter in axes if letter in values}
            now = np.array(list(at.values()))
            if positions:
                if "F" not in values and inverse_time:
                    raise ValueError(f"no F in inverse time: {line}")
                length = float(np.linalg.norm(now - before))
                asked_s.append(60.0 / values["F"] * (1.0 if inverse_time else length))
                is_wait.append(False)
            positions.append(now.tolist())
        elif code not in ("G0", "G21", "G90", "M2", "M3", "M5", "M400"):
            raise ValueError(f"unknown: {line}")
    return Program(axes, np.array(positions), np.array(asked_s), np.array(is_wait))


def planned_s(program: Program, acceleration: FloatArray, blocks: int) -> FloatArray:
    """(n,) the time that each line takes. acceleration: (n_axes,). blocks: in the planner's buffer."""
    moves = ~program.is_wait
    steps = np.diff(program.positions, axis=0)
    length = np.linalg.norm(steps, axis=1)
    unit = steps / np.where(length > 0, length, 1.0)[:, None]
    with np.errstate(divide="ignore"):
        most = np.where(moves, (acceleration / np.abs(unit)).min(axis=1), 0.0)
    nominal = np.where(moves, length / program.asked_s, 0.0)
    entry_limit = np.concatenate(([0.0], _junctions(unit, nominal, most, acceleration), [0.0]))
    # So slow at the start of each block that it stops at the end of the last one in the buffer.
    reachable = np.zeros(len(length) + 1)
    for _ in range(blocks):
        reachable[:-1] = np.minimum(entry_limit[:-1], np.sqrt(reachable[1:] ** 2 + 2 * most * length))
    took = np.array(program.asked_s)
    speed = 0.0
    for index in range(len(length)):
        if not moves[index]:
            speed = 0.0
            continue
        a, d = most[index], length[index]
        after = min(reachable[index + 1], float(np.sqrt(speed**2 + 2 * a * d)))
        top = min(nominal[index], float(np.sqrt(a * d + (speed**2 + after**2) / 2)))
        top = max(top, speed, after)
        flat = d - (2 * top**2 - speed**2 - after**2) / (2 * a)
        took[index] = (2 * top - speed - after) / a + max(flat, 0.0) / top
        speed = after
    return took


def _junctions(unit: FloatArray, nominal: FloatArray, most: FloatArray, acceleration: FloatArray) -> FloatArray:
    """(n - 1,) the greatest speed between a block and the next: v^2 = a d s / (1 - s), with s the sine of half the
    angle between the way back and the way on."""
    cosine = np.clip(-(unit[:-1] * unit[1:]).sum(axis=1), -0.999999, 0.999999)
    sine = np.sqrt(0.5 * (1.0 - cosine))
    bend = unit[1:] - unit[:-1]
    bend /= np.maximum(np.linalg.norm(bend, axis=1), 1e-12)[:, None]
    with np.errstate(divide="ignore"):
        across = np.minimum((acceleration / np.abs(bend)).min(axis=1), 1e12)
    limit = np.sqrt(across * JUNCTION_DEVIATION * sine / (1.0 - sine))
    limit = np.where(cosine > 0.999998, 0.0, limit)  # straight back
    straight = cosine < -0.999998
    limit = np.where(straight, np.inf, limit)
    speeds: FloatArray = np.minimum(limit, np.minimum(nominal[:-1], nominal[1:]))
    return speeds


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trajectories", nargs="+", type=Path, metavar="traj.csv")
    parser.add_argument("--controller", default="grblhal")
    parser.add_argument("--blocks", nargs="+", type=int, default=[16, 35, 100])
    options = parser.parse_args()
    for source in options.trajectories:
        trajectory = read_trajectory(source)
        arm = load_arm(trajectory.arm)
        with tempfile.TemporaryDirectory() as folder:
            target = Path(folder) / "traj.gcode"
            command = ["plan", "export", source, "--format", "gcode", "--controller", options.controller, "-o", target]
            subprocess.run([*map(str, command), "--quiet"], check=True)
            text = target.read_text(encoding="utf-8")
        axes = "XYZABCUVW"[: arm.n_joints]
        program = read_program(text.splitlines(), axes, marlin=options.controller == "marlin")
        acceleration = arm.to_file_units(arm.max_acceleration)
        for blocks in options.blocks:
            took_s = float(planned_s(program, acceleration, blocks).sum())
            longer_s = took_s - trajectory.duration_s
            print(
                f"{source.name} on {arm.name}, {blocks} blocks: {took_s:.2f} s of {trajectory.duration_s:.2f} s,"
                f" {longer_s:+.2f} s ({100 * longer_s / trajectory.duration_s:+.1f} %)",
                flush=True,
            )


if __name__ == "__main__":
    main()
