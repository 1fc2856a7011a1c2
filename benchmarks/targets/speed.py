"""How long things take: postures by the closed form and by the nonlinear programme, and one drawing end to end."""

from __future__ import annotations

import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np

from benchmarks.targets.row import Row
from benchmarks.targets.strokes import lines, placed_strokes
from planner.arms.arm_file import load_arm
from planner.arms.closed_forms import family_of
from planner.arms.posture_field import posture_field
from planner.inverse_kinematics import nlp
from planner.settings import PlanSettings

_CLOSED_TARGETS = 500_000
_NLP_TARGETS = 2000
"""At most, of one stroke: the next is warm only where the last is near."""
_WATCH_S = 0.02


def postures(drawing: Path, settings: PlanSettings) -> list[Row]:
    """Targets are the points of the drawing's strokes, repeated as often as needed."""
    arm = load_arm(settings.arm)
    points = np.concatenate(lines(placed_strokes(drawing, arm, settings)))
    tips = np.column_stack((points, np.zeros(len(points))))
    many = np.resize(tips, (_CLOSED_TARGETS, 3))
    pitch = arm.complete(posture_field(arm).reference(many))[:, 1:4].sum(axis=1)
    at_tip = family_of(arm).at_tip
    at_tip(arm, many, pitch)
    began = time.perf_counter()
    at_tip(arm, many, pitch)
    closed_us = (time.perf_counter() - began) / len(many) * 1e6
    longest = max(lines(placed_strokes(drawing, arm, settings)), key=len)[:_NLP_TARGETS]
    few = np.column_stack((longest, np.zeros(len(longest))))
    home = posture_field(arm).home
    nlp.solve_sequence(arm, few[:2], home)
    began = time.perf_counter()
    nlp.solve_sequence(arm, few, home)
    warm_us = (time.perf_counter() - began) / len(few) * 1e6
    return [Row("closed form, all branches, a point", "≤ 1 µs", f"{closed_us:.2f} µs", closed_us <= 1.0),
            Row("NLP, a warm point", "≤ 110 µs", f"{warm_us:.0f} µs", warm_us <= 110.0)]


def end_to_end(drawing: Path, settings: PlanSettings) -> list[Row]:
    """The command itself, start of Python and worker processes included."""
    root = Path(__file__).resolve().parents[2]
    with tempfile.TemporaryDirectory() as folder:
        began = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, "-m", "planner.cli", str(drawing), "-o", str(Path(folder) / "traj.csv"), "--quiet",
             "--arm", settings.arm], cwd=root, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        peak = _Peak(process.pid)
        _, errors = process.communicate()
        seconds = time.perf_counter() - began
        megabytes = peak.stop()
    what, target = f"{drawing.name} end to end", "≤ 5 s, ≤ 300 MB"
    if process.returncode:
        return [Row(what, target, f"exit code {process.returncode}: {errors.decode().strip()}", False)]
    return [Row(what, target, f"{seconds:.1f} s, {megabytes:.0f} MB", seconds <= 5 and megabytes <= 300)]


class _Peak:
    """The most memory, MB, that a process and its descendants held together; shared pages count once."""

    def __init__(self, pid: int) -> None:
        self._pid, self._most, self._done = pid, 0.0, threading.Event()
        self._watch = threading.Thread(target=self._run)
        self._watch.start()

    def _run(self) -> None:
        while not self._done.wait(_WATCH_S):
            self._most = max(self._most, sum(map(_held_mb, _family(self._pid))))

    def stop(self) -> float:
        self._done.set()
        self._watch.join()
        return self._most


def _family(pid: int) -> list[int]:
    """A process and all its descendants (Linux)."""
    found = [pid]
    for parent in found:
        try:
            for children in Path(f"/proc/{parent}/task").glob("*/children"):
                found += [int(child) for child in children.read_text().split()]
        except OSError:  # it has just ended
            continue
    return found


def _held_mb(pid: int) -> float:
    try:
        lines_of = Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines()
    except OSError:
        return 0.0
    return sum(int(line.split()[1]) for line in lines_of if line.startswith("Pss:")) / 1024
