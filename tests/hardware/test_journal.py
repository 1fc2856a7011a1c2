from __future__ import annotations

from dataclasses import replace
from pathlib import Path

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
