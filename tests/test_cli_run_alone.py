"""One run at a time of a trajectory and on a port, and only of what can be told to be the same is a run resumed."""

from __future__ import annotations

import errno
import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from hardware.playback.claims import Claimed, claim, claim_of_journal, claim_of_port
from hardware.playback.journal import journal_path
from planner.cli import main
from tests.drawn_shapes import lines_svg
from tests.hardware.controllers.lines import pty_line
from tests.hardware.controllers.ssc32 import Ssc32Model

ROOT = Path(__file__).resolve().parent.parent
RUN = [sys.executable, "-m", "planner.cli", "run"]

pytestmark = pytest.mark.skipif(os.name != "posix", reason="locks and pipes of POSIX")


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Ten taps in a row, some five seconds of them."""
    folder = tmp_path_factory.mktemp("planned")
    drawing, target = folder / "drawing.svg", folder / "traj.csv"
    taps = "".join(f'<path d="M{x} {x % 3}h0"/>' for x in range(0, 160, 16))
    drawing.write_text(lines_svg(f"{taps}", 'viewBox="0 0 160 60"'))
    assert main([str(drawing), "-o", str(target), "--quiet"]) == 0
    return target


@pytest.fixture
def csv(planned: Path, tmp_path: Path) -> Path:
    copy = tmp_path / "traj.csv"
    copy.write_bytes(planned.read_bytes())
    return copy


@pytest.fixture
def running(csv: Path) -> Iterator[subprocess.Popen[bytes]]:
    """A run of `csv` on the simulated arm, at its work."""
    process = subprocess.Popen([*RUN, str(csv)], cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    until = time.monotonic() + 60
    while not journal_path(csv, simulated=True).exists() and time.monotonic() < until:
        time.sleep(0.02)
    yield process
    process.kill()
    process.wait()


def test_a_second_run_of_a_trajectory_is_refused_by_name_until_the_first_is_gone(
    csv: Path, running: subprocess.Popen[bytes], capsys: pytest.CaptureFixture[str]
) -> None:
    link = csv.with_name("link.csv")
    link.symlink_to(csv)
    before = journal_path(csv, simulated=True).read_bytes()
    for options in (["--fast"], ["--fast", "--resume"]):
        assert main(["run", str(csv), *options]) == 2
        told = capsys.readouterr().err
        assert f"{csv} is being drawn by another run: process {running.pid}, drawing it on a simulated arm" in told
        assert f"end it: kill {running.pid}" in told
        assert re.search(r"since \d{4}-\d\d-\d\d \d\d:\d\d:\d\d", told)
    assert journal_path(csv, simulated=True).read_bytes().startswith(before)
    running.kill()
    running.wait()
    assert claim_of_journal(journal_path(csv, simulated=True)).exists()  # and says nothing any more
    assert main(["run", str(csv), "--fast", "--resume", "--quiet"]) == 0
    assert not claim_of_journal(journal_path(csv, simulated=True)).exists()


def test_a_dry_run_and_another_arm_may_go_on_beside_it(csv: Path, running: subprocess.Popen[bytes]) -> None:
    assert main(["run", str(csv), "--driver", "maestro", "--dry-run"]) == 0
    with pty_line(Ssc32Model()) as far, claim(claim_of_port(str(csv.with_name("another"))), "drawing"):
        assert main(["run", str(csv), "--driver", "ssc32", "--port", far.name, "--from-stroke", "9", "--quiet"]) == 0


def test_a_port_that_another_run_has_is_refused_by_name(csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pty_line(Ssc32Model()) as far, claim(claim_of_port(far.name), "drawing other.csv"):
        link = csv.with_name("arm")
        link.symlink_to(far.name)
        for port in (far.name, str(link)):
            assert main(["run", str(csv), "--driver", "ssc32", "--port", port]) == 4
            told = capsys.readouterr().err
            assert f"plan: error: {port}: another run has it: process {os.getpid()}, drawing other.csv, since" in told
        far.finish()
        assert far.received == b""
    assert list(csv.parent.glob("traj.csv.*")) == []


def test_a_claim_lasts_as_long_as_its_process_whatever_its_file_says(tmp_path: Path) -> None:
    path = tmp_path / "lock"
    path.write_text(f"process {os.getpid()}, which lives")  # of a run that was killed, whose number is another's now
    with claim(path, "drawing a"):
        with pytest.raises(Claimed, match="drawing a"), claim(path, "drawing b"):
            pass
        assert path.exists()
    assert not path.exists()
    path.write_bytes(np.random.default_rng(1).bytes(5000))
    with claim(path, "drawing c"):
        pass


def test_many_that_want_it_at_once_get_it_one_at_a_time(tmp_path: Path) -> None:
    path, inside, most, refused = tmp_path / "lock", list[int](), list[int](), list[str]()

    def want(number: int) -> None:
        for _ in range(50):
            try:
                with claim(path, f"number {number}"):
                    inside.append(number)
                    most.append(len(inside))
                    inside.remove(number)
            except Claimed as other:
                refused.append(str(other))

    threads = [threading.Thread(target=want, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert max(most) == 1
    assert len(most) + len(refused) == 200


def test_a_full_disk_keeps_nobody_from_a_claim(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(descriptor: int, content: bytes) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    path = tmp_path / "lock"
    monkeypatch.setattr(os, "write", full)
    with claim(path, "drawing"), pytest.raises(Claimed, match="has just begun"), claim(path, "drawing"):
        pass
    assert not path.exists()


def test_where_no_claim_can_be_made_there_is_none(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "none" / "lock", tmp_path, tmp_path / "pipe", tmp_path / ("x" * 300)):
        with claim(path, "drawing"):
            pass
    assert (tmp_path / "pipe").exists()


def test_a_pipe_is_drawn_without_a_journal_and_never_resumed(
    csv: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    assert main(["run", str(pipe), "--fast", "--resume"]) == 2  # at once, though nobody writes
    assert "--resume cannot know whether it has changed" in capsys.readouterr().err
    writer = threading.Thread(target=lambda: pipe.write_bytes(csv.read_bytes()))
    writer.start()
    assert main(["run", str(pipe), "--fast"]) == 0
    writer.join()
    assert "--resume will not be able to go on" in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["pipe", "traj.csv"]


@pytest.mark.parametrize("options", [[], ["--resume"]])
def test_standard_input_gets_no_journal_even_where_it_is_a_file(csv: Path, options: list[str]) -> None:
    before = sorted(Path("/dev").glob("*.journal*"))
    with csv.open("rb") as file:
        done = subprocess.run(
            [*RUN, "/dev/stdin", "--fast", *options],
            cwd=ROOT,
            stdin=file,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
    assert done.returncode == (2 if options else 0)
    assert "--resume will not be able to go on" in done.stderr or "--resume cannot know" in done.stderr
    assert sorted(Path("/dev").glob("*.journal*")) == before
    assert list(csv.parent.iterdir()) == [csv]


def test_a_pipe_in_a_journals_place_holds_nothing_up(csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    os.mkfifo(journal_path(csv, simulated=True))
    assert main(["run", str(csv), "--fast", "--quiet"]) == 0
    assert "--resume will not be able to go on" in capsys.readouterr().err
    assert main(["run", str(csv), "--fast", "--resume"]) == 2


def test_a_name_too_long_for_a_journal_is_drawn_without_one(csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    longest = csv.rename(csv.with_name("x" * 248 + ".csv"))
    assert main(["run", str(longest), "--fast", "--quiet"]) == 0
    assert "--resume will not be able to go on" in capsys.readouterr().err
    assert main(["run", str(longest), "--fast", "--resume"]) == 2
    assert "File name too long" in capsys.readouterr().err


@pytest.mark.parametrize(
    "content",
    [
        b"[" * 100_000,
        b"\x00\xff\x80" * 1000,
        b'{"journal": 1}\n',
        b'{"journal": 1, "sha256": "SHA", "arm": "drawing_arm", "driver": "sim", "next_stroke": 99}\n',
        b'{"journal": 1, "sha256": "SHA", "arm": "drawing_arm", "driver": "sim", "next_stroke": 1, '
        b'"sent_stroke": 99}\n',
    ],
)
def test_a_journal_that_cannot_be_true_is_refused(
    content: bytes, csv: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from hardware.playback.journal import digest

    journal_path(csv, simulated=True).write_bytes(content.replace(b"SHA", digest(csv).encode()))
    assert main(["run", str(csv), "--fast", "--resume"]) == 2
    told = capsys.readouterr().err
    assert told.startswith("plan: error: ")
    assert told.count("\n") == 1


def test_strokes_in_doubt_are_drawn_again_and_told(csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from hardware.playback.journal import digest

    journal_path(csv, simulated=True).write_text(
        f'{{"journal": 1, "sha256": "{digest(csv)}", "arm": "drawing_arm", "driver": "sim", "next_stroke": 4, '
        '"sent_stroke": 6}\n'
    )
    assert main(["run", str(csv), "--fast", "--resume"]) == 0
    assert (
        "going on from stroke 4; strokes 4 to 6 were sent, but not confirmed by the controller: "
        "drawn again, unless you see the ink and use --from-stroke 7 instead"
    ) in capsys.readouterr().err
