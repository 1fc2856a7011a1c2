"""`plan jog` on the firmware, in real time: what the pins do, and what the arm file then says."""

from __future__ import annotations

import os
import pty as terminals
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from hardware.compensation.servo_values import pulse_calibration
from planner.arms.arm_file import arm_file_text, load_arm
from planner.cli import main
from tests.hardware.emulator.emulator import Emulator
from tests.hardware.real_time import in_real_time


@in_real_time("the host may come too late to the line")
def test_what_is_found_by_a_script_is_what_the_pins_did(pty: tuple[Emulator, Path], tmp_path: Path) -> None:
    emulator, device = pty
    mine, moves = tmp_path / "mine.toml", tmp_path / "moves.txt"
    mine.write_text(f"# mine\n{arm_file_text('drawing_arm')}")
    moves.write_text(
        "joint q2\nto 100\nreverse\nzero 80\nmove 5\njoint q1\nmove 4\nzero\npen up\npen down\ncard\nsave\n"
    )
    jog = ["jog", "--arm", str(mine), "--driver", "native", "--port", str(device), "--script", str(moves)]
    assert main(jog) == 2  # it would leap
    assert not emulator.pins.stat().st_size or not len(emulator.pulses(0).widths_us)
    assert main([*jog, "--from-middle"]) == 0
    before, found = load_arm("drawing_arm"), load_arm(str(mine))
    sent = [float(emulator.pulses(joint.servo.channel).widths_us[-1]) for joint in before.joints if joint.servo]
    middle = (before.minimum + before.maximum) / 2
    middle[:2] += np.radians([4, 10 - 5])
    np.testing.assert_allclose(sent, pulse_calibration(before).to_servos(middle), atol=0.2)
    stands = pulse_calibration(found).to_joints(np.array(sent))
    assert stands[0] == pytest.approx(0.0, abs=1e-3)
    assert stands[1] == pytest.approx(np.radians(85), abs=1e-3)
    assert found.joints[1].servo is not None and found.joints[1].servo.direction == -1
    assert "# mine" in mine.read_text() and "table" not in mine.read_text()
    assert found.paper != before.paper


@in_real_time("the host may come too late to the line")
@pytest.mark.filterwarnings("ignore:.*forkpty.*:DeprecationWarning")
def test_a_key_stops_it_at_once(pty: tuple[Emulator, Path]) -> None:
    emulator, device = pty
    command = ["jog", "--arm", "drawing_arm", "--driver", "native", "--port", str(device)]
    pid, keys = terminals.fork()
    if pid == 0:
        os.execv(sys.executable, [sys.executable, "-m", "planner.cli", *command])
    _until(keys, b"press y")
    os.write(keys, b"y")
    _until(keys, b"over the paper")
    os.write(keys, b":to 80\r")  # more than a second of way
    time.sleep(0.7)
    os.write(keys, b"x")
    _until(keys, b"stopped: the arm holds where it is")
    assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 130
    os.close(keys)
    time.sleep(0.3)
    widths_us = emulator.pulses(0).widths_us
    assert 1500 < widths_us[-1] < 2290
    np.testing.assert_array_equal(widths_us[-5:], widths_us[-1])


def _until(terminal: int, words: bytes) -> None:
    shown = b""
    while words not in shown:
        shown += os.read(terminal, 4096)
