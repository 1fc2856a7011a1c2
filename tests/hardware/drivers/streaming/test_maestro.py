"""The Maestro's driver against a model that takes no wrong byte."""

from __future__ import annotations

import numpy as np
import pytest

from hardware.compensation.servo_values import pulse_calibration
from hardware.drivers.driver import Driver
from hardware.drivers.table import make_driver
from hardware.motion.tip import link_nodes_mm
from planner.arms.arm_file import load_arm
from planner.errors import HardwareError
from tests.hardware.controllers.bench import Bench
from tests.hardware.controllers.maestro import MaestroModel

ARM = load_arm("drawing_arm_2022")
POSE = ARM.from_file_units([0.0, 45.0, -45.0, -45.0, -45.0])
POSE_QUARTERS = [6000, 4 * 792, 4 * 610, 3042, 4 * 1502]
"""Of the tables, half-way between rows."""


def _driver(far: Bench, name: str = "maestro") -> Driver:
    return make_driver(name, ARM, far, far)


def _stream(driver: Driver) -> None:
    """Ten seconds at rest."""
    for _ in range(500):
        driver.send(POSE, 0.02)
        driver.flush()


@pytest.mark.parametrize("name", ["maestro", "maestro-crc"])
def test_servos_are_attached_one_by_one_then_follow_byte_for_byte(name: str) -> None:
    model = MaestroModel(crc=name == "maestro-crc")
    far = Bench(model)
    driver = _driver(far, name)
    driver.connect(POSE)
    assert model.targets == list(enumerate(POSE_QUARTERS))
    before = len(far.received)
    moved = POSE.copy()
    moved[0] = np.radians(12.3456)
    driver.send(moved, 0.02)
    driver.flush()
    driver.close()
    driver.close()
    assert model.targets[5:] == [(0, 6494), *list(enumerate(POSE_QUARTERS))[1:]]
    assert far.received[before : before + 4] == bytes.fromhex("84 00 5E 32")
    assert driver.executed() == 1
    assert "1 set point " in driver.statistics()[0]


def test_servos_that_the_board_holds_elsewhere_glide_to_the_pose() -> None:
    low = POSE_QUARTERS[1] - 800
    model = MaestroModel(positions={0: 4 * 1800, 1: low})
    far = Bench(model)
    driver = _driver(far)
    driver.connect(POSE)
    driver.close()
    first = [value for channel, value in model.targets if channel == 0]
    assert first[-1] == POSE_QUARTERS[0]
    # A fifth of 400 deg/s is 80 deg/s, of 10 us a degree: 16 us in 20 ms.
    assert np.abs(np.diff([4 * 1800, *first])).max() <= 4 * 16 + 1


def test_a_pen_left_on_the_paper_goes_straight_up_first() -> None:
    arm = load_arm("drawing_arm")
    calibration = pulse_calibration(arm)
    down, away = arm.from_file_units([[-40.0, 60.0, -60.0, -60.0, -30.0], [30.0, 75.0, -60.0, -60.0, -45.0]])
    standing = dict(enumerate(np.rint(4 * calibration.to_servos(down)).astype(int).tolist()))
    model = MaestroModel(positions=standing)
    far = Bench(model)
    driver = make_driver("maestro", arm, far, far)
    driver.connect(away)
    driver.close()
    told = np.array([value / 4 for _, value in model.targets]).reshape(-1, arm.n_joints)
    tip_mm = link_nodes_mm(arm, calibration.to_joints(told))[:, -1]
    low = tip_mm[:, 2] < 0.9 * arm.pen.clearance_mm
    assert low[0] and not low[-1]
    assert np.abs(tip_mm[low, :2] - tip_mm[0, :2]).max() < 0.1


def test_errors_are_asked_for_in_passing_and_told() -> None:
    model = MaestroModel()
    far = Bench(model)
    driver = _driver(far)
    driver.connect(POSE)
    model.errors = 0b1_0000
    with pytest.raises(HardwareError, match="the Maestro reports a command that it does not know"):
        _stream(driver)
    driver.close()


def test_a_board_that_no_longer_answers_is_missed() -> None:
    model = MaestroModel()
    far = Bench(model)
    driver = _driver(far)
    driver.connect(POSE)
    model.deaf = True
    with pytest.raises(HardwareError, match="bench: the controller no longer answers"):
        _stream(driver)
    driver.close()


def test_a_board_that_never_answers_is_told_how_to_be_set() -> None:
    model = MaestroModel()
    model.deaf = True
    far = Bench(model)
    driver = _driver(far)
    with pytest.raises(HardwareError, match="no Maestro answers"):
        driver.connect(POSE)
    driver.close()


def test_a_channel_that_the_board_keeps_back_is_told() -> None:
    far = Bench(MaestroModel(most=4 * 1400))
    driver = _driver(far)
    with pytest.raises(HardwareError, match="channel 0 of the Maestro stays at 1400 us instead of 1500 us"):
        driver.connect(POSE)
    driver.close()


def test_emergency_stop_holds_where_the_board_is() -> None:
    model = MaestroModel()
    far = Bench(model)
    driver = _driver(far)
    driver.emergency_stop()  # nothing moves yet
    driver.connect(POSE)
    model.positions = {channel: value + 100 for channel, value in model.positions.items()}
    sent = len(model.targets)
    driver.emergency_stop()
    driver.close()
    driver.emergency_stop()
    assert model.targets[sent:] == [(channel, value + 100) for channel, value in enumerate(POSE_QUARTERS)]


def test_nothing_outside_its_range_leaves_the_host() -> None:
    model = MaestroModel()
    far = Bench(model)
    driver = _driver(far)
    beyond = POSE.copy()
    beyond[1] = np.radians(80.9)
    with pytest.raises(HardwareError, match=r"joint q2 at 80.9 deg .* outside its range of 448 to 1157 us"):
        driver.connect(beyond)
    driver.connect(POSE)
    before = len(model.targets)
    with pytest.raises(HardwareError, match="joint q2"):
        driver.send(beyond, 0.02)
    driver.close()
    assert len(model.targets) == before


def test_a_line_too_slow_for_the_set_points_is_told_at_the_first() -> None:
    far = Bench(MaestroModel(), baud=9600)
    driver = make_driver("maestro", ARM, far, far)
    driver.connect(POSE)
    with pytest.raises(
        HardwareError, match=r"a set point takes 20.8 ms on the line, but the next one follows after 20 ms"
    ):
        driver.send(POSE, 0.02)
    driver.close()
