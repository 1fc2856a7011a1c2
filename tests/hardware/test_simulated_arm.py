from __future__ import annotations

import numpy as np
import pytest

from hardware.clock import InstantClock
from hardware.simulated_arm import SimulatedArm
from planner.arms.arm import Arm
from planner.errors import HardwareError

REST = np.radians([0.0, 60.0, -60.0, -60.0, -30.0])


def test_joints_follow_no_faster_than_they_can(arm: Arm) -> None:
    clock = InstantClock()
    simulated = SimulatedArm(arm, clock)
    simulated.connect(REST)
    goal = REST + np.radians([60.0, 1.0, 0.0, 0.0, 0.0])
    for k in range(31):
        clock.sleep_until(k * 0.01)
        simulated.send(goal)
    positions = simulated.recording.positions
    assert np.abs(np.diff(positions, axis=0)).max() <= arm.max_velocity[0] * 0.01 + 1e-12
    assert positions[5, 0] == pytest.approx(5 * arm.max_velocity[0] * 0.01)
    np.testing.assert_allclose(positions[-1], goal)


def test_end_stops_and_a_line_that_is_not_open_are_faults(arm: Arm) -> None:
    simulated = SimulatedArm(arm, InstantClock())
    with pytest.raises(HardwareError, match="not connected"):
        simulated.send(REST)
    beyond = REST.copy()
    beyond[2] = np.radians(31)
    with pytest.raises(HardwareError, match=r"q3 .* 31 deg"):
        simulated.connect(beyond)
    simulated.connect(REST)
    with pytest.raises(HardwareError, match=r"q3 .* 31 deg"):
        simulated.send(beyond)
    simulated.close()
    simulated.close()
