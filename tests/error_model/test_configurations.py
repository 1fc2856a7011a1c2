"""The configurations that drawings are drawn in, in the eyes of what predicts their errors."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from planner.arms.accuracy import Accuracy
from planner.arms.arm_file import load_arm
from planner.arms.arm_text import arm_toml
from planner.cli import main
from planner.cli.predict import prediction_of
from planner.trajectory import read_trajectory

CHANCE = 1.05
"""Of a prediction: it differs by as much from one seed to the next, and drawings differ in what suits them."""
DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 40" fill="none" stroke="black">
<path d="M0 0H60V40H0ZM0 40L30 0L60 40M30 0V40M0 20H60M10 3V35M50 35V4"/><circle cx="30" cy="20" r="15"/></svg>"""


@pytest.mark.parametrize("name", ["drawing_arm_2022", "so101"])
def test_the_default_draws_no_worse_and_no_longer_than_damped_least_squares(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On an arm whose errors at rest a calibration has taken away, so that those are left which configurations decide
    about."""
    monkeypatch.chdir(tmp_path)
    arm = load_arm(name)
    known = Accuracy(49, 0.1, 0.1, tuple((0.1 * arm.per_file_unit).tolist()))
    Path("arm.toml").write_text(arm_toml(replace(arm, accuracy=known, pen=replace(arm.pen, speed_mm_s=25.0))))
    Path("drawing.svg").write_text(DRAWING)

    def drawn(*options: str) -> tuple[float, int]:
        target = Path("t.csv")
        assert main(["drawing.svg", "--arm", "arm.toml", "-o", str(target), "--quiet", *options]) == 0
        trajectory = read_trajectory(target)
        return prediction_of(load_arm("arm.toml"), trajectory, target, 0).rms_mm, len(trajectory.stroke)

    (ours_mm, ours), (theirs_mm, theirs) = drawn(), drawn("--method", "dls")
    assert ours_mm <= CHANCE * theirs_mm
    assert ours <= 1.01 * theirs  # strokes and hops take whole samples
