"""Stop by the page while the firmware draws, in the emulator: it brakes along its path, lifts its pen and parks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial import KDTree

from hardware.compensation.servo_values import pulse_calibration
from hardware.motion.tip import link_nodes_mm
from planner.arms.arm_file import load_arm
from planner.arrays import FloatArray
from planner.trajectory import read_trajectory
from tests.hardware.drivers.native.paper import ink
from tests.hardware.emulator.emulator import Emulator, build, on_pty
from tests.hardware.real_time import in_real_time
from tests.serve.served import Server

_ARM = load_arm("drawing_arm")
_CALIBRATION = pulse_calibration(_ARM)
_HALF_STEPS_MM = 0.3
"""Half steps of five servos, and straight lines between pulses."""
_BESIDE_MM = 1.0
"""From the nearest sample, between two of which the pen is."""
_SLACK = 1.3
"""Of velocities that are read off two pulses."""


def _length_mm(lines: list[FloatArray]) -> float:
    return sum(float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()) for line in lines)


def _on_pins(emulator: Emulator) -> tuple[FloatArray, float]:
    """(n_joints,) where the last pulses hold the arm, and the largest share of its limit of velocity that any joint was
    sent at."""
    pulses = [emulator.pulses(channel) for channel in _CALIBRATION.addresses]
    shares = []
    for joint, one in enumerate(pulses):
        at_us = np.tile([other.widths_us[0] for other in pulses], (len(one.widths_us), 1))
        at_us[:, joint] = one.widths_us
        speeds = np.abs(np.diff(_CALIBRATION.to_joints(at_us)[:, joint]) / np.diff(one.starts_s))
        shares.append(float(speeds.max()) / float(_ARM.max_velocity[joint]))
    return _CALIBRATION.to_joints(np.array([one.widths_us[-1] for one in pulses])), max(shares)


@in_real_time("host and emulated controller share the cores with a plan that is made meanwhile")
def test_stop_on_the_firmware_while_a_plan_is_made(tmp_path: Path) -> None:
    emulator, line = on_pty(build(tmp_path), tmp_path)
    try:
        with Server(tmp_path / "house") as server:
            job = server.planned(arm=_ARM.name)
            planned = tmp_path / "house" / "jobs" / job["id"] / job["trajectory"]
            server.post(f"/api/jobs/{server.upload()['id']}/plan", {"arm": "so101", "tolerance": 0.01})
            server.post(f"/api/jobs/{job['id']}/run", {"driver": "native", "port": str(line)})
            server.until(lambda: server.get("/api/state")["run"], lambda run: run["stroke"] >= 0)
            server.post("/api/run/stop")
            run = server.run("idle")
            assert run["ended"] == "stopped" and any("parked" in line for line in run["lines"]), run
            assert server.job(job["id"])["resumable"] == "native"
    finally:
        emulator.end()
    trajectory = read_trajectory(planned)
    tips_mm = link_nodes_mm(_ARM, _ARM.from_file_units(trajectory.positions))[:, -1]
    lines_mm = [tips_mm[trajectory.stroke == stroke, :2] for stroke in range(int(trajectory.stroke.max()) + 1)]
    drawn = ink(emulator, _ARM)
    assert 0 < _length_mm(drawn) < 0.9 * _length_mm(lines_mm)
    assert KDTree(tips_mm[:, :2]).query(np.concatenate(drawn))[0].max() < _BESIDE_MM
    held, fastest = _on_pins(emulator)
    assert fastest < _SLACK
    assert np.linalg.norm(link_nodes_mm(_ARM, held[None])[0, -1] - tips_mm[0]) < _HALF_STEPS_MM
