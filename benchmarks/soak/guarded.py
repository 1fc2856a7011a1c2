"""Commands of the planner in processes of their own that are ended when they take too long or too much memory.

Processor time is what counts, so that a busy machine is no fault. Linux only: it reads /proc.
"""

from __future__ import annotations

import contextlib
import io
import multiprocessing
import os
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path

SECONDS, MEGABYTES = 10.0, 1000.0
_LOOK_S = 0.05
_STUCK_S = 200.0
"""Without using the processor."""
_FINE = "fine: "


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of one item: a few words that are the same for all of its kind, and the message."""

    item: int
    kind: str
    message: str = ""

    @property
    def is_fault(self) -> bool:
        return not self.kind.startswith(_FINE)


def command(*arguments: str) -> tuple[int, str]:
    """Exit code and standard error of one command, run in this process; Python's own warnings count as written."""
    from planner.cli import main

    error = io.StringIO()
    with contextlib.redirect_stderr(error), contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("always")
        code = main(list(arguments))
    return code, error.getvalue()


def judged(name: str, code: int, said: str, allowed: dict[int, str]) -> str:
    """The kind of outcome: `allowed` names the exit codes that are no fault."""
    if code not in allowed:
        return f"{name}: exit {code}"
    if "Traceback" in said or "Warning:" in said:
        return f"{name}: Python speaks"
    if "not enough memory" in said:
        return f"{name}: out of memory"
    if code in (2, 3) and sum(line.startswith("plan: error: ") for line in said.splitlines()) != 1:
        return f"{name}: not one line of error"
    return f"{_FINE}{allowed[code]}"


def outcomes(
    attempt: Callable[[int, Path], tuple[str, str]], items: range, folder: Path, n_processes: int
) -> Iterator[Outcome]:
    """The outcome of each item, as they come. `attempt` gets the item and a folder that is its process's own."""
    todo = iter(items)
    executor = [_Guarded(attempt, folder / f"desk{index}") for index in range(n_processes)]
    busy = [one for one in executor if one.begin(next(todo, None))]
    try:
        while busy:
            time.sleep(_LOOK_S)
            for one in list(busy):
                outcome = one.look()
                if outcome is not None:
                    yield outcome
                    if not one.begin(next(todo, None)):
                        busy.remove(one)
    finally:
        for one in executor:
            one.end()


class _Guarded:
    """A process that works on one item at a time, and is begun anew once it had to be ended."""

    def __init__(self, attempt: Callable[[int, Path], tuple[str, str]], desk: Path) -> None:
        self._attempt, self._desk = attempt, desk
        self._process: BaseProcess | None = None
        self._item = -1

    def begin(self, item: int | None) -> bool:
        if item is None:
            return False
        if self._process is None:
            context = multiprocessing.get_context("spawn")
            self._line, far_end = context.Pipe()
            self._process = context.Process(target=_work, args=(self._attempt, self._desk, far_end), daemon=True)
            self._process.start()
            far_end.close()
            self._line.recv()  # it has loaded what every item needs
        self._item = item
        self._line.send(item)
        self._began_s, self._used_s = time.monotonic(), self._processor_s()
        return True

    def look(self) -> Outcome | None:
        assert self._process is not None
        if self._line.poll():
            try:
                return Outcome(self._item, *self._line.recv())
            except EOFError:
                code = self._process.exitcode
                self.end()
                return Outcome(self._item, f"the process died ({code})")
        with contextlib.suppress(FileNotFoundError):
            if self._processor_s() - self._used_s > SECONDS:
                return self._broken_off(f"over {SECONDS:g} s of processor")
            if self._megabytes() > MEGABYTES:
                return self._broken_off(f"over {MEGABYTES:g} MB")
            if time.monotonic() - self._began_s > _STUCK_S:
                return self._broken_off("stands still")
        return None

    def end(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.join()
            self._process = None

    def _broken_off(self, kind: str) -> Outcome:
        self.end()
        return Outcome(self._item, kind)

    def _processor_s(self) -> float:
        fields = self._proc("stat").rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def _megabytes(self) -> float:
        return int(self._proc("statm").split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6

    def _proc(self, name: str) -> str:
        assert self._process is not None
        return Path(f"/proc/{self._process.pid}/{name}").read_text()


def _work(attempt: Callable[[int, Path], tuple[str, str]], desk: Path, line: Connection) -> None:
    desk.mkdir(parents=True, exist_ok=True)
    os.chdir(desk)
    attempt(-1, desk)
    line.send(None)
    while True:
        item = line.recv()
        for left_over in desk.iterdir():
            left_over.unlink()
        line.send(attempt(item, desk))


def told(found: Iterator[Outcome], keep: Path, write: Callable[[int, Path], None], n_items: int) -> int:
    """Print a table of the outcomes; keep what showed a fault. The exit code: 1 where anything did."""
    counts: dict[str, int] = {}
    for done, outcome in enumerate(found, 1):
        counts[outcome.kind] = counts.get(outcome.kind, 0) + 1
        if outcome.is_fault:
            keep.mkdir(parents=True, exist_ok=True)
            write(outcome.item, keep)
            print(f"item {outcome.item}: {outcome.kind}: {outcome.message[:400]}", file=sys.stderr, flush=True)
        if done % 500 == 0:
            print(f"{done} of {n_items}", file=sys.stderr, flush=True)
    for kind, count in sorted(counts.items(), key=lambda pair: -pair[1]):
        print(f"{count:>7}  {kind}")
    n_faults = sum(count for kind, count in counts.items() if not kind.startswith(_FINE))
    print(f"{sum(counts.values())} items, {n_faults} faults")
    return 1 if n_faults else 0
