"""`plan run` from the outside: what it refuses, what it says, and what is left when it is interrupted."""

from __future__ import annotations

import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import termios
import time
from pathlib import Path

import numpy as np
import pytest

from hardware.playback.journal import digest, journal_path
from planner.checking.drawing_error import drawing_error
from planner.cli import main
from planner.drawing.flatten import flatten_all
from planner.drawing.svg import read_drawing
from planner.trajectory import read_trajectory
from tests.drawn_shapes import lines_svg
from tests.hardware.controllers.lines import pty_line
from tests.hardware.controllers.maestro import MaestroModel
from tests.hardware.controllers.ssc32 import Ssc32Model

ROOT = Path(__file__).resolve().parent.parent
RUN = [sys.executable, "-m", "planner.cli", "run"]


def _planned(folder: Path, shapes: str) -> Path:
    drawing, target = folder / "drawing.svg", folder / "traj.csv"
    drawing.write_text(lines_svg(f"{shapes}", 'viewBox="0 0 160 60"'))
    assert main([str(drawing), "-o", str(target), "--quiet"]) == 0
    drawing.unlink()
    return target


@pytest.fixture
def taps_csv(tmp_path: Path) -> Path:
    """Ten taps in a row, some five seconds of them."""
    return _planned(tmp_path, "".join(f'<path d="M{x} {x % 3}h0"/>' for x in range(0, 160, 16)))


@pytest.fixture
def ring_csv(tmp_path: Path) -> Path:
    """A large circle drawn in one stroke of several seconds."""
    return _planned(tmp_path, '<circle cx="80" cy="30" r="29"/>')


def _error(capsys: pytest.CaptureFixture[str]) -> str:
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("plan: error: ")
    assert err.count("\n") == 1
    return err


def test_what_ideal_servos_draw_is_the_drawing_and_real_ones_draw_worse(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    csv, svg, png = tmp_path / "garden.csv", tmp_path / "drawn.svg", tmp_path / "drawn.png"
    example = ROOT / "examples/garden.svg"
    assert main([str(example), "-o", str(csv), "--place", "ink", "--quiet"]) == 0
    assert main(["run", str(csv), "--fast", "--picture", str(svg), "--picture", str(png)]) == 0
    said = re.search(r"([0-9.]+) mm at the largest", capsys.readouterr().out)
    assert said is not None
    assert float(said[1]) < 0.1
    assert png.read_bytes().startswith(b"\x89PNG")
    # Beside the drawing itself, not only beside the trajectory.
    a, b, c, d, e, f = read_trajectory(csv).svg_to_arm_mm
    wanted = flatten_all(read_drawing(example).outlines, np.array([[a, c, e], [b, d, f]]), 0.005)
    drawn = flatten_all(read_drawing(svg).outlines, np.eye(2, 3), 0.005)
    assert drawing_error([-line[:, ::-1] for line in drawn], wanted).largest_mm < 0.1
    assert main(["run", str(csv), "--fast", "--servos", "real", "--seed", "1", "--picture", str(svg)]) == 0
    said = re.search(r"off by ([0-9.]+) mm rms", capsys.readouterr().out)
    assert said is not None
    assert float(said[1]) > 0.1


def test_a_dry_run_says_what_would_be_sent_and_sends_nothing(
    taps_csv: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(taps_csv), "--driver", "maestro", "--dry-run"]) == 0
    text = capsys.readouterr().out
    assert "can be played on arm 'drawing_arm' by driver maestro" in text
    positions_deg = read_trajectory(taps_csv).positions[:, 0]
    servo = re.search(r"joint q1, servo 0: ([0-9.]+) to ([0-9.]+) us", text)
    assert servo is not None
    pulses = np.sort(1500 + 10 * np.array([positions_deg.min(), positions_deg.max()]))
    assert [float(value) for value in servo.groups()] == pytest.approx(pulses.tolist(), abs=0.051)
    assert list(taps_csv.parent.iterdir()) == [taps_csv]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--driver", "maestro"], "--driver maestro needs --port; plan ports lists what is plugged in"),
        (["--driver", "marionette"], "there is no driver 'marionette'; there are sim, mujoco, native, "),
        (["--port", "/dev/ttyUSB0"], "a simulated arm has no port"),
        (["--driver", "ssc32", "--port", "loop://", "--fast"], "--fast goes with --driver sim or mujoco"),
        (
            ["--driver", "ssc32", "--port", "loop://", "--picture", "d.png"],
            "--picture goes with --driver sim or mujoco",
        ),
        (["--driver", "ssc32", "--port", "loop://", "--baud", "0"], "'0' is not a baud rate"),
        (["--driver", "ssc32", "--port", "loop://", "--baud", "fast"], "'fast' is not a baud rate"),
        (["--resume", "--from-stroke", "2"], "leave out --from-stroke"),
        (["--resume"], "there is nothing to resume: no journal"),
        (["--from-stroke", "10"], "there is no stroke 10; the drawing has 0 to 9"),
        (["--picture", "drawn.bmp"], "a picture file ends in one of"),
        (["--picture", "d" * 300 + ".png"], "File name too long"),
        (["--arm", "scara"], "moves the joints q1_deg, q2_deg"),
        (["--arm", "drawing_arm_2022"], "line "),
    ],
)
def test_what_makes_no_sense_is_refused_before_anything_moves(
    options: list[str], message: str, taps_csv: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", str(taps_csv), *options]) == 2
    assert message in _error(capsys)
    assert list(taps_csv.parent.iterdir()) == [taps_csv]


def test_a_file_that_was_cut_off_is_refused(taps_csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = read_trajectory(taps_csv).positions[:, 0]
    fastest = int(np.abs(np.diff(rows)).argmax())
    lines = taps_csv.read_text().splitlines()
    lines = lines[: len(lines) - len(rows) + fastest + 1]  # amid a motion
    last = len(lines)
    taps_csv.write_text("\n".join(lines) + "\n")
    assert main(["run", str(taps_csv)]) == 2
    assert f"line {last}: the last sample is at" in _error(capsys)
    last_s = lines[-1].split(",")[0]
    taps_csv.write_text(re.sub(r"(?<=duration_s: ).*", last_s, "\n".join(lines)) + "\n")
    assert main(["run", str(taps_csv)]) == 2
    message = _error(capsys)
    assert re.search(rf"line ({last - 1}|{last}): ", message) and "is the file cut off?" in message


def test_from_a_stroke_on_and_then_nothing_is_left(
    taps_csv: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    svg = tmp_path / "drawn.svg"
    assert main(["run", str(taps_csv), "--fast", "--from-stroke", "7", "--picture", str(svg)]) == 0
    assert "0.000 mm at the largest" in capsys.readouterr().out  # beside strokes 7 to 9
    assert svg.read_text().count("<polyline") == 3
    assert main(["run", str(taps_csv), "--resume"]) == 0
    assert "is drawn to its end" in capsys.readouterr().out


def _entries(journal: Path) -> dict[str, object]:
    told: dict[str, object] = {}
    for line in journal.read_bytes().splitlines():
        told |= json.loads(line)
    return told


@pytest.mark.skipif(os.name != "posix", reason="kills a process")
def test_killed_outright_it_resumes_and_draws_nothing_twice_beyond_one_stroke(
    taps_csv: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    journal = taps_csv.with_name("traj.csv.sim.journal")
    process = subprocess.Popen([*RUN, str(taps_csv)], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    until = time.monotonic() + 20
    while not (journal.exists() and b'"next_stroke": 3' in journal.read_bytes()) and time.monotonic() < until:
        time.sleep(0.02)
    process.kill()
    out, err = process.communicate(timeout=20)
    assert (out, err) == (b"", b"")
    resumed = _entries(journal)["next_stroke"]
    assert resumed in (3, 4)
    assert "ended" not in _entries(journal)
    svg = tmp_path / "rest.svg"
    assert main(["run", str(taps_csv), "--fast", "--resume", "--picture", str(svg)]) == 0
    assert f"going on from stroke {resumed}" in capsys.readouterr().err
    assert svg.read_text().count("<polyline") == 10 - int(str(resumed))
    assert _entries(journal)["ended"] == "complete"
    taps_csv.write_text(taps_csv.read_text() + "\n")
    assert main(["run", str(taps_csv), "--fast", "--resume"]) == 2


def test_a_file_changed_since_is_not_resumed(taps_csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["run", str(taps_csv), "--fast"]) == 0
    capsys.readouterr()
    taps_csv.write_text(taps_csv.read_text().replace("# drawing: drawing.svg", "# drawing: other.svg"))
    assert main(["run", str(taps_csv), "--fast", "--resume"]) == 2
    assert "has changed since" in _error(capsys)


def test_where_no_journal_can_be_kept_it_draws_all_the_same_and_says_so(
    taps_csv: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    taps_csv.with_name("traj.csv.sim.journal").mkdir()
    assert main(["run", str(taps_csv), "--fast"]) == 0
    assert "--resume will not be able to go on: cannot write" in capsys.readouterr().err


@pytest.mark.skipif(not Path("/dev/ptmx").exists(), reason="needs pseudo-terminals")
def test_a_cable_pulled_mid_run_is_exit_4_and_resume_finishes_on_another_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    few_taps = _planned(tmp_path, "".join(f'<path d="M{x} {x % 3}h0"/>' for x in range(0, 96, 16)))
    journal = few_taps.with_name("traj.csv.journal")
    with pty_line(MaestroModel()) as far:
        command = [*RUN, str(few_taps), "--driver", "maestro", "--port", far.name]
        process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 30
        while not (journal.exists() and b'"next_stroke": 2' in journal.read_bytes()) and time.monotonic() < until:
            time.sleep(0.02)
        far.unplug()
        _, err = process.communicate(timeout=30)
    assert process.returncode == 4
    assert "plan: error: " + far.name in err
    resumed = int(str(_entries(journal)["next_stroke"]))
    assert resumed >= 2
    assert f"--resume goes on from stroke {resumed} of 0..5" in err
    with pty_line(MaestroModel()) as far:
        assert main(["run", str(few_taps), "--driver", "maestro", "--port", far.name, "--resume"]) == 0
    assert f"going on from stroke {resumed}" in capsys.readouterr().err


class _Terminal:
    """`plan run` in a terminal of its own, in front."""

    def __init__(self, *arguments: str) -> None:
        self.pid, self._master = pty.fork()
        if self.pid == 0:
            os.chdir(ROOT)
            os.execv(sys.executable, [*RUN, *arguments])
        self.seen = ""

    def wait_for(self, text: str) -> None:
        until = time.monotonic() + 20
        while text not in self.seen:
            assert time.monotonic() < until, self.seen
            if select.select([self._master], [], [], 0.1)[0]:
                self.seen += os.read(self._master, 4096).decode()

    def press(self, keys: bytes) -> None:
        os.write(self._master, keys)

    @property
    def shows_keys(self) -> bool:
        return bool(termios.tcgetattr(self._master)[3] & termios.ECHO)

    def hang_up(self) -> int:
        """Close the terminal; the exit code."""
        os.close(self._master)
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])

    def end(self) -> int:
        """Its exit code, once everything it said has been seen."""
        while True:
            try:
                said = os.read(self._master, 4096)
            except OSError:  # Linux says that the other side is closed
                break
            if not said:
                break
            self.seen += said.decode()
        code = os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])
        os.close(self._master)
        return code


@pytest.mark.skipif(not Path("/dev/ptmx").exists(), reason="needs pseudo-terminals")
@pytest.mark.filterwarnings("ignore:.*forkpty.*:DeprecationWarning")
def test_keys_pause_resume_and_stop(ring_csv: Path) -> None:
    terminal = _Terminal(str(ring_csv))
    terminal.wait_for("space or p pauses")
    terminal.wait_for("stroke")
    assert not terminal.shows_keys
    terminal.press(b" ")
    terminal.wait_for("paused")
    terminal.press(b"\x1b[A")  # an arrow key is no Esc
    terminal.seen = ""
    terminal.press(b"p")
    terminal.wait_for("stroke")
    assert terminal.seen.count(" s left") > 0
    assert "-:--:--" not in terminal.seen and "0:00:" not in terminal.seen  # one clock, which a pause does not mislead
    terminal.press(b"q")
    terminal.wait_for("stopped after")
    assert terminal.end() == 130
    assert "the arm is parked" in terminal.seen
    assert "--resume goes on" in terminal.seen


@pytest.mark.skipif(not Path("/dev/ptmx").exists(), reason="needs pseudo-terminals")
@pytest.mark.filterwarnings("ignore:.*forkpty.*:DeprecationWarning")
@pytest.mark.parametrize("key", [b"x", b"\x1b", b"\x03"])
def test_the_terminal_is_as_it_was_whatever_ends_it(ring_csv: Path, key: bytes) -> None:
    terminal = _Terminal(str(ring_csv))
    terminal.wait_for("stroke")
    assert not terminal.shows_keys
    terminal.press(key)
    terminal.wait_for("after")
    assert terminal.shows_keys
    assert terminal.end() == 130
    assert ("the arm holds where it is" in terminal.seen) == (key != b"\x03")


@pytest.mark.skipif(os.name != "posix", reason="needs devices")
def test_nothing_is_said_of_servos_before_the_port_is_open(taps_csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["run", str(taps_csv), "--driver", "ssc32", "--port"]
    assert main([*command, str(taps_csv.parent / "nothing")]) == 4
    _error(capsys)
    with pty_line(Ssc32Model()) as far:
        assert main([*command, far.name, "--from-stroke", "9"]) == 0
    assert "its servos are attached at the park pose" in capsys.readouterr().err


def test_where_all_is_drawn_nothing_is_left_to_resume(
    taps_csv: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Stopped on the way back to the park pose."""
    from planner.cli.run_journal import RunJournal

    def stop(journal: RunJournal, stroke: int) -> None:
        finished(journal, stroke)
        if stroke == 9:
            signal.raise_signal(signal.SIGTERM)

    finished = RunJournal.finished
    monkeypatch.setattr(RunJournal, "finished", stop)
    assert main(["run", str(taps_csv), "--fast"]) == 130
    assert "all strokes are drawn; there is nothing left for --resume" in capsys.readouterr().err
    assert main(["run", str(taps_csv), "--fast", "--resume"]) == 0
    assert "is drawn to its end" in capsys.readouterr().out


@pytest.mark.skipif(not Path("/dev/ptmx").exists(), reason="needs pseudo-terminals")
def test_where_all_is_drawn_a_real_arm_is_only_parked(taps_csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Its pen may still be on the paper."""
    journal = journal_path(taps_csv, simulated=False)
    journal.write_text(
        json.dumps(
            {"journal": 2, "sha256": digest(taps_csv), "arm": "drawing_arm", "driver": "ssc32", "next_stroke": 10}
        )
        + "\n"
    )
    model = Ssc32Model()
    with pty_line(model) as far:
        assert main(["run", str(taps_csv), "--driver", "ssc32", "--port", far.name, "--resume"]) == 0
    told = capsys.readouterr()
    assert "the earlier run ended after all strokes were drawn" in told.err
    assert "the arm is parked" in told.out
    whole = [targets for targets, _ in model.moves if len(targets) == 5]
    assert len(whole) == 1
    assert _entries(journal)["ended"] == "complete"
    assert main(["run", str(taps_csv), "--driver", "ssc32", "--port", "/dev/none", "--resume"]) == 0
    assert "is drawn to its end" in capsys.readouterr().out


@pytest.mark.parametrize(
    "arm", ["drawing_arm", "drawing_arm_2022", "scara", "six_joint", "so101", "stanford", "three_joint"]
)
def test_every_arm_can_be_rehearsed_with_real_servos(
    arm: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drawing, csv = tmp_path / "drawing.svg", tmp_path / "traj.csv"
    drawing.write_text(lines_svg('<path d="M5 5h9"/>', 'viewBox="0 0 40 20"'))
    assert main([str(drawing), "-o", str(csv), "--quiet", "--arm", arm]) == 0
    picture = ["--picture", str(tmp_path / "drawn.svg")]
    assert main(["run", str(csv), "--fast", "--servos", "real", *picture]) == 0
    described = arm in ("drawing_arm", "drawing_arm_2022", "so101")
    told = capsys.readouterr()
    assert ("does not describe the servos" in told.err) is not described
    off = re.search(r"off by ([0-9.]+) mm rms", told.out)
    assert (off and float(off[1]) > 0.5) or "the pen left no ink" in told.out
    assert main(["run", str(csv), "--fast", "--servos", "real", "--true-arm", arm, *picture]) == 0
    assert re.search(r"off by [0-9.]+ mm rms|the pen left no ink", capsys.readouterr().out)
    assert main(["run", str(csv), "--dry-run"]) == 0
    assert ("the arm file says nothing of them" in capsys.readouterr().out) is not described


def test_pulses_for_servos_of_another_arm_are_no_rehearsal(taps_csv: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bare = taps_csv.with_name("bare.toml")
    text = (ROOT / "configs" / "drawing_arm.toml").read_text(encoding="utf-8")
    bare.write_text("\n".join(line for line in text.splitlines() if not line.startswith("servo = ")))
    rehearsal = ["run", str(taps_csv), "--fast", "--servos", "real"]
    assert main([*rehearsal, "--arm", str(bare), "--true-arm", "drawing_arm"]) == 2
    assert "does not say how joint q1 is moved" in capsys.readouterr().err
    assert main([*rehearsal, "--arm", str(bare), "--true-arm", str(bare)]) == 0
    assert main([*rehearsal, "--true-arm", str(bare)]) == 2
    assert "does not say how joint q1 is moved" in capsys.readouterr().err


@pytest.mark.skipif(os.name != "posix", reason="needs signals")
def test_a_wrong_port_does_not_cost_the_earlier_runs_journal(
    taps_csv: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    journal = taps_csv.with_name(taps_csv.name + ".journal")
    journal.write_text("what an earlier run has drawn")
    assert main(["run", str(taps_csv), "--driver", "ssc32", "--port", str(taps_csv.parent / "nothing")]) == 4
    assert journal.read_text() == "what an earlier run has drawn"
    assert "--resume" not in capsys.readouterr().err


def test_a_rehearsal_leaves_the_arms_own_journal_alone(taps_csv: Path) -> None:
    journal = taps_csv.with_name("traj.csv.journal")
    journal.write_text("the arm's own")
    assert main(["run", str(taps_csv), "--fast", "--quiet"]) == 0
    assert journal.read_text() == "the arm's own"
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
