"""Options in people's own files: who goes before whom, and what is wrong with a file is said with its name."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from planner.cli import main
from planner.trajectory import read_trajectory

SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 40 20"><path d="M5 5H30" stroke="#000"/></svg>'


@pytest.fixture
def drawing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A drawing in a folder of its own, and a file of the user's own that is elsewhere."""
    monkeypatch.setenv("PLAN_CONFIG", str(tmp_path / "own.toml"))
    monkeypatch.chdir(tmp_path)
    (tmp_path / "work").mkdir()
    file = tmp_path / "work" / "line.svg"
    file.write_text(SVG)
    return file


def in_force(capsys: pytest.CaptureFixture[str], *arguments: str) -> dict[str, object]:
    capsys.readouterr()
    assert main(["config", "--json", *arguments]) == 0
    said = json.loads(capsys.readouterr().out)["options"]
    return {name: one["value"] for name, one in said.items()}


def test_what_is_said_nearer_goes_before(drawing: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    own, beside = tmp_path / "own.toml", drawing.parent / "plan.toml"
    assert in_force(capsys, str(drawing))["margin"] == 5.0
    own.write_text('[options]\nmargin = 6\nrate = 200\n[presets.big]\nmargin = "1in"\nrate = 250')
    assert in_force(capsys, str(drawing))["margin"] == 6.0
    beside.write_text('[options]\nmargin = "0.7cm"\n[presets.big]\nmargin = 9')
    assert in_force(capsys, str(drawing))["margin"] == 7.0
    told = in_force(capsys, str(drawing), "--preset", "big")
    assert (told["margin"], told["rate"]) == (9.0, 250.0)
    assert in_force(capsys)["margin"] == 6.0  # there is no drawing to be beside of


def test_a_plan_is_made_with_them_and_the_command_line_goes_before(drawing: Path) -> None:
    (drawing.parent / "plan.toml").write_text(
        '[options]\narm = "mine"\nmargin = 8\nmirror = true\nat = [20, "1cm"]\n[arms]\nmine = "arms/scara.toml"'
    )
    (drawing.parent / "arms").mkdir()
    configs = Path(__file__).parent.parent / "configs"
    (drawing.parent / "arms" / "scara.toml").write_text((configs / "scara.toml").read_text())
    assert main([str(drawing), "-o", "t.csv", "--rotate", "90"]) == 0
    made = read_trajectory(Path("t.csv"))
    assert Path(made.arm).name == "scara.toml" and made.placement.mirror and made.placement.rotate_deg == 90.0
    assert made.placement.scale == 1.0
    assert main([str(drawing), "-o", "t.csv", "--arm", "drawing_arm"]) == 0
    assert read_trajectory(Path("t.csv")).arm == "drawing_arm"
    assert main(["estimate", str(drawing.parent)]) == 0
    assert sorted(path.name for path in drawing.parent.iterdir()) == ["arms", "line.svg", "plan.toml"]


def test_files_are_named_from_where_the_file_of_options_is(drawing: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (drawing.parent / "pens.toml").write_text('[[pen]]\nname = "blue"')
    (drawing.parent / "plan.toml").write_text(
        '[options]\npens = "pens.toml"\ndedup = true\n[presets.near]\ndedup = "1mm"'
    )
    told = in_force(capsys, str(drawing))
    assert told["pens"] == ["blue"] and told["dedup"] == 0.05
    assert in_force(capsys, str(drawing), "--preset", "near")["dedup"] == 1.0
    assert main(["config"]) == 0
    assert "None" not in capsys.readouterr().out
    assert main(["config", "none.svg"]) == 2
    assert "none.svg: no such drawing" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("[options]\nmagrin = 5", "'magrin' is no option; there are align, arm"),
        ('[options]\nmargin = "wide"', "margin: 'wide' is not a length"),
        ("[options]\nmargin = true", "margin is a text or a number"),
        ("[options]\nat = 5", "at is 2 values in brackets"),
        ('[options]\nmirror = "yes"', "mirror is true or false"),
        ('[options]\nplace = "sheet"', "place is one of page, ink"),
        ('[options]\noutput = "x.csv"', "'output' is no option"),
        ("options = 3", "'options' is no table"),
        ("[option]\nmargin = 5", "'option' is no table"),
        ("[presets]\nfast = 5", "preset 'fast' is no table"),
        ("[arms]\nmine = 5", "arm 'mine' is no name of a file"),
        ("margin ==", "not readable TOML"),
    ],
)
def test_a_faulty_file_is_named(
    drawing: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, fault: str
) -> None:
    (tmp_path / "own.toml").write_text(text)
    assert main([str(drawing), "-o", "t.csv"]) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1 and f"{tmp_path / 'own.toml'}: " in message and fault in message
    assert not Path("t.csv").exists()


def test_a_preset_that_is_not_there_is_named_with_those_that_are(
    drawing: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (drawing.parent / "plan.toml").write_text("[presets.slow]\nspeed = 10\n[presets.fine]\nmargin = 1")
    assert main([str(drawing), "--preset", "fast"]) == 2
    assert "there is no preset 'fast' in" in (message := capsys.readouterr().err) and "presets: fine, slow" in message


def test_an_estimate_is_the_time_of_the_trajectory(drawing: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(drawing), "-o", "t.csv", "--quiet"]) == 0
    assert main(["estimate", str(drawing)]) == 0
    assert f"{read_trajectory(Path('t.csv')).duration_s:.1f}" in capsys.readouterr().out
    assert not drawing.with_suffix(".csv").exists()
