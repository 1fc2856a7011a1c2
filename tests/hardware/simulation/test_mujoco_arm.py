"""The arm in MuJoCo is the arm of the file; the extra has to be installed, and for the film there has to be EGL."""

from __future__ import annotations

from dataclasses import replace
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
from planner.arms.paper_pose import PaperPose
from planner.arms.rigid_transform import RigidTransform
from planner.errors import HardwareError
from planner.trajectory import Trajectory

pytestmark = pytest.mark.skipif(
    find_spec("mujoco") is None or find_spec("imageio") is None, reason="needs the extra: pip install '.[mujoco]'"
)


PAPER = PaperPose(12.0, -7.0, 3.0, 0.2, -0.1, 0.08)


@pytest.mark.parametrize("paper", [PaperPose(), PAPER])
@pytest.mark.parametrize("name", known_arms())
def test_its_tip_is_where_the_chain_says(name: str, paper: PaperPose) -> None:
    arm = replace(load_arm(name), paper=paper)
    if not paper.is_base_plane:  # and with the frames that robot descriptions have
        moved = RigidTransform(5.0, -3.0, 8.0, 0.3, -0.2, 1.1)
        arm = replace(arm, tool=moved, joints=tuple(replace(joint, origin=moved) for joint in arm.joints))
    simulated = MujocoArm(arm, InstantClock())
    for joints in np.random.default_rng(1).uniform(arm.minimum, arm.maximum, (10, arm.n_joints)):
        simulated.connect(joints)
        np.testing.assert_allclose(simulated.tip_mm, link_nodes_mm(arm, joints[None])[0, -1], atol=1e-6)


def test_what_it_weighs_pulls_it_down_as_the_base_stands_not_as_the_paper_lies() -> None:
    upright = load_arm("drawing_arm")
    rest = (upright.minimum + upright.maximum) / 2
    sagged = []
    for arm in (upright, replace(upright, paper=PAPER)):
        clock = InstantClock()
        simulated = MujocoArm(arm, clock)
        simulated.connect(rest)
        simulated.send(rest, 0.01)
        simulated.flush()
        sagged.append(simulated.recording.positions[-1] - rest)
    assert np.abs(sagged[0]).max() > 1e-5
    np.testing.assert_allclose(sagged[1], sagged[0], atol=1e-8)


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
