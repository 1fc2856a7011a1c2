from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.clock import InstantClock
from hardware.simulation.simulated_arm import Servos, SimulatedArm
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.errors import ArmFileError, HardwareError

REST = np.radians([0.0, 60.0, -60.0, -60.0, -30.0])


def test_joints_follow_no_faster_than_they_can(arm: Arm) -> None:
    clock = InstantClock()
    simulated = SimulatedArm(arm, clock)
    simulated.connect(REST)
    goal = REST + np.radians([60.0, 1.0, 0.0, 0.0, 0.0])
    for k in range(31):
        clock.sleep_until(k * 0.01)
        simulated.send(goal, 0.01)
    positions = simulated.recording.positions
    assert np.abs(np.diff(positions, axis=0)).max() <= arm.max_velocity[0] * 0.01 + 1e-12
    assert positions[5, 0] == pytest.approx(5 * arm.max_velocity[0] * 0.01)
    np.testing.assert_allclose(positions[-1], goal)


def test_end_stops_and_a_line_that_is_not_open_are_faults(arm: Arm) -> None:
    simulated = SimulatedArm(arm, InstantClock())
    with pytest.raises(HardwareError, match="not connected"):
        simulated.send(REST, 0.01)
    beyond = REST.copy()
    beyond[2] = np.radians(31)
    with pytest.raises(HardwareError, match=r"q3 .* 31 deg"):
        simulated.connect(beyond)
    simulated.connect(REST)
    with pytest.raises(HardwareError, match=r"q3 .* 31 deg"):
        simulated.send(beyond, 0.01)
    simulated.close()
    simulated.close()


def test_everything_sent_is_reached_once_awaited(arm: Arm) -> None:
    clock = InstantClock()
    simulated = SimulatedArm(arm, clock)
    simulated.connect(REST)
    goal = REST + np.radians([80.0, 0.0, 0.0, 0.0, 0.0])
    simulated.send(goal, 0.01)
    simulated.flush()
    np.testing.assert_allclose(simulated.recording.positions[-1], goal)
    assert clock.now_s() == pytest.approx(80 / 400)


def test_an_emergency_stop_holds_where_the_joints_are(arm: Arm) -> None:
    clock = InstantClock()
    simulated = SimulatedArm(arm, clock)
    simulated.connect(REST)
    simulated.send(REST + np.radians([80.0, 0.0, 0.0, 0.0, 0.0]), 0.01)
    clock.sleep_until(0.05)
    simulated.emergency_stop()
    simulated.flush()
    np.testing.assert_allclose(np.degrees(simulated.recording.positions[-1] - REST), [20, 0, 0, 0, 0], atol=1e-9)


def _converged(arm: Arm, way_deg: list[float]) -> list[float]:
    """Where q1 comes to rest at each of the set points (deg from REST), behind real servos."""
    clock = InstantClock()
    simulated = SimulatedArm(arm, clock, Servos.REAL)
    simulated.connect(REST)
    places = []
    for angle in way_deg:
        simulated.send(REST + np.radians([angle, 0.0, 0.0, 0.0, 0.0]), 0.01)
        simulated.flush()
        places.append(float(np.degrees(simulated.recording.positions[-1] - REST)[0]))
    return places


@settings(max_examples=30, deadline=None)
@given(way_deg=st.lists(st.floats(-60, 60), min_size=1, max_size=10))
def test_real_servos_come_to_rest_within_dead_band_play_and_resolution(way_deg: list[float]) -> None:
    arm = load_arm("drawing_arm")
    off = np.abs(np.array(_converged(arm, way_deg)) - way_deg)
    assert off.max() <= 0.5 + 0.5 + 0.025 + 0.01  # half the play, 5 us of dead band, half of 0.5 us; 10 us per degree


def test_real_servos_ignore_what_is_within_their_dead_band_and_play(arm: Arm) -> None:
    assert _converged(arm, [0.4, -0.4, 0.4]) == pytest.approx([0, 0, 0])
    # 2 degrees on, less the dead band and half the play; then back, where the play is gone through first.
    there, back = _converged(arm, [2.0, 1.2])
    assert there == pytest.approx(2 - 0.5 - 0.5, abs=0.01)
    assert back == there


def test_real_servos_have_to_be_described() -> None:
    with pytest.raises(ArmFileError, match="does not say how joint q1 is moved"):
        SimulatedArm(load_arm("scara"), InstantClock(), Servos.REAL)


def test_servos_on_a_bus_have_dead_band_and_play_too() -> None:
    so101 = load_arm("so101")
    rest = so101.from_file_units([0.0, -20.0, 30.0, 40.0, 0.0])
    joint = so101.joints[0]
    assert joint.bus is not None
    arm = replace(so101, joints=(replace(joint, bus=replace(joint.bus, dead_band_counts=8.0)), *so101.joints[1:]))
    clock = InstantClock()
    simulated = SimulatedArm(arm, clock, Servos.REAL)
    simulated.connect(rest)
    places = []
    for angle in (0.9, 3.0, 2.6):
        simulated.send(rest + np.radians([angle, 0.0, 0.0, 0.0, 0.0]), 0.01)
        simulated.flush()
        places.append(float(np.degrees(simulated.recording.positions[-1] - rest)[0]))
    band_deg = 8.0 / 11.377778
    assert places[0] == pytest.approx(0.0, abs=1e-3)  # within dead band and half the play of 0.5 degrees
    assert places[1] == pytest.approx(3.0 - band_deg - 0.25, abs=0.05)  # to a whole count of 0.09 degrees
    assert places[2] == places[1]
