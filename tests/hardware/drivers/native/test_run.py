"""`plan run` on the firmware: what the pins drew is the drawing, whatever came between."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from benchmarks.soak.coverage import coverage
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.checking.drawing_error import drawing_error
from planner.cli import main
from planner.drawing.flatten import flatten_all
from planner.drawing.svg import read_drawing
from planner.trajectory import read_trajectory
from tests.drawn_shapes import lines_svg
from tests.hardware.drivers.native.paper import ink
from tests.hardware.emulator.emulator import Emulator
from tests.hardware.real_time import in_real_time

_ARM = load_arm("drawing_arm")
_STROKES = 5
_DRAWING = lines_svg(
    """<path d="M2 20 C 10 0 20 30 30 12"/><path d="M42 6h0"/><circle cx="42" cy="20" r="8"/>
<path d="M58 28 L70 4 L82 28"/><path d="M64 20h12"/>""",
    'viewBox="0 0 90 30"',
)
_WORST_MM = 0.18
"""A pulse is right to half a step of 0.5 us: 0.025 degrees of each of the joints, which can add up to this."""
_MEETING_MM = 5.0
"""Of lines that meet and cross, and of where an interrupted one is gone on with."""
_PLAYS_ON_S = 0.8
"""The controller has motion for less than this."""


pytestmark = in_real_time(
    "host and emulated controller share the cores, and either may be kept from them for "
    "longer than an answer is waited for"
)


@pytest.fixture(scope="session")
def planned(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A drawing and its trajectory."""
    folder = tmp_path_factory.mktemp("planned")
    drawing, csv = folder / "drawing.svg", folder / "traj.csv"
    drawing.write_text(_DRAWING)
    assert main([str(drawing), "-o", str(csv), "--quiet", "--margin", "35"]) == 0
    return drawing, csv


@pytest.fixture
def csv(planned: tuple[Path, Path], tmp_path: Path) -> Path:
    copy = tmp_path / "traj.csv"
    copy.write_bytes(planned[1].read_bytes())
    return copy


@pytest.fixture
def wanted(planned: tuple[Path, Path]) -> list[FloatArray]:
    a, b, c, d, e, f = read_trajectory(planned[1]).svg_to_arm_mm
    return flatten_all(read_drawing(planned[0]).outlines, np.array([[a, c, e], [b, d, f]]), 0.005)


def _entries(csv: Path) -> dict[str, object]:
    told: dict[str, object] = {}
    for line in csv.with_name("traj.csv.journal").read_bytes().splitlines():
        told |= json.loads(line)
    return told


def _next_stroke(csv: Path) -> int:
    try:
        return int(str(_entries(csv)["next_stroke"]))
    except (FileNotFoundError, KeyError, ValueError):
        return -1


def _started(csv: Path, device: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "planner.cli", "run", csv, "--driver", "native", "--port", device],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def _wait_for(happened: Callable[[], bool]) -> None:
    until = time.monotonic() + 40
    while not happened():
        assert time.monotonic() < until
        time.sleep(0.01)


def _resume(csv: Path, device: Path) -> None:
    assert main(["run", str(csv), "--driver", "native", "--port", str(device), "--resume", "--quiet"]) == 0
    assert _entries(csv) | {"next_stroke": _STROKES, "ended": "complete"} == _entries(csv)


def test_what_the_pins_drew_is_the_drawing(
    csv: Path, wanted: list[FloatArray], pty: tuple[Emulator, Path], capsys: pytest.CaptureFixture[str]
) -> None:
    emulator, device = pty
    assert main(["run", str(csv), "--driver", "native", "--port", str(device)]) == 0
    said = capsys.readouterr().out
    assert "the arm is parked" in said
    drawn = ink(emulator, _ARM)
    assert len(drawn) == _STROKES
    assert drawing_error(drawn, wanted).most_mm < 0.13  # a tolerance, and half steps of all joints
    assert drawing_error(drawn, wanted).largest_mm < _WORST_MM
    assert _entries(csv) | {"next_stroke": _STROKES, "ended": "complete"} == _entries(csv)


@pytest.mark.parametrize("fault", ["killed", "unplugged", "reset", "interrupted"])
def test_whatever_breaks_a_run_off_resume_finishes_the_drawing(
    fault: str, csv: Path, wanted: list[FloatArray], pty: tuple[Emulator, Path]
) -> None:
    """No line is where none was wanted, and none twice: where two meet is all that there may be again."""
    emulator, device = pty
    process = _started(csv, device)
    _wait_for(lambda: _next_stroke(csv) >= 2 or process.poll() is not None)
    time.sleep(0.2)  # in the midst of a stroke
    match fault:
        case "killed":
            process.kill()
        case "unplugged":
            emulator.move_cable()
        case "reset":
            emulator.reset()
        case "interrupted":
            process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=40)
    code, message = {
        "killed": (-signal.SIGKILL, ""),
        "unplugged": (4, f"plan: error: {device}: the line failed"),
        "reset": (4, "plan: error: .*the controller was reset in the middle of the run"),
        "interrupted": (130, "--resume goes on"),
    }[fault]
    assert process.returncode == code
    assert re.search(message, told), told
    assert "Traceback" not in told
    resumed = _next_stroke(csv)
    assert 2 <= resumed < _STROKES
    time.sleep(_PLAYS_ON_S)
    if fault == "unplugged":
        emulator.move_cable()
        _wait_for(device.exists)
    _resume(csv, device)
    drawn = ink(emulator, _ARM)
    assert len(drawn) <= _STROKES + 1
    assert sum(coverage(drawn, wanted).again_mm) < _MEETING_MM
    assert drawing_error(drawn, wanted).largest_mm < _WORST_MM
