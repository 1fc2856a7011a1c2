"""`plan arm NAME --at`, the workspace picture, and arms that cannot draw, through the command line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from planner.arms.arm_file import arms_folder
from planner.cli import main
from tests.drawn_shapes import lines_svg

SVG = lines_svg('<path d="M2 2 20 25 38 4"/>', 'viewBox="0 0 40 30"')


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    path = tmp_path / "arc.svg"
    path.write_text(SVG)
    return path


def _error(capsys: pytest.CaptureFixture[str]) -> str:
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("plan: error: ")
    assert captured.err.count("\n") == 1
    return captured.err


def _variant(folder: Path, base: str, *changes: tuple[str, str]) -> str:
    """An arm file with the first occurrence of each text replaced."""
    text = (arms_folder() / f"{base}.toml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path = folder / "variant.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def test_a_configuration_is_told_to_people(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["arm", "scara", "--at", "0", "0", "-120", "0", "--frame", "2"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert "pen: tip at (200.000, 0.000, 0.000) mm, 0.000 deg off straight down" in lines
    assert "limits: kept" in lines
    assert "rank: 3 of 4, over vx vy vz wz" in lines
    assert "manipulability: 0 (mm and rad)" in lines
    assert "condition: infinite" in lines
    assert "singular: the links before and after q2 are stretched out" in lines
    assert "internal motion, the pen at rest: q1 -0.5 deg, q2 +1 deg, q4 -0.5 deg" in lines
    assert "impossible, in frame 2: vx" in lines
    assert "  vy    200.0000    100.0000      0.0000      0.0000" in lines
    assert any(line.startswith("tip error: q1 3.49 mm/deg, q2 1.75 mm/deg, q3 1 mm/mm, q4 0 mm/deg") for line in lines)


def test_a_configuration_is_told_as_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["arm", "scara", "--at", "0", "90", "-80", "-90", "--json"]) == 0
    configuration = json.loads(capsys.readouterr().out)
    assert configuration["joints"] == {"q1": 0, "q2": 90, "q3": -80, "q4": -90}
    assert configuration["outside_limits"] == ["q3 at -80 mm is above its greatest, -90 mm"]
    assert configuration["tip_mm"] == pytest.approx([100, 100, 40])
    assert configuration["manipulability"] == pytest.approx(100 * 100)
    assert np.shape(configuration["jacobian"]) == (6, 4)
    assert (configuration["rank"], configuration["singular"], configuration["shapes"]) == (4, False, [])
    assert configuration["internal_motion"] == configuration["impossible_velocity"] == []
    assert configuration["rows"] == ["vx", "vy", "vz", "wz"]
    assert configuration["tip_error_mm"]["q2"] == pytest.approx(np.pi / 180 * 100)


def test_couplings_fill_in_or_are_held_against_the_configuration(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["arm", "drawing_arm", "--at", "10", "60", "-60", "-60", "--json"]) == 0
    free = json.loads(capsys.readouterr().out)
    assert free["joints"]["q5"] == pytest.approx(-30)
    assert free["tilt_deg"] == pytest.approx(0, abs=1e-6)
    assert len(free["internal_motion"]) == 1
    assert main(["arm", "drawing_arm", "--at", "10", "60", "-60", "-60", "-20"]) == 0
    text = capsys.readouterr().out
    assert "coupling: q5 is off by 10 deg" in text
    assert "10.000 deg off straight down" in text


def test_tilt_of_a_pen_that_only_the_tip_holds_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["arm", "three_joint", "--at", "0", "20", "-80", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["tilt_deg"] == pytest.approx(30)


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["scara", "--at", "0", "0"], "has 4 positions to give (q1, q2, q3, q4), not 2"),
        (["drawing_arm", "--at", "0", "0"], "has 4 or 5 positions to give"),
        (["scara", "--at", "0", "nan", "0", "0"], "not a finite number"),
        (["scara", "--at", "0", "x", "0", "0"], "not a number"),
        (["scara", "--at", "0", "0", "0", "0", "--frame", "5"], "has base, tool and 0 to 4"),
        (["scara", "--frame", "2"], "--frame goes with --at"),
        (["--at", "0", "0"], "--at describes one arm"),
    ],
)
def test_configurations_that_mean_nothing(arguments: list[str], part: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["arm", *arguments]) == 2
    assert part in _error(capsys)


def test_the_workspace_of_an_arm_needs_no_trajectory(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "scara.svg"
    assert main(["plot", "--kind", "workspace", "--arm", "scara", "-o", str(picture)]) == 0
    text = picture.read_text()
    assert "workspace of scara" in text
    assert capsys.readouterr().out == ""
    assert main(["plot", "traj.csv", "--kind", "workspace", "-o", str(picture)]) == 2
    assert "takes no trajectory" in _error(capsys)
    assert main(["plot", "-o", str(picture)]) == 2
    assert "needs a trajectory" in _error(capsys)
    assert main(["plot", "--kind", "workspace", "--arm", "nobody", "-o", str(picture)]) == 2
    assert "unknown arm" in _error(capsys)


COUPLING = "coefficients = { q2 = -1.0, q3 = -1.0, q4 = -1.0 }"


@pytest.mark.parametrize(
    ("base", "changes", "parts"),
    [
        ("drawing_arm", [('joint = "q5"', 'joint = "q7"')], ["coupling[0]", "no joint 'q7'", "q1, q2, q3, q4, q5"]),
        ("drawing_arm", [(COUPLING, COUPLING.replace("q4", "q9"))], ["coupling[0]", "no joint 'q9'"]),
        ("scara", [("min_deg = -120.0", "min_deg = 130.0")], ["joints[0]", "lower limit 130", "upper limit 120"]),
        ("scara", [("max_mm = -90.0", "max_mm = -125.0")], ["joints[2]", "lower limit -125"]),
        (
            "scara",
            [("min_deg = -120.0", "min_deg = 130.0"), ('kind = "prismatic"', 'kind = "sliding"')],
            ["joints[0]", "joints[2]", "sliding"],
        ),
    ],
)
def test_an_arm_file_that_contradicts_itself_is_refused_with_every_fault(
    base: str,
    changes: list[tuple[str, str]],
    parts: list[str],
    drawing: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    arm, target = _variant(tmp_path, base, *changes), tmp_path / "traj.csv"
    for arguments in (
        ["arm", arm],
        [str(drawing), "--arm", arm, "-o", str(target)],
        ["plot", "--kind", "workspace", "--arm", arm, "-o", str(tmp_path / "map.png")],
    ):
        assert main(arguments) == 2
        message = _error(capsys)
        assert all(part in message for part in ["variant.toml", *parts])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["arc.svg", "variant.toml"]


@pytest.mark.parametrize(
    ("base", "changes", "part"),
    [
        ("drawing_arm", [("d_mm = 50.0", "d_mm = 500.0")], "no configuration"),  # a shoulder too high for the paper
        ("scara", [("min_mm = -125.0", "min_mm = -110.0")], "no configuration"),  # a slide too short for it
        ("three_joint", [('hold = "free"', 'hold = "tool_axis"')], "takes 4 joints"),  # too few joints to point the pen
        ("scara", [("inner_radius_mm = 60.0", "inner_radius_mm = 260.0")], "260 mm"),  # the ring begins beyond reach
        ("scara", [("lift_mm = 5.0", "lift_mm = 60.0")], "lower pen.lift_mm"),  # a lift that the slide has not
    ],
)
def test_an_arm_that_cannot_draw_is_refused_with_the_reason(
    base: str,
    changes: list[tuple[str, str]],
    part: str,
    drawing: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    arm, target = _variant(tmp_path, base, *changes), tmp_path / "traj.csv"
    assert main([str(drawing), "--arm", arm, "-o", str(target), "--quiet"]) == 3
    assert part in _error(capsys)
    assert main(["plot", "--kind", "workspace", "--arm", arm, "-o", str(tmp_path / "map.png")]) == 3
    assert part in _error(capsys)
    assert main(["arm", arm]) == 0
    assert f"canvas: none (arm {base}" in capsys.readouterr().out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["arc.svg", "variant.toml"]
