"""Arms that rehearsals are held on: as different from their files as arms are, and with a pen that was set."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from hardware.compensation.servo_values import own_calibration
from planner.arms.arm import Arm
from planner.arms.arm_file import known_arms, load_arm
from planner.arms.usual_servos import with_usual_servos
from planner.arrays import FloatArray
from planner.cli import main
from planner.cli.predict import prediction_of
from planner.error_model.believed import believed
from planner.error_model.chain import tips
from planner.error_model.drawn import drawn_joints
from planner.error_model.random_arm import random_arm
from planner.error_model.slack import followed
from planner.redundancy.arm_model import ArmModel
from planner.trajectory import read_trajectory
from tests.judge import true_arm
from tests.judge.playing import read_record
from tests.judge.verdict import judge

SEEDS = 20
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 20" fill="none" stroke="black">
<path d="M0 0H60V20H0ZM0 20L20 0L40 20L60 0"/></svg>"""


def drawn_by(true: Arm, arm: Arm, positions: FloatArray) -> FloatArray:
    """(n, 3) tips of an arm that is told what `arm` is for positions."""
    told = own_calibration(arm).to_servos(positions)
    model = believed(true)
    goals = np.column_stack([curve.position(told[:, k]) for k, curve in enumerate(model.curves)])
    return tips(model.geometry, followed(goals, model.slack)).tip_mm


@pytest.mark.parametrize("name", known_arms())
def test_every_arm_leaves_ink_and_none_draws_as_its_file_says(name: str) -> None:
    arm = with_usual_servos(load_arm(name))
    positions = drawn_joints(ArmModel(arm))
    meant = tips(believed(arm).geometry, positions).tip_mm
    down = np.ones(len(positions), dtype=np.bool_)
    for seed in range(SEEDS):
        drawn = drawn_by(random_arm(arm, seed, positions, down), arm, positions)
        assert (drawn[:, 2] <= 0).any()
        assert np.hypot(*(drawn - meant)[:, :2].T).max() > 0.5


def test_an_arm_that_nobody_calibrated_is_expected_to_draw_as_such_arms_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    arm = load_arm("drawing_arm_2022")
    Path("drawing.svg").write_text(DRAWING)
    assert main(["drawing.svg", "--arm", "drawing_arm_2022", "-o", "t.csv", "--quiet"]) == 0
    assert main(["run", "t.csv", "--fast", "--record", "p.csv", "--quiet"]) == 0
    record = read_record(Path("p.csv"))
    arms = [true_arm.random_arm(arm, np.random.default_rng(seed)) for seed in range(SEEDS)]
    judged_mm = np.mean([judge(true, record).path_rms for true in arms])
    expected = prediction_of(arm, read_trajectory(Path("t.csv")), Path("t.csv"), 0)
    assert judged_mm / 1.5 < expected.rms_mm < 1.5 * judged_mm
    low, high = expected.rms_interval_mm
    assert low < judged_mm < high
