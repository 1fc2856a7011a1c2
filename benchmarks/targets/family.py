"""The command as a process with a family: its time and the memory that all of them hold."""

from __future__ import annotations

import resource
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

from planner.settings import PlanSettings

_WATCH_S = 0.02


@dataclass(frozen=True, slots=True)
class Cost:
    """What planning took, start of Python and worker processes included: wall time, that of all processors together,
    and the most memory at a time."""

    wall_s: float
    processors_s: float
    peak_mb: float


def planned(drawing: Path, settings: PlanSettings) -> Cost:
    """Plan a drawing by the command. Errors: RuntimeError with what the command said."""
    with tempfile.TemporaryDirectory() as folder:
        return spent(str(drawing), "-o", str(Path(folder) / "traj.csv"), "--quiet", "--arm", settings.arm)


def spent(*arguments: str) -> Cost:
    """What the command takes with these arguments. Errors: RuntimeError with what it said."""
    root = Path(__file__).resolve().parents[2]
    began, used_s = time.perf_counter(), _children_s()
    process = subprocess.Popen(
        [sys.executable, "-m", "planner.cli", *arguments], cwd=root, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    peak = _Peak(process.pid)
    _, errors = process.communicate()
    cost = Cost(time.perf_counter() - began, _children_s() - used_s, peak.stop())
    if process.returncode:
        raise RuntimeError(f"{' '.join(arguments)}: exit code {process.returncode}: {errors.decode().strip()}")
    return cost


def _children_s() -> float:
    """Processor time of all descendants that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


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
