"""`plan run --resume`: where an earlier run got to, by its journal and by what its controller remembers."""

from __future__ import annotations

import argparse

from hardware.drivers.driver import Driver, Remembering
from hardware.playback.journal import NOTED_EVERY_S, digest
from hardware.playback.journal_entry import Entry, read_journal
from hardware.playback.sample_map import next_to_draw
from planner.arms.arm import Arm
from planner.arrays import IntArray
from planner.cli.run_files import is_kept, journal_of
from planner.cli.terminal import print_note
from planner.errors import UsageError

FURTHER = ", or further on if the controller has come further"


def where_to_begin(options: argparse.Namespace, arm: Arm, stroke: IntArray, driver: Driver | None) -> Entry:
    """From which stroke, of which file and for which arm; in the middle of that stroke where `sample` says so.

    stroke: (n_samples,) labels of the trajectory. driver: asked how far its controller came before it was left alone;
    None asks nobody. Errors: TrajectoryFileError, UsageError, HardwareError.
    """
    if not options.resume:
        sha256 = digest(options.trajectory) if is_kept(options.trajectory) else ""
        return Entry(sha256, arm.name, options.driver, options.from_stroke or 0, "")
    earlier = _earlier(options, arm, stroke)
    if earlier.complete:
        return earlier
    reached, doubt = _reached(earlier, driver)
    sample = earlier.come_to(reached)
    begin, middle = (earlier.next_stroke, None) if sample is None else next_to_draw(stroke, sample)
    if begin < earlier.next_stroke:
        begin, middle = earlier.next_stroke, None
    how = f" ({earlier.ended})" if earlier.ended else ""
    if begin > stroke.max():
        print_note(f"the earlier run ended after all strokes were drawn{how}")
    else:
        print_note(
            f"the earlier run ended before stroke {begin} was finished{how}; going on "
            f"{'from' if middle is None else 'in the middle of'} stroke {begin}{doubt}"
        )
    return Entry(earlier.sha256, arm.name, options.driver, begin, "", sample=middle)


def in_doubt_words(strokes: range) -> str:
    """A few words on strokes that were sent and may or may not have been drawn."""
    if not strokes:
        return ""
    which = f"stroke {strokes[0]} was" if len(strokes) == 1 else f"strokes {strokes[0]} to {strokes[-1]} were"
    return (
        f"; {which} sent, but not confirmed by the controller: drawn again, unless you see the "
        f"ink and use --from-stroke {strokes[-1] + 1} instead"
    )


def _earlier(options: argparse.Namespace, arm: Arm, stroke: IntArray) -> Entry:
    """What the journal says. Errors: TrajectoryFileError, UsageError where it is of something else."""
    path = journal_of(options)
    earlier = read_journal(path)
    if earlier is None:
        raise UsageError(f"there is nothing to resume: no journal {path}")
    if earlier.sha256 != digest(options.trajectory):
        raise UsageError(f"{options.trajectory} has changed since it was being drawn; draw it without --resume")
    if earlier.arm != arm.name:
        raise UsageError(f"arm '{earlier.arm}' was drawing {options.trajectory}, not '{arm.name}'")
    if max(earlier.next_stroke - 1, earlier.last_sent) > stroke.max() or (earlier.come_to(earlier.reached) or 0) >= len(
        stroke
    ):
        raise UsageError(
            f"{path} names strokes that {options.trajectory} does not have, so it is damaged; go on with --from-stroke"
        )
    return earlier


def _reached(earlier: Entry, driver: Driver | None) -> tuple[int, str]:
    """How many set points the earlier run reached, and a few words on what may be drawn twice."""
    remembered = driver.recall(earlier.tally) if isinstance(driver, Remembering) else None
    if earlier.tally is None or earlier.all_reached:
        return earlier.reached, in_doubt_words(earlier.in_doubt)
    if not isinstance(driver, Remembering):
        return earlier.reached, FURTHER
    if remembered is not None and remembered >= earlier.reached:
        return remembered, ": the controller knows how far it came, and nothing is drawn twice"
    return earlier.reached, (
        ": the controller does not know how far it came, so the last "
        f"{driver.ahead_s + NOTED_EVERY_S:.1f} s, at most, are drawn again"
    )
