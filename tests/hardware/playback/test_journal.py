from __future__ import annotations

import errno
import json
import os
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import IO, Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.clock import InstantClock
from hardware.drivers.driver import Tally
from hardware.playback.journal import NOTED_EVERY_S, Journal, digest, journal_path
from hardware.playback.journal_entry import Entry, read_journal
from hardware.playback.sample_map import next_to_draw
from planner.errors import OutputError, TrajectoryFileError

BEGINNING = Entry("0f" * 32, "drawing_arm", "native", 3, "")


def _written(path: Path, strokes: list[int], ended: str | None = None) -> None:
    journal = Journal(path, BEGINNING, InstantClock())
    for stroke in strokes:
        journal.finished(stroke)
    journal.close(ended or "", complete=ended is None)


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv.journal"
    assert read_journal(path) is None
    journal = Journal(path, BEGINNING, InstantClock())
    assert read_journal(path) == BEGINNING  # before anything moves
    journal.finished(3)
    journal.finished(4)
    assert journal.next_stroke == 5
    journal.close("the line is dead")
    entry = read_journal(path)
    assert entry == replace(BEGINNING, next_stroke=5, ended="the line is dead")
    assert not entry.complete
    _written(path, [3, 4, 5])
    entry = read_journal(path)
    assert entry is not None
    assert entry.complete
    assert list(tmp_path.iterdir()) == [path]


@settings(max_examples=30, deadline=None)
@given(data=st.data())
def test_cut_anywhere_it_remembers_what_was_on_disk(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    path = tmp_path_factory.mktemp("journal") / "traj.csv.journal"
    _written(path, [3, 4, 5], "stopped")
    whole = path.read_bytes()
    lines = whole.splitlines(keepends=True)
    begun = len(lines[0] + lines[1])
    cut = data.draw(st.integers(begun, len(whole)))
    path.write_bytes(whole[:cut] + data.draw(st.sampled_from([b"", b"\0\0\0\0", b"\n"])))
    entry = read_journal(path)
    assert entry is not None
    sure = sum(len(line) <= cut - begun - sum(map(len, lines[2:k])) for k, line in enumerate(lines[2:5], 2))
    assert entry.next_stroke in (3 + sure, min(4 + sure, 6))
    assert entry.ended in ("", "stopped")


@pytest.mark.parametrize("content", [b"", b"{}", b"t_s,q1_deg\n", b'{"journal": 9}\n', b"[1]\n", b'"text"\n'])
def test_what_is_no_journal_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "traj.csv.journal"
    path.write_bytes(content)
    with pytest.raises(TrajectoryFileError, match="is not a journal"):
        read_journal(path)


def _read(path: Path) -> Entry:
    entry = read_journal(path)
    assert entry is not None
    return entry


def test_where_the_arm_has_come_to_is_noted_now_and_then_and_at_the_end_in_place(tmp_path: Path) -> None:
    clock, path = InstantClock(), tmp_path / "traj.csv.journal"
    journal = Journal(path, replace(BEGINNING, sample=30), clock)
    assert _read(path).come_to(0) == 30
    journal.counted(Tally(77, 5, 2))
    journal.planned(1, np.array([30.0, 30.0, 30.2, 31.0, 32.0, 33.0, 34.0]))
    journal.planned(5, np.array([31.5, 31.8, 31.8]))  # it brakes
    journal.reached(0, 2)
    length = 0
    for executed in range(1, 7):
        clock.sleep_until(clock.now_s() + 0.6 * NOTED_EVERY_S)
        journal.reached(executed, executed + 1)
        journal._writer.submit(lambda: None).result()  # what was told is written
        assert executed - _read(path).reached <= 1
        length = length or path.stat().st_size
        assert path.stat().st_size == length
    journal.close("the line is dead")
    entry = _read(path)
    assert (entry.tally, entry.reached, entry.sent, entry.all_reached) == (Tally(77, 5, 2), 6, 7, False)
    assert [entry.come_to(reached) for reached in range(9)] == [30, 30, 30, 30.2, 31, 31.5, 31.8, 31.8, 31.8]
    assert entry.at == 31.8


class _Full:
    """A disk with room for so many bytes more: what there is can be written over."""

    def __init__(self, file: IO[bytes], room: int) -> None:
        self._file, self._most = file, file.seek(0, 2) + room

    def __getattr__(self, name: str) -> Any:
        return getattr(self._file, name)

    def write(self, line: bytes) -> int:
        fits = min(len(line), self._most - self._file.tell())
        if fits <= 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        return self._file.write(line[:fits])


@settings(max_examples=50, deadline=None)
@given(room=st.integers(0, 450))
def test_on_a_full_disk_the_journal_never_tells_of_more_than_there_was(
    tmp_path_factory: pytest.TempPathFactory, room: int
) -> None:
    """A pause that it has no room for would have it take resting for drawing."""
    path = tmp_path_factory.mktemp("journal") / "traj.csv.journal"
    journal = Journal(path, replace(BEGINNING, sample=30), InstantClock())
    journal._file = _Full(journal._file, room)  # type: ignore[assignment]
    journal.counted(Tally(77, 5, 1))
    journal.planned(1, 30.0 + np.arange(1000))
    journal.planned(101, np.full(1000, 130.0))
    journal.planned(801, np.concatenate((np.full(10, 130.0), 130.0 + np.arange(1000))))
    journal.finished(3)
    truth = {50: 79.0, 500: 130.0, 809: 130.0, 911: 230.0}
    journal.reached(911, 920)
    if room < 450:
        with suppress(OutputError):
            journal.close("stopped")
    else:
        journal.close("stopped")
    entry = _read(path)
    for reached, sample in truth.items():
        told = entry.come_to(reached)
        assert told is not None
        assert 30 <= told <= sample
        assert room < 400 or told == sample
    assert entry.reached in (0, 911)
    assert entry.next_stroke in (3, 4)


@given(
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
        lambda one: st.lists(one, max_size=4) | st.dictionaries(st.text(max_size=5), one, max_size=4),
    ),
    st.sampled_from(
        ["next_stroke", "sample", "tally", "course", "reached", "sent", "course_until", "at", "ended", "arm", "journal"]
    ),
)
def test_whatever_stands_in_a_line_it_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, value: object, key: str
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.journal"
    if not path.exists():  # once: each journal waits for the disk
        Journal(path, BEGINNING, InstantClock()).close("stopped")
    begun = b"".join(path.read_bytes().splitlines(keepends=True)[:3])
    lines = ({"course": [[1, 0.0], [5, 4.0]]}, {key: value})
    path.write_bytes(begun + b"".join(json.dumps(line).encode() + b"\n" for line in lines))
    with suppress(TrajectoryFileError):
        entry = _read(path)
        for reached in (0, entry.reached):
            next_to_draw(np.array([-1, 0, 0, -1]), entry.come_to(reached) or 0.0)


def test_a_rehearsal_leaves_the_journal_of_the_arm_alone() -> None:
    assert journal_path(Path("a/traj.csv"), simulated=False) == Path("a/traj.csv.journal")
    assert journal_path(Path("a/traj.csv"), simulated=True) == Path("a/traj.csv.sim.journal")


def test_a_changed_file_has_another_digest(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv"
    path.write_text("a")
    before = digest(path)
    path.write_text("b")
    assert digest(path) != before
    with pytest.raises(TrajectoryFileError, match="No such file"):
        digest(tmp_path / "none.csv")


def test_a_folder_that_takes_no_journal_is_said_at_once(tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="there is no folder"):
        Journal(tmp_path / "none" / "traj.csv.journal", BEGINNING, InstantClock())


GOLDEN_1 = b"""\
{"journal": 1, "sha256": "aa", "arm": "drawing_arm", "driver": "maestro", "next_stroke": 0}
{"sent_stroke": 0}
{"next_stroke": 1}
{"next_str{"sent_stroke": 1}
{"next_stroke": 2}
{"ended": "complete"}
{"journal": 1, "sha256": "0f", "arm": "drawing_arm", "driver": "maestro", "next_stroke": 2, "port": "/dev/ttyACM0"}
{"sent_stroke": 4}
{"next_stroke": 4}
\0\0\0\0{"next_stroke": 9}
{"sent_stroke": 6}
"""
"""Two runs, one behind the other, each with a torn line; nobody was left to say how the second ended."""


GOLDEN_2 = b"""\
{"journal": 2, "sha256": "0f", "arm": "scara", "driver": "native", "next_stroke": 2, "sample": 30, "port": "/dev/tty9"}
{"reached": 6, "sent": 9, "course_until": null, "at": 31.8}                                  \n\
{"tally": {"run": 77, "first": 5, "each": 2}}
{"course": [[1, 30.0], [2, 30.0], [3, 30.2], [7, 34.0]]}
{"course": [[5, 31.5], [6, 31.8], [7, 31.8]]}
{"next_stroke": 3}
{"ended": "the line is dead"}
"""
"""A run that its controller counts: it braked after four of seven set points."""


def test_a_journal_of_set_points_is_read(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv.journal"
    path.write_bytes(GOLDEN_2)
    entry = _read(path)
    assert entry == Entry(
        "0f",
        "scara",
        "native",
        3,
        "the line is dead",
        -1,
        30,
        Tally(77, 5, 2),
        (((1, 30.0), (2, 30.0), (3, 30.2), (7, 34.0)), ((5, 31.5), (6, 31.8), (7, 31.8))),
        6,
        9,
        None,
        31.8,
    )
    assert [entry.come_to(reached) for reached in (0, 3, 5, 9)] == [30, 30.2, 31.5, 31.8]
    path.write_bytes(GOLDEN_2 + GOLDEN_1.replace(b"drawing_arm", b"arm"))
    assert read_journal(path) == Entry("0f", "arm", "maestro", 4, "", 6)  # of another run, and all of the first is over


def test_whole_lines_hold_torn_ones_do_not_and_a_later_run_begins_anew(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv.journal"
    path.write_bytes(GOLDEN_1)
    assert read_journal(path) == Entry("0f", "drawing_arm", "maestro", 4, "", 6)
    path.write_bytes(GOLDEN_1[: GOLDEN_1.index(b'{"journal": 1, "sha256": "0f"')])
    first = read_journal(path)
    assert first == Entry("aa", "drawing_arm", "maestro", 2, "complete", 0)


def test_lines_after_a_torn_one_hold_in_the_version_that_counts_set_points_too(tmp_path: Path) -> None:
    """Each line torn in turn, as by a full disk or a power failure: what the others say is believed all the same."""
    path = tmp_path / "traj.csv.journal"
    lines = GOLDEN_2.splitlines(keepends=True)
    path.write_bytes(GOLDEN_2)
    whole = _read(path)
    untold = {
        1: {"reached": 0, "sent": 0, "at": None},
        2: {"tally": None},
        3: {"course": whole.course[1:]},
        4: {"course": whole.course[:1]},
        5: {"next_stroke": 2},
        6: {"ended": ""},
    }
    for torn, changes in untold.items():
        for left in (lines[torn][:12] + b"\n", b"\0" * 12 + lines[torn]):
            path.write_bytes(b"".join((*lines[:torn], left, *lines[torn + 1 :])))
            assert _read(path) == replace(whole, **changes)


@pytest.mark.parametrize("version", [0, 3, 9, "2", None, 1.5])
def test_a_journal_of_an_unknown_version_is_refused(tmp_path: Path, version: object) -> None:
    path = tmp_path / "traj.csv.journal"
    path.write_bytes(GOLDEN_2.replace(b'"journal": 2', b'"journal": ' + json.dumps(version).encode()))
    with pytest.raises(TrajectoryFileError, match="is not a journal"):
        read_journal(path)


def test_what_was_sent_and_not_confirmed_is_in_doubt(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv.journal"
    journal = Journal(path, BEGINNING, InstantClock(), "/dev/ttyACM0")
    for stroke in (3, 4, 5):
        journal.sent(stroke)
    journal.finished(3)
    assert list(journal.in_doubt) == [4, 5]
    journal.close("the line is dead")
    entry = read_journal(path)
    assert entry is not None
    assert list(entry.in_doubt) == [4, 5]
    first = json.loads(path.read_text().splitlines()[0])
    assert (first["port"], first["process"]) == ("/dev/ttyACM0", os.getpid())


def test_a_line_that_a_full_disk_tore_makes_room_for_the_next(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv.journal"
    journal = Journal(path, BEGINNING, InstantClock())
    whole = journal._file

    class Tearing:
        """Takes half of the next line, no more of it, and all of those after it."""

        def __init__(self) -> None:
            self.writes = 0

        def write(self, line: bytes) -> int:
            self.writes += 1
            if self.writes == 2:
                raise OSError(errno.ENOSPC, "No space left on device")
            return int(whole.write(line[: len(line) // 2] if self.writes == 1 else line) or 0)

        def __getattr__(self, name: str) -> Any:
            return getattr(whole, name)

    journal._file = Tearing()  # type: ignore[assignment]
    journal.finished(3)
    journal.finished(4)
    with pytest.raises(OutputError, match="No space left"):
        journal.close("stopped")
    assert read_journal(path) == replace(BEGINNING, next_stroke=5, ended="stopped")


@pytest.mark.parametrize(
    "content",
    [
        b"[" * 100_000,
        b'{"journal": ' + b"[" * 100_000,
        b'{"journal": 1, "next_stroke": ' + b"9" * 5000 + b"}",
        b'{"journal": 1, "sha256": "", "arm": "a", "driver": "d", "next_stroke": true}\n',
        b'{"journal": 1, "sha256": "", "arm": "a", "driver": "d", "next_stroke": -1}\n',
        b'{"journal": 1, "sha256": "", "arm": "a", "driver": "d", "next_stroke": 1.5}\n',
        b'[["journal", 1], ["sha256", ""], ["arm", "a"], ["driver", "d"], ["next_stroke", 1]]\n',
    ],
)
def test_what_is_hostile_is_no_journal(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "traj.csv.journal"
    path.write_bytes(content)
    with pytest.raises(TrajectoryFileError, match="is not a journal"):
        read_journal(path)


def test_what_is_no_file_or_has_no_end_is_no_journal(tmp_path: Path) -> None:
    pipe, huge, folder = tmp_path / "pipe", tmp_path / "huge", tmp_path / "folder"
    os.mkfifo(pipe)
    with pytest.raises(TrajectoryFileError, match="is not a file"):
        read_journal(pipe)
    with pytest.raises(OutputError, match="is not a file"):
        Journal(pipe, BEGINNING, InstantClock())
    huge.touch()
    os.truncate(huge, 1 << 34)
    with pytest.raises(TrajectoryFileError, match="is too long"):
        read_journal(huge)
    folder.mkdir()
    with pytest.raises(TrajectoryFileError, match="cannot be read: Is a directory"):
        read_journal(folder)
    with pytest.raises(TrajectoryFileError, match="cannot be read: File name too long"):
        read_journal(tmp_path / ("x" * 300))


def test_how_a_run_ended_is_fit_for_a_terminal(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv.journal"
    _written(path, [3], "\x1b[2J\nnew\x00" + "x" * 5000)
    entry = read_journal(path)
    assert entry is not None
    assert entry.ended.isprintable()
    assert len(entry.ended) == 1000


def test_five_hundred_mutants_are_a_journal_or_none(tmp_path: Path) -> None:
    path, rng = tmp_path / "traj.csv.journal", np.random.default_rng(3)
    _written(path, [3, 4, 5, 6], "stopped")
    whole = path.read_bytes()
    for _ in range(500):
        content = bytearray(whole)
        for at in rng.integers(0, len(content) - 8, rng.integers(1, 9)):
            match rng.integers(0, 4):
                case 0:
                    content[at] = rng.integers(0, 256)
                case 1:
                    del content[at : at + rng.integers(1, 8)]
                case 2:
                    content[at:at] = bytes(rng.choice(list(b'{}[]",:0123456789\n\\ue'), rng.integers(1, 8)).tolist())
                case 3:
                    content[at:at] = content[: rng.integers(0, len(content))]
        path.write_bytes(content)
        try:
            entry = read_journal(path)
        except TrajectoryFileError:
            continue
        assert entry is not None
        assert entry.next_stroke >= 0
