"""What is expected of an arm: causes are found where they are, and the picture tells of all of it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from planner.arms.accuracy import Accuracy
from planner.arms.arm import Arm
from planner.arms.arm_file import load_arm
from planner.arms.arm_text import arm_toml
from planner.cli import main
from planner.cli.predict import prediction_of
from planner.plots.expected import plot_expected
from planner.plots.look import Look, Theme
from planner.trajectory import Trajectory, read_trajectory

DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 20" fill="none" stroke="black">
<path d="M0 0H60V20H0Z"/><circle cx="30" cy="10" r="7"/><path d="M45 13v0"/></svg>"""


@pytest.fixture(scope="module")
def csv(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("planned")
    (folder / "drawing.svg").write_text(DRAWING)
    command = [str(folder / "drawing.svg"), "--arm", "drawing_arm_2022", "-o", str(folder / "t.csv"), "--quiet"]
    assert main([*command, "--speed", "25"]) == 0
    return folder / "t.csv"


@pytest.fixture(scope="module")
def trajectory(csv: Path) -> Trajectory:
    return read_trajectory(csv)


def calibrated(slack_deg: dict[str, float], *, tip_mm: float = 0.0, height_mm: float = 0.0, known: bool = True) -> Arm:
    """With slack that the file tells of, or that the calibration left open."""
    arm, joints = load_arm("drawing_arm_2022"), []
    for joint in arm.joints:
        assert joint.servo is not None
        play = 2 * np.radians(slack_deg.get(joint.name, 0.0)) if known else 0.0
        joints.append(replace(joint, servo=replace(joint.servo, dead_band_us=0.0, backlash=play)))
    left = tuple(0.0 if known else float(np.radians(slack_deg.get(joint.name, 0.0))) for joint in joints)
    return replace(arm, joints=tuple(joints), accuracy=Accuracy(49, tip_mm, height_mm, left))


@pytest.mark.parametrize("name", ["q2", "q3", "q4"])
def test_the_joint_that_has_slack_is_named_first(name: str, csv: Path, trajectory: Trajectory) -> None:
    figures = prediction_of(calibrated({name: 3.0}, known=False), trajectory, csv, 0)
    assert figures.causes[0].name == f"slack of {name}"
    assert figures.causes[0].mm > 0.3
    assert f"slack of {name} costs {figures.causes[0].mm:.2f} mm: preload it with a rubber band" in figures.lines()


def test_what_is_not_known_at_rest_hides_no_slack(csv: Path, trajectory: Trajectory) -> None:
    """An error of place that is far larger leaves the figures of the others as they are."""
    slack = {"q3": 3.0}
    alone = prediction_of(calibrated(slack, known=False), trajectory, csv, 0)
    beside = prediction_of(calibrated(slack, tip_mm=5.0, known=False), trajectory, csv, 0)
    assert beside.causes[0].name == "what 49 marks left open"
    mm = [{cause.name: cause.mm for cause in figures.causes} for figures in (alone, beside)]
    assert mm[1]["slack of q3"] == pytest.approx(mm[0]["slack of q3"], rel=0.5)
    assert "calibrate" in prediction_of(load_arm("drawing_arm_2022"), trajectory, csv, 0).causes[0].cure


def test_along_the_lines_and_over_all_it_is_the_same(csv: Path, trajectory: Trajectory) -> None:
    figures = prediction_of(calibrated({}, tip_mm=0.5, height_mm=1.5), trajectory, csv, 0)
    along = figures.along
    assert np.sqrt(np.mean(along.off_mm**2)) == pytest.approx(figures.rms_mm)
    assert along.missing.mean() == pytest.approx(figures.missing_share)
    assert 0.05 < figures.missing_share < 0.5
    assert len(along.meant_mm) == len(along.one_mm) == int((along.stroke >= 0).sum())


@pytest.mark.parametrize("theme", list(Theme))
@pytest.mark.parametrize(("tip_mm", "height_mm"), [(0.1, 0.1), (6.0, 6.0)])
def test_the_picture_has_a_band_gaps_a_map_and_causes(
    theme: Theme, tip_mm: float, height_mm: float, csv: Path, trajectory: Trajectory
) -> None:
    figures = prediction_of(calibrated({"q3": 1.0}, tip_mm=tip_mm, height_mm=height_mm), trajectory, csv, 0)
    figure = plot_expected(figures, "drawing.svg", figures.summary(), Look.of(theme, dpi=40))
    lines, paper = figure.axes[:2]
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "where 95 of 100 such arms draw it" in legend
    assert any("ink may be missing" in label for label in legend) is (height_mm > 1)
    widest_pt = max(line.get_linewidth() for line in lines.get_lines())
    per_mm = np.diff(lines.transData.transform([(0, 0), (0, 1)])[:, 1])[0] * 72 / figure.dpi
    assert widest_pt / per_mm == pytest.approx(2 * 1.96 * figures.along.off_mm.max(), rel=0.1)
    assert len(paper.get_images()) == 1
    assert float(np.nanmax(paper.get_images()[0].get_array())) <= figures.along.off_mm.max() + 1e-9
    said = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert said[0] == figures.causes[0].text()


def test_the_command_draws_and_says_it(csv: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arm = tmp_path / "arm.toml"
    arm.write_text(arm_toml(calibrated({"q3": 2.0}, tip_mm=0.1)))
    for name, begins in (("p.png", b"\x89PNG"), ("p.svg", b"<?xml")):
        assert main(["predict", str(csv), "--arm", str(arm), "--plot", str(tmp_path / name), "--json"]) == 0
        assert (tmp_path / name).read_bytes().startswith(begins)
        told = json.loads(capsys.readouterr().out)
        assert all(set(cause) == {"cause", "mm", "cure"} for cause in told["causes"])
    for target, message in (("p.gif", "a picture file ends in"), (str(csv), "a picture file ends in")):
        assert main(["predict", str(csv), "--arm", str(arm), "--plot", target]) == 2
        assert message in capsys.readouterr().err
