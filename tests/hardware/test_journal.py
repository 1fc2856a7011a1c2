from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.journal import Entry, Journal, digest, journal_path, read_journal
from planner.errors import OutputError, TrajectoryFileError

BEGINNING = Entry("0f" * 32, "drawing_arm", "native", 3, "")


def _written(path: Path, strokes: list[int], ended: str | None = None) -> None:
    journal = Journal(path, BEGINNING)
    for stroke in strokes:
        journal.finished(stroke)
    journal.close(ended or "", complete=ended is None)


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv.journal"
    assert read_journal(path) is None
    journal = Journal(path, BEGINNING)
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
        tmp_path_factory: pytest.TempPathFactory, data: st.DataObject) -> None:
    path = tmp_path_factory.mktemp("journal") / "traj.csv.journal"
    _written(path, [3, 4, 5], "stopped")
    whole = path.read_bytes()
    lines = whole.splitlines(keepends=True)
    cut = data.draw(st.integers(len(lines[0]), len(whole)))
    path.write_bytes(whole[:cut] + data.draw(st.sampled_from([b"", b"\0\0\0\0", b"\n"])))
    entry = read_journal(path)
    assert entry is not None
    sure = sum(len(line) <= cut - len(lines[0]) - sum(map(len, lines[1:k])) for k, line in enumerate(lines[1:4], 1))
    assert entry.next_stroke in (3 + sure, min(4 + sure, 6))
    assert entry.ended in ("", "stopped")


@pytest.mark.parametrize("content", [b"", b"{}", b"t_s,q1_deg\n", b'{"journal": 9}\n', b"[1]\n", b'"text"\n'])
def test_what_is_no_journal_is_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "traj.csv.journal"
    path.write_bytes(content)
    with pytest.raises(TrajectoryFileError, match="is not a journal"):
        read_journal(path)


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
        Journal(tmp_path / "none" / "traj.csv.journal", BEGINNING)


GOLDEN = b"""\
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


def test_whole_lines_hold_torn_ones_do_not_and_a_later_run_begins_anew(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv.journal"
    path.write_bytes(GOLDEN)
    assert read_journal(path) == Entry("0f", "drawing_arm", "maestro", 4, "", 6)
    path.write_bytes(GOLDEN[:GOLDEN.index(b'{"journal": 1, "sha256": "0f"')])
    first = read_journal(path)
    assert first == Entry("aa", "drawing_arm", "maestro", 2, "complete", 0)


def test_what_was_sent_and_not_confirmed_is_in_doubt(tmp_path: Path) -> None:
    path = tmp_path / "traj.csv.journal"
    journal = Journal(path, BEGINNING, "/dev/ttyACM0")
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


def test_behind_a_line_that_a_full_disk_tore_the_next_one_is_whole(
        tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "traj.csv.journal"
    journal = Journal(path, BEGINNING)
    whole = journal._file

    class Full:
        """Takes half of the next line, and all of those after it."""

        def __init__(self) -> None:
            self.full = True

        def write(self, content: bytes) -> int:
            content = content[:len(content) // 2] if self.full else content
            self.full = False
            return int(whole.write(content) or 0)

        def __getattr__(self, name: str) -> object:
            return getattr(whole, name)

    monkeypatch.setattr(journal, "_file", Full())
    journal.finished(3)
    journal.finished(4)
    with pytest.raises(OutputError, match="No space left"):
        journal.close("stopped")
    assert read_journal(path) == Entry(BEGINNING.sha256, "drawing_arm", "native", 5, "stopped")


@pytest.mark.parametrize("content", [
    b"[" * 100_000, b'{"journal": ' + b"[" * 100_000, b'{"journal": 1, "next_stroke": ' + b"9" * 5000 + b"}",
    b'{"journal": 1, "sha256": "", "arm": "a", "driver": "d", "next_stroke": true}\n',
    b'{"journal": 1, "sha256": "", "arm": "a", "driver": "d", "next_stroke": -1}\n',
    b'{"journal": 1, "sha256": "", "arm": "a", "driver": "d", "next_stroke": 1.5}\n',
    b'[["journal", 1], ["sha256", ""], ["arm", "a"], ["driver", "d"], ["next_stroke", 1]]\n'])
def test_what_is_hostile_is_no_journal(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "traj.csv.journal"
    path.write_bytes(content)
    with pytest.raises(TrajectoryFileError, match="is not a journal"):
        read_journal(path)


def test_what_is_no_file_or_has_no_end_is_no_journal(tmp_path: Path) -> None:
    pipe, huge, folder = tmp_path / "pipe", tmp_path / "huge", tmp_path / "folder"
    os.mkfifo(pipe)
    with pytest.raises(TrajectoryFileError, match="is no file"):
        read_journal(pipe)
    with pytest.raises(OutputError, match="is no file"):
        Journal(pipe, BEGINNING)
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
                    del content[at:at + rng.integers(1, 8)]
                case 2:
                    content[at:at] = bytes(rng.choice(list(b'{}[]",:0123456789\n\\ue'), rng.integers(1, 8)).tolist())
                case 3:
                    content[at:at] = content[:rng.integers(0, len(content))]
        path.write_bytes(content)
        try:
            entry = read_journal(path)
        except TrajectoryFileError:
            continue
        assert entry is not None
        assert entry.next_stroke >= 0
