"""An arm that needs two branches for its paper: forwards near the base, folded over backwards far from it."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from planner.arms.arm import Arm
from planner.arms.arm_file import arms_folder, load_arm
from planner.cli import main
from planner.kinematics.limits import within_limits
from planner.trajectory import TRAVELLING, read_trajectory
from planner.workspace.canvas import usable_canvas
from tests.arms.chains import model_of
from tests.drawn_shapes import lines_svg

LIMITS = {"q1": (-270.0, 90.0), "q2": (40.0, 178.0), "q3": (-150.0, 60.0), "q5": (-300.0, 60.0)}
TRIANGLE = '<g fill="none" stroke="black"><path d="M5 5 L110 85 L215 5 Z"/><path d="M110 5 V85"/></g>'


@pytest.fixture(scope="module")
def arm_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The drawing arm with limits that its elbow can bend over backwards in."""
    head, *joints = (arms_folder() / "drawing_arm.toml").read_text(encoding="utf-8").split("[[joints]]")
    for index, text in enumerate(joints):
        name = text.split('"')[1]
        if name in LIMITS:
            lines = [
                f"{line.split(' = ')[0]} = {LIMITS[name][line.startswith('max_deg')]}"
                if line.startswith(("min_deg", "max_deg"))
                else line
                for line in text.splitlines()
            ]
            joints[index] = "\n".join(lines) + "\n"
    file = tmp_path_factory.mktemp("arms") / "two_sheets.toml"
    file.write_text("[[joints]]".join([head, *joints]), encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def arm(arm_file: Path) -> Arm:
    return load_arm(str(arm_file))


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    file = tmp_path / "triangle.svg"
    file.write_text(
        lines_svg(f"{TRIANGLE}", 'viewBox="0 0 220 90"'),
        encoding="utf-8",
    )
    return file


def test_two_sheets_reach_what_neither_reaches_alone(arm: Arm) -> None:
    near, far = model_of(arm).branches()
    assert near.radii_mm[0] < far.radii_mm[0] < near.radii_mm[-1] < far.radii_mm[-1]
    for sheet in (near, far):
        assert within_limits(arm, arm.complete(sheet.configurations)).all()
    corners = np.hypot(*usable_canvas(model_of(arm), arm.pen.lift_mm).corners_arm_mm.T)
    assert corners.max() > near.radii_mm[-1] + 5 and corners.min() < far.radii_mm[0] - 5


def test_strokes_across_both_are_split_drawn_and_told(
    arm_file: Path, drawing: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "triangle.csv"
    assert main([str(drawing), "-o", str(output), "--arm", str(arm_file)]) == 0
    assert re.search(
        "split, as no one branch reaches all of each: 1 stroke, with [34] more pen lifts", capsys.readouterr().err
    )
    assert main(["check", str(output), "--drawing", str(drawing)]) == 0, capsys.readouterr().out
    trajectory = read_trajectory(output)
    forwards = {
        int(stroke): set((trajectory.positions[trajectory.stroke == stroke, 0] > -90).tolist())
        for stroke in np.unique(trajectory.stroke[trajectory.stroke != TRAVELLING])
    }
    assert len(forwards) == 5
    assert all(len(branches) == 1 for branches in forwards.values())  # none changes its branch pen down
    assert {True, False} == set().union(*forwards.values())


def test_a_long_stroke_that_begins_where_both_reach_keeps_to_the_one_that_reaches_its_end(
    arm_file: Path, tmp_path: Path
) -> None:
    width, height, count = 176.46, 71.48, 800
    zigzag = " L".join(f"{28.24 - 27 * k / count:.6g},{3.3 - 3 * (k % 2):.6g}" for k in range(count))
    file, output = tmp_path / "zigzag.svg", tmp_path / "zigzag.csv"
    file.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" fill="none" '
        f'stroke="black" viewBox="0 0 {width} {height}"><path d="M{zigzag}"/></svg>'
    )
    assert main([str(file), "-o", str(output), "--arm", str(arm_file), "--no-fit", "--quiet"]) == 0
