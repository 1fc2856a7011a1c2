"""However `plan run` is asked to end, the pen goes up, the arm parks, and the journal knows."""

from __future__ import annotations

import json
import signal
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from hardware.playback.journal import digest, journal_path
from hardware.playback.journal_entry import read_journal
from planner.cli import main
from tests.drawn_shapes import lines_svg
from tests.hardware.controllers.ssc32 import Ssc32Model
from tests.test_cli_run import ROOT, RUN, _Terminal

pytestmark = pytest.mark.skipif(not Path("/dev/ptmx").exists(), reason="needs pseudo-terminals")


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A large circle drawn in one stroke of several seconds."""
    folder = tmp_path_factory.mktemp("planned")
    drawing, target = folder / "drawing.svg", folder / "traj.csv"
    drawing.write_text(lines_svg('<circle cx="80" cy="30" r="29"/>', 'viewBox="0 0 160 60"'))
    assert main([str(drawing), "-o", str(target), "--quiet"]) == 0
    return target


@pytest.fixture
def csv(planned: Path, tmp_path: Path) -> Path:
    copy = tmp_path / "traj.csv"
    copy.write_bytes(planned.read_bytes())
    return copy


@pytest.mark.filterwarnings("ignore:.*forkpty.*:DeprecationWarning")
def test_a_terminal_that_is_closed_stops_and_parks(csv: Path) -> None:
    terminal = _Terminal(str(csv))
    terminal.wait_for("stroke")
    assert terminal.hang_up() == 130
    entry = read_journal(journal_path(csv, simulated=True))
    assert entry is not None
    assert entry.ended == "stopped"


@pytest.mark.parametrize(
    "numbers", [[signal.SIGTERM], [signal.SIGHUP], [signal.SIGHUP] * 3, [signal.SIGTERM, signal.SIGHUP]]
)
def test_signals_stop_and_a_closed_terminal_never_stops_in_the_midst(numbers: list[signal.Signals], csv: Path) -> None:
    """A shell and the system may both tell of it."""
    process = _started(csv)
    for number in numbers:
        process.send_signal(number)
        time.sleep(0.05)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "the arm is parked" in out
    assert "--resume goes on from stroke 0 of 0..0" in err
    entry = read_journal(journal_path(csv, simulated=True))
    assert entry is not None
    assert entry.ended == "stopped"


def test_what_nohup_asks_for_is_kept(csv: Path) -> None:
    process = _started(csv, before=["nohup"])
    process.send_signal(signal.SIGHUP)
    time.sleep(0.3)
    assert process.poll() is None
    process.terminate()
    process.communicate(timeout=60)
    assert process.returncode == 130


def _started(csv: Path, before: list[str] | None = None) -> subprocess.Popen[str]:
    process = subprocess.Popen(
        [*(before or []), *RUN, str(csv)],
        cwd=ROOT,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    until = time.monotonic() + 60
    while not journal_path(csv, simulated=True).exists() and time.monotonic() < until:
        time.sleep(0.02)
    return process


@pytest.fixture
def full_line() -> Iterator[tuple[str, socket.socket]]:
    """The URL of a controller and its socket."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        yield f"socket://127.0.0.1:{server.getsockname()[1]}", server


def test_a_request_to_terminate_is_heard_while_a_line_takes_nothing(
    csv: Path, full_line: tuple[str, socket.socket]
) -> None:
    url, server = full_line
    process = subprocess.Popen(
        [*RUN, str(csv), "--driver", "ssc32", "--port", url],
        cwd=ROOT,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    server.settimeout(60)
    far, _ = server.accept()
    model = Ssc32Model()
    with far:
        while not journal_path(csv, simulated=False).exists():
            far.sendall(model.receive(far.recv(4096)))
        # From now on nothing is read and nothing answered.
        process.terminate()
        asked_s = time.monotonic()
        _, err = process.communicate(timeout=60)
    assert time.monotonic() - asked_s < 20
    assert process.returncode == 4
    assert "plan: error: " + url in err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_run_that_still_asks_how_far_an_earlier_one_came_ends_at_once(csv: Path, number: signal.Signals) -> None:
    """Nothing moves yet; the journal stays as it was, and port and trajectory are free again."""
    journal = journal_path(csv, simulated=False)
    kept = (
        json.dumps({"journal": 2, "sha256": digest(csv), "arm": "drawing_arm", "driver": "native", "next_stroke": 0})
        + "\n"
    )
    journal.write_text(kept)
    with socket.create_server(("127.0.0.1", 0)) as server:
        url = f"socket://127.0.0.1:{server.getsockname()[1]}"
        process = subprocess.Popen(
            [*RUN, str(csv), "--driver", "native", "--port", url, "--resume"],
            cwd=ROOT,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        server.settimeout(60)
        far, _ = server.accept()
        with far:
            assert far.recv(64)  # the question, which nobody answers
            process.send_signal(number)
            out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (130, "", "plan: interrupted\n")
    assert journal.read_text() == kept
    assert sorted(path.name for path in csv.parent.iterdir()) == ["traj.csv", "traj.csv.journal"]
