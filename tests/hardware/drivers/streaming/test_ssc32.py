"""The SSC-32's driver over a pseudo-terminal and over TCP, against a model that takes no wrong byte."""

from __future__ import annotations

import pytest

from hardware.clock import InstantClock
from hardware.drivers.driver import Driver
from hardware.drivers.table import make_driver
from hardware.port import Line
from planner.arms.arm_file import load_arm
from planner.errors import HardwareError
from tests.hardware.controllers.bench import Bench
from tests.hardware.controllers.lines import pty_line, tcp_line
from tests.hardware.controllers.ssc32 import Ssc32Model

ARM = load_arm("drawing_arm")
POSE = ARM.from_file_units([0.0, 60.0, -60.0, -60.0, -30.0])
PULSES_US = {0: 1500, 1: 1200, 2: 1500, 3: 1500, 4: 1500}


def _stream(driver: Driver) -> None:
    """Ten seconds at rest."""
    for _ in range(500):
        driver.send(POSE, 0.02)
        driver.flush()


@pytest.mark.parametrize("line", [pty_line, tcp_line])
def test_servos_are_attached_one_by_one_then_move_together_in_the_time_of_a_sample(line) -> None:
    model = Ssc32Model(still_moving=3)
    with line(model) as far:
        driver = make_driver("ssc32", ARM, Line(far.name), InstantClock())
        driver.connect(POSE)
        first = len(far.received)
        moved = POSE.copy()
        moved[0] = 0.1
        driver.send(moved, 0.01)
        driver.flush()
        driver.close()
        far.finish()
    assert model.moves == [
        *(({channel: pulse_us}, 2000) for channel, pulse_us in PULSES_US.items()),
        ({**PULSES_US, 0: 1557}, 10),
    ]
    assert far.received[first:].startswith(b"#0P1557#1P1200#2P1500#3P1500#4P1500T10\r")


def test_emergency_stop_stops_every_servo() -> None:
    model = Ssc32Model()
    far = Bench(model)
    driver = make_driver("ssc32", ARM, far, far)
    driver.emergency_stop()
    driver.connect(POSE)
    driver.emergency_stop()
    driver.close()
    assert model.stopped == list(PULSES_US)


def test_a_board_that_does_not_answer_or_does_not_arrive_is_told() -> None:
    model = Ssc32Model(still_moving=1000)
    far = Bench(model)
    driver = make_driver("ssc32", ARM, far, far)
    with pytest.raises(HardwareError, match="does not finish its first move"):
        driver.connect(POSE)
    model.deaf = True
    driver.close()
    with pytest.raises(HardwareError, match="bench: no SSC-32 answers"):
        driver.connect(POSE)
    driver.close()


def test_a_board_that_goes_is_missed() -> None:
    model = Ssc32Model()
    far = Bench(model)
    driver = make_driver("ssc32", ARM, far, far)
    driver.connect(POSE)
    for _ in range(60):
        driver.send(POSE, 0.02)
        driver.flush()
    model.deaf = True
    with pytest.raises(HardwareError, match="no longer answers"):
        _stream(driver)
    driver.close()
