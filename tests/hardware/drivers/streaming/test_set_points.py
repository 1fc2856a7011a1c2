"""What reaches the servos over a line, turned back into joint positions, for every controller that streams."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest

from hardware.clock import InstantClock
from hardware.compensation.servo_values import Calibration, count_calibration, pulse_calibration
from hardware.drivers.table import make_driver
from hardware.port import Line
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.errors import HardwareError
from tests.hardware.controllers.bench import Bench
from tests.hardware.controllers.bus import DynamixelModel, FeetechModel
from tests.hardware.controllers.lines import Model, pty_line
from tests.hardware.controllers.maestro import MaestroModel
from tests.hardware.controllers.ssc32 import Ssc32Model

MIDDLE = {1: 2048, 2: 2048, 3: 2048, 4: 2048, 5: 2048}
MAKERS: dict[str, Callable[[], Model]] = {
    "maestro": MaestroModel,
    "maestro-crc": lambda: MaestroModel(crc=True),
    "ssc32": Ssc32Model,
    "feetech": lambda: FeetechModel(MIDDLE),
    "dynamixel": lambda: DynamixelModel(MIDDLE),
}
STEPS = {"maestro": 0.25, "maestro-crc": 0.25, "ssc32": 1.0, "feetech": 1.0, "dynamixel": 1.0}


def told(model: Model, n: int) -> FloatArray:
    """The last `n` set points, in what the servos are told."""
    match model:
        case MaestroModel():
            return np.array([value / 4 for _, value in model.targets[-5 * n :]]).reshape(n, 5)
        case Ssc32Model():
            return np.array([list(targets.values()) for targets, _ in model.moves[-n:]], dtype=float)
        case FeetechModel() | DynamixelModel():
            return np.array([list(goals.values()) for goals in model.goals[-n:]], dtype=float)
    raise AssertionError


def heard(model: Model) -> int:
    """How many whole set points a model of five joints has carried out, those of attaching among them."""
    match model:
        case MaestroModel():
            return len(model.targets) // 5
        case Ssc32Model():
            return len(model.moves)
        case FeetechModel() | DynamixelModel():
            return len(model.goals)
    raise AssertionError


@pytest.mark.parametrize("name", MAKERS)
def test_set_points_arrive_in_order_and_right_to_half_a_step(name: str) -> None:
    on_bus = name in ("feetech", "dynamixel")
    arm = load_arm("so101" if on_bus else "drawing_arm")
    calibration: Calibration = count_calibration(arm) if on_bus else pulse_calibration(arm)
    positions = np.random.default_rng(5).uniform(arm.minimum, arm.maximum, (200, arm.n_joints))
    model = MAKERS[name]()
    far = Bench(model)
    driver = make_driver(name, arm, far, far)
    driver.connect(positions[0])
    for sample in positions:
        driver.send(sample, 0.02)
    driver.flush()
    driver.close()
    assert np.abs(told(model, len(positions)) - calibration.to_servos(positions)).max() <= STEPS[name] / 2 + 1e-9
    numbers = [int(number) for number in re.findall(r"\d+", driver.statistics()[0])]
    assert numbers[0] == driver.executed() == 200
    assert numbers[2] <= numbers[3]


@pytest.mark.parametrize("name", MAKERS)
def test_a_pulled_cable_ends_in_one_sentence_and_a_new_one_goes_on(name: str) -> None:
    arm = load_arm("so101" if name in ("feetech", "dynamixel") else "drawing_arm")
    pose = (arm.minimum + arm.maximum) / 2
    with pty_line(MAKERS[name]()) as far:
        driver = make_driver(name, arm, Line(far.name), InstantClock())
        with pytest.raises(HardwareError, match="is not open"):
            driver.send(pose, 0.02)
        driver.connect(pose)
        far.unplug()
        with pytest.raises(HardwareError, match=f"^{far.name}: the line failed .* check the cable") as caught:
            driver.send(pose, 0.02)
        assert caught.value.exit_code == 4
        driver.close()
    with pty_line(MAKERS[name]()) as far:
        driver = make_driver(name, arm, Line(far.name), InstantClock())
        driver.connect(pose)
        driver.send(pose, 0.02)
        driver.close()
