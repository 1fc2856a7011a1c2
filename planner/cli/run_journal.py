"""`plan run`: the journal that a run keeps for a later --resume."""

from __future__ import annotations

import argparse
from contextlib import suppress

from hardware.clock import Clock
from hardware.drivers.driver import Driver, Remembering
from hardware.drivers.table import SIMULATORS
from hardware.playback.journal import Journal
from hardware.playback.journal_entry import Entry
from hardware.playback.observer import Observer
from planner.arrays import FloatArray
from planner.cli.run_files import is_kept, journal_of
from planner.cli.run_resume import FURTHER, in_doubt_words
from planner.cli.terminal import print_note, print_warnings
from planner.errors import OutputError


class RunJournal(Observer):
    """Begins the journal once the arm is ready, so that a wrong port does not cost the journal of an earlier run. Where
    no journal can be written there is only a warning; a run that resumes is refused, or it would be drawn twice.

    For a controller that remembers how far it came, the journal says how it counts; for others, which strokes were
    sent before they are known to be drawn.
    """

    def __init__(
        self,
        options: argparse.Namespace,
        beginning: Entry,
        last_stroke: int,
        driver: Driver,
        rate_hz: float,
        clock: Clock,
    ) -> None:
        self._options, self._beginning, self._last_stroke = options, beginning, last_stroke
        self._rate_hz, self._clock = rate_hz, clock
        self._remembering = driver if isinstance(driver, Remembering) else None
        self._journal: Journal | None = None

    def opened(self) -> None:
        """The line is open. Note what the controller remembers of an earlier run: connecting makes it forget."""
        if self._options.resume and self._remembering:
            self._begin()

    def connected(self) -> None:
        if self._journal is None:
            self._begin()
        if self._journal and self._remembering:
            self._journal.counted(self._remembering.tally(1 / self._rate_hz))

    def planned(self, first: int, samples: FloatArray) -> None:
        if self._journal and self._remembering:
            self._journal.planned(first, samples)
            if first == 1:  # on disk before anything is drawn
                self._journal.wait()

    def reached(self, executed: int, sent: int) -> None:
        if self._journal and self._remembering:
            self._journal.reached(executed, sent)

    def sent(self, stroke: int) -> None:
        if self._journal and not self._remembering:
            self._journal.sent(stroke)

    def finished(self, stroke: int) -> None:
        if self._journal:
            self._journal.finished(stroke)

    def close(self, ended: str, *, complete: bool) -> None:
        """Say how the run ended, and from where another goes on. Errors: OutputError where all else went well."""
        if self._journal is None:
            return
        try:
            self._journal.close(ended, complete=complete)
        except OutputError as error:
            if complete:
                raise
            print_warnings([str(error)])
        if not complete:
            print_note(self._rest(self._journal))

    def _begin(self) -> None:
        """In place of the earlier run's. Errors: OutputError where this run resumes."""
        options = self._options
        if not is_kept(options.trajectory):
            print_warnings(
                [f"--resume will not be able to go on: {options.trajectory} is not a file that can be found again"]
            )
            return
        path = journal_of(options)
        try:
            self._journal = Journal(path, self._beginning, self._clock, options.port or "")
        except OutputError as error:
            if options.resume:
                raise
            with suppress(OSError):
                if path.is_file():
                    path.unlink()  # it is of another run
            print_warnings([f"--resume will not be able to go on: {error}"])

    def _rest(self, journal: Journal) -> str:
        if journal.next_stroke > self._last_stroke:
            left = "there is nothing left for --resume" if self._options.driver in SIMULATORS else "--resume parks"
            return f"all strokes are drawn; {left}"
        doubt = FURTHER if self._remembering else in_doubt_words(journal.in_doubt)
        return f"--resume goes on from stroke {journal.next_stroke} of 0..{self._last_stroke}{doubt}"
