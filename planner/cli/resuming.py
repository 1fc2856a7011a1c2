"""`plan run --resume`: where an earlier run got to, and keeping that for a later one."""

from __future__ import annotations

import argparse
from contextlib import suppress
from pathlib import Path

from hardware.clock import Clock
from hardware.course import next_to_draw
from hardware.driver import Driver, Remembering
from hardware.drivers import SIMULATORS
from hardware.journal import NOTED_EVERY_S, Entry, Journal, digest, journal_path, read_journal
from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.cli.terminal import print_note, print_warnings
from planner.errors import OutputError, UsageError


def where_to_begin(options: argparse.Namespace, arm: Arm, stroke: IntArray, driver: Driver | None) -> Entry:
    """From which stroke, of which file and for which arm; in the midst of that stroke where `sample` says so.

    stroke: (n_samples,) labels of the trajectory. driver: asked how far its controller came before it was left alone;
    None asks nobody. Errors: TrajectoryFileError, UsageError, HardwareError.
    """
    path = _path(options)
    sha256 = digest(options.trajectory) if options.trajectory.is_file() else ""  # a pipe has been read already
    if not options.resume:
        return Entry(sha256, arm.name, options.driver, options.from_stroke or 0, "")
    earlier = read_journal(path)
    if earlier is None:
        raise UsageError(f"there is nothing to resume: no journal {path}")
    if earlier.sha256 != sha256:
        raise UsageError(f"{options.trajectory} is not what was being drawn, for it has changed since; "
                         "draw it without --resume")
    if earlier.arm != arm.name:
        raise UsageError(f"arm '{earlier.arm}' was drawing {options.trajectory}, not '{arm.name}'")
    if earlier.complete:
        return earlier
    reached, doubt = _reached(earlier, driver)
    sample = earlier.come_to(reached)
    begin, midst = (earlier.next_stroke, None) if sample is None else next_to_draw(stroke, sample)
    if begin < earlier.next_stroke:
        begin, midst = earlier.next_stroke, None
    how = f" ({earlier.ended})" if earlier.ended else ""
    print_note(f"the earlier run ended before stroke {begin} was finished{how}; going on "
               f"{'from' if midst is None else 'in the midst of'} stroke {begin}{doubt}")
    return Entry(sha256, arm.name, options.driver, begin, "", midst)


def _reached(earlier: Entry, driver: Driver | None) -> tuple[int, str]:
    """How many set points the earlier run reached, and a few words on what may be drawn twice."""
    remembered = driver.recall(earlier.tally) if isinstance(driver, Remembering) else None
    if earlier.tally is None or earlier.settled:
        return earlier.reached, ""
    if not isinstance(driver, Remembering):
        return earlier.reached, ", or further on if the controller has come further"
    if remembered is not None and remembered >= earlier.reached:
        return remembered, ": the controller tells how far it came, and nothing is drawn twice"
    return earlier.reached, (": the controller does not know how far it came, so what it drew at the last, "
                             f"{driver.ahead_s + NOTED_EVERY_S:.1f} s at most, is drawn again")


class Keeping:
    """What a run keeps for a later --resume: a journal, begun once the arm is there, for a wrong port must not cost an
    earlier run's. Where none can be written there is a warning and none; a run that resumes is refused then, for what
    it draws would be drawn again."""

    def __init__(self, options: argparse.Namespace, beginning: Entry, driver: Driver, rate_hz: float,
                 clock: Clock) -> None:
        self._path, self._beginning, self._rate_hz, self._clock = _path(options), beginning, rate_hz, clock
        self._remembering = driver if isinstance(driver, Remembering) else None
        self._journal: Journal | None = None
        self._begun, self._resumes = False, bool(options.resume)
        if self._resumes and self._remembering:
            self.begin()  # the arm is there and has told all that it knows, which connecting makes it forget

    def begin(self) -> None:
        """A new journal in place of the earlier run's."""
        if self._begun:
            return
        self._begun = True
        try:
            self._journal = Journal(self._path, self._beginning, self._clock)
        except OutputError as error:
            if self._resumes:
                raise
            with suppress(OSError):
                self._path.unlink(missing_ok=True)  # which does not tell of this run
            print_warnings([f"there will be nothing for --resume to go by: {error}"])

    def connected(self) -> None:
        self.begin()
        if self._journal and self._remembering:
            self._journal.counted(self._remembering.tally(1 / self._rate_hz))

    def onward(self, first: int, samples: FloatArray) -> None:
        if self._journal and self._remembering:
            self._journal.onward(first, samples)
            if first == 1:  # before anything is drawn that could not be told from what is not
                self._journal.wait()

    def reached(self, executed: int, sent: int) -> None:
        if self._journal and self._remembering:
            self._journal.reached(executed, sent)

    def finished(self, stroke: int) -> None:
        if self._journal:
            self._journal.finished(stroke)

    def close(self, ended: str, last_stroke: int, *, complete: bool) -> None:
        """Errors: OutputError."""
        if not self._journal:
            return
        self._journal.close(ended, complete=complete)
        if not complete:
            print_note(f"--resume goes on from stroke {self._journal.next_stroke} of 0..{last_stroke}")


def _path(options: argparse.Namespace) -> Path:
    return journal_path(options.trajectory, simulated=options.driver in SIMULATORS)
