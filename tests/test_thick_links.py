"""Arms with thick links, end to end: kept apart, refused where a method does not keep them so, found by the check."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from planner import pen_drawing
from planner.arms.arm_file import arms_folder, read_arm_file
from planner.arms.description import arm_description
from planner.checking.check import check_trajectory
from planner.cli import main
from planner.drawing.svg import read_drawing
from planner.errors import LinksCollide
from planner.execution.context import PlanContext
from planner.execution.work_chunks import TravelChunk, planned_travel_moves
from planner.execution.workers import ALONE
from planner.kinematics.link_clearance import Collision
from planner.motion.timed_stroke import Contact
from planner.pipeline import plan
from planner.settings import PlaceKind, PlanSettings
from planner.trajectory import TRAVELLING, Trajectory, read_trajectory
from planner.travel.travel_moves import TravelMove, TravelRules
from tests.arms.chains import load_once, model_of, thick

LINES = ("M20 5 H200", "M110 20 V50", "M100 89 H120")  # the last one near the base, where the arm folds most


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    file = tmp_path / "lines.svg"
    paths = "".join(f'<path d="{line}"/>' for line in LINES)
    file.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 220 90" fill="none" stroke="black">{paths}</svg>',
        encoding="utf-8",
    )
    return file


def arm_file(folder: Path, **thickness_mm: float) -> Path:
    """The drawing arm with these links thick."""
    head, *joints = (arms_folder() / "drawing_arm.toml").read_text(encoding="utf-8").split("[[joints]]")
    for index, text in enumerate(joints):
        if (name := text.split('"')[1]) in thickness_mm:
            joints[index] = re.sub("(?m)^(d_mm = .*)$", rf"\1\nthickness_mm = {thickness_mm[name]}", text)
    file = folder / "thick.toml"
    file.write_text("[[joints]]".join([head, *joints]), encoding="utf-8")
    assert sum(joint.thickness_mm is not None for joint in read_arm_file(file).joints) == len(thickness_mm)
    return file


def test_an_arm_that_folds_without_thickness_does_not_with_it(
    drawing: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arm = str(arm_file(tmp_path, q1=40.0, q2=40.0, q3=40.0, q4=40.0, q5=40.0))
    output = str(tmp_path / "lines.csv")
    assert main([str(drawing), "-o", output, "--margin", "0", "--place", "ink", "--quiet"]) == 0
    assert main(["check", output, "--verbose"]) == 0
    assert "links apart" not in capsys.readouterr().out
    assert main(["check", output, "--arm", arm, "--json", str(tmp_path / "result.json")]) == 1
    (fault,) = [
        finding for finding in json.loads((tmp_path / "result.json").read_text())["findings"] if not finding["passed"]
    ]
    assert fault["check"] == "links apart" and fault["worst"] < -5 and fault["place"]["stroke"] == 2
    assert main([str(drawing), "-o", output, "--arm", arm, "--margin", "0", "--place", "ink", "--quiet"]) == 0
    capsys.readouterr()
    assert main(["check", output, "--arm", arm, "--drawing", str(drawing), "--verbose"]) == 0, capsys.readouterr().out
    assert "links apart" in capsys.readouterr().out


def test_a_method_that_runs_into_itself_is_refused_or_left_out(
    drawing: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arm, output = str(arm_file(tmp_path, q2=38.0, q4=38.0)), tmp_path / "lines.csv"
    arguments = [
        str(drawing),
        "-o",
        str(output),
        "--arm",
        arm,
        "--method",
        "dls",
        "--margin",
        "0",
        "--place",
        "ink",
        "--quiet",
    ]
    assert main(arguments) == 3
    message = capsys.readouterr().err
    assert re.search(r"stroke 2, point \d at .* there would be -\d\.\d\d mm between link q2 and link q4", message)
    assert not output.exists()
    assert main([*arguments, "--skip-unreachable"]) == 0
    assert "left out whole, as method dls cannot draw them: 1 stroke" in capsys.readouterr().err
    assert main(["check", str(output), "--arm", arm]) == 0
    assert set(read_trajectory(output).stroke.tolist()) == {TRAVELLING, 0, 1}


def test_hops_between_configurations_that_collide_are_told() -> None:
    """At its inner edge the field of the thin arm folds too far for the thick one."""
    thin = load_once("drawing_arm")
    arm, field = thick(thin, **dict.fromkeys(("q1", "q2", "q3", "q4", "q5"), 40.0)), model_of(thin).configuration_map()
    tips = np.array([[field.radii_mm[0] + 0.1, 0.0], [100.0, 0.0]])
    configurations, _ = field.configurations_at(np.column_stack((tips, np.zeros(2))))
    near, far = (Contact(tip, configuration) for tip, configuration in zip(tips, configurations, strict=True))
    rules = TravelRules(1.0, 5.0, 30.0, 100.0, 0.05)
    chunk = TravelChunk(PlanContext.of(arm, PlanSettings()), rules, [None, far, near], [far, near, None])
    clear, comes, goes = (move.collision for move in planned_travel_moves(chunk))
    assert clear is None and comes is not None and goes is not None
    assert goes.links == ("link q2", "link q4") and goes.configuration <= 5  # it folds most just above the paper
    assert comes.clearance_mm == pytest.approx(goes.clearance_mm, abs=1e-3) and goes.clearance_mm < -5


def test_strokes_that_no_travel_move_gets_to_are_refused_or_left_out(
    drawing: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever comes to the stroke near the base collides."""

    def colliding(chunk: TravelChunk) -> list[TravelMove]:
        bad = [end is not None and abs(end.tip_mm[1]) < 20 and end.tip_mm[0] < 40 for end in chunk.end]
        return [
            replace(move, collision=Collision(("link q2", "link q4"), -1.5, len(move.joints) - 1)) if is_bad else move
            for move, is_bad in zip(planned_travel_moves(chunk), bad, strict=True)
        ]

    def unheard(stage: str, done: int, total: int) -> None:
        pass

    monkeypatch.setattr(pen_drawing, "planned_travel_moves", colliding)
    with pytest.raises(LinksCollide, match=r"before stroke 2 there would be -1\.50 mm between link q2 and") as told:
        plan(drawing, PlanSettings(place=PlaceKind.INK, margin_mm=0.0), unheard, ALONE)
    assert (told.value.stroke, told.value.links, told.value.exit_code) == (2, ("link q2", "link q4"), 3)
    made = plan(drawing, PlanSettings(place=PlaceKind.INK, margin_mm=0.0, skip_unreachable=True), unheard, ALONE)
    assert set(made.trajectory.stroke.tolist()) == {TRAVELLING, 0, 1}
    check_result = check_trajectory(made.trajectory, load_once("drawing_arm"), read_drawing(drawing))
    assert check_result.passed, check_result.text()
    assert "left out as asked" in check_result.text()
    assert "left out whole, as links would collide before or after them: 1 stroke" in made.summary.warnings


def resting(configuration_deg: list[float]) -> Trajectory:
    """The drawing arm with its pen up."""
    count = 12
    return Trajectory(
        "drawing_arm",
        "",
        "hand",
        100.0,
        load_once("drawing_arm").column_names,
        np.tile(configuration_deg, (count, 1)),
        np.zeros(count, dtype=bool),
        np.full(count, TRAVELLING),
        (1.0, 0.0, 0.0, 1.0, 0.0, 0.0),
    )


def test_a_trajectory_that_folds_is_found_by_the_check() -> None:
    arm = thick(load_once("drawing_arm"), q3=20.0, q4=20.0)
    folded, open_ = [0.0, 120.0, 0.0, -150.0, -60.0], [0.0, 120.0, -60.0, -90.0, -60.0]
    for configuration, diameter, fault in ((folded, 24.0, False), (folded, 26.0, True), (open_, 26.0, False)):
        check_result = check_trajectory(resting(configuration), thick(arm, q3=diameter, q4=diameter))
        (finding,) = [one for one in check_result.findings if one.check == "links apart"]
        assert finding.passed is not fault, check_result.text()
        if configuration is folded:  # 50 sin(30 degrees) from the axis
            assert finding.worst == pytest.approx(25 - diameter) and "between q3 and q4" in finding.remark
        else:
            assert finding.worst is None


def test_a_thick_link_in_the_paper_is_found_by_the_check() -> None:
    """The corner between q3 and q4 is 50 + 50 sin(20 degrees) - 50 mm high."""
    configuration = [0.0, 20.0, -110.0, 90.0, -90.0]
    for diameter, fault in ((34.0, False), (35.0, True)):
        arm = thick(load_once("drawing_arm"), q3=diameter)
        (finding,) = [
            one
            for one in check_trajectory(resting(configuration), arm).findings
            if one.check == "links below the paper"
        ]
        assert finding.passed is not fault
        if fault:
            assert finding.worst == pytest.approx(17.5 - 50 * np.sin(np.radians(20)))


def test_an_arm_is_described_with_its_thickness(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arm = str(arm_file(tmp_path, q2=18.0, q4=12.5))
    assert main(["arm", arm]) == 0
    assert "links that stay apart, by thickness: q2 18 mm, q4 12.5 mm" in capsys.readouterr().out
    joints = arm_description(read_arm_file(Path(arm)))["joints"]
    assert [joint.get("thickness_mm") for joint in joints] == [None, 18.0, None, 12.5, None]
