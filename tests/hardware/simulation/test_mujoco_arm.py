"""The arm in MuJoCo is the arm of the file; the extra has to be installed, and for the film there has to be EGL."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from hardware.clock import InstantClock
from hardware.motion.tip import link_nodes_mm
from hardware.playback.player import play
from hardware.playback.program import make_program
from hardware.playback.result import End
from hardware.simulation.mujoco_arm import MujocoArm
from planner.arms.arm import Arm
from planner.arms.arm_file import known_arms, load_arm
from planner.errors import HardwareError
from planner.trajectory import Trajectory

pytestmark = pytest.mark.skipif(
    find_spec("mujoco") is None or find_spec("imageio") is None, reason="needs the extra: pip install '.[mujoco]'"
)


@pytest.mark.parametrize("name", known_arms())
def test_its_tip_is_where_the_chain_says(name: str) -> None:
    arm = load_arm(name)
    simulated = MujocoArm(arm, InstantClock())
    for joints in np.random.default_rng(1).uniform(arm.minimum, arm.maximum, (10, arm.n_joints)):
        simulated.connect(joints)
        np.testing.assert_allclose(simulated.tip_mm, link_nodes_mm(arm, joints[None])[0, -1], atol=1e-6)


def test_it_follows_a_program_closely_and_remembers_it(arm: Arm, sketch: Trajectory) -> None:
    made = make_program(arm, arm.from_file_units(sketch.positions), sketch.stroke, sketch.rate_hz)
    clock = InstantClock()
    simulated = MujocoArm(arm, clock)
    played = play(made, arm, simulated, clock)
    assert played.end is End.PLAYED
    recording = simulated.recording
    np.testing.assert_allclose(recording.set_points[:-1], made.positions, atol=1e-12)
    behind = np.degrees(np.abs(recording.positions[3:] - recording.set_points[:-3]))
    assert 0.01 < behind.max() < 3  # it has mass, and it is a servo


def test_a_film_shows_it_at_work(arm: Arm, sketch: Trajectory, tmp_path: Path) -> None:
    import imageio.v2 as imageio

    target, clock = tmp_path / "arm.gif", InstantClock()
    made = make_program(arm, arm.from_file_units(sketch.positions), sketch.stroke, sketch.rate_hz, from_stroke=2)
    try:
        simulated = MujocoArm(arm, clock, target)
    except HardwareError as error:
        pytest.skip(str(error))
    played = play(made, arm, simulated, clock)
    frames = imageio.mimread(target)
    assert len(frames) == pytest.approx(10 * played.duration_s, abs=5)
    assert np.ptp(np.stack([frame[..., :3] for frame in frames]).astype(float), axis=0).max() > 50
