"""`plan compare` on the command line: what it refuses, and where its results go."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from planner.cli import main


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "one of DRAWING.svg, --target and --random"),
        (["a.svg", "--random", "3"], "not DRAWING.svg and --random"),
        (["--target", "50", "10", "--random", "3"], "not --target and --random"),
        (["--target", "50"], "--target takes X Y or X Y Z, not 1"),
        (["--target", "50", "1", "2", "3"], "not 4 numbers"),
        (["--target", "50", "north"], "'north' is not a length"),
        (["--random", "0"], "'0' is not a whole number from 1"),
        (["--random", "2.5"], "'2.5' is not a whole number"),
        (["--target", "50", "10", "--seed", "1"], "--seed goes with --random"),
        (["--random", "3", "--margin", "4"], "placement and motion are of drawings"),
        (["--target", "50", "10", "--method", "dls"], "unrecognized arguments: --method"),
        (["--target", "50", "10", "--start", "0", "60"], "has 4 or 5 positions to give"),
        (
            ["--target", "50", "10", "--start", "0", "60", "-40", "-50", "-50"],
            "the coupling of arm 'drawing_arm' makes q5",
        ),
        (["--target", "50", "10", "--arm", "nobody"], "unknown arm 'nobody'"),
        (["--target", "50", "10", "--plot", "picture.gif"], "ends in one of .png, .svg, .pdf"),
        (["--target", "50", "10", "--json", "nowhere/out.json"], "there is no folder"),
        (["missing.svg"], "missing.svg"),
    ],
)
def test_wrong_usage_is_one_line_and_exits_2(
    arguments: list[str],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["compare", *arguments]) == 2
    shown = capsys.readouterr()
    assert shown.out == "" and shown.err.startswith("plan: error: ") and shown.err.count("\n") == 1
    assert message in shown.err
    assert list(tmp_path.iterdir()) == []


def test_out_of_reach_exits_3_and_leaves_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    target = tmp_path / "far.json"
    assert main(["compare", "--arm", "three_joint", "--target", "900", "0", "0", "--json", str(target)]) == 3
    assert "target (900, 0, 0) mm is out of reach: the nearest tip found is" in capsys.readouterr().err
    assert not target.exists()


def test_json_on_standard_output_is_all_there_is(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    picture = tmp_path / "configurations.svg"
    assert (
        main(
            [
                "compare",
                "--arm",
                "three_joint",
                "--target",
                "15cm",
                "-20",
                "--target",
                "150",
                "-20",
                "0",
                "--json",
                "-",
                "--plot",
                str(picture),
            ]
        )
        == 0
    )
    found = json.loads(capfd.readouterr().out)
    assert found["targets"]["tips_mm"] == [[150.0, -20.0, 0.0]] * 2
    assert found["methods"][0]["postures"][0] == found["methods"][0]["postures"][1]
    assert picture.read_text().startswith("<?xml")


def test_the_same_seed_compares_the_same_targets(capfd: pytest.CaptureFixture[str]) -> None:
    measured = ("cold_ms", "warm_us")
    found = []
    for seed in ("4", "4", "5"):
        assert main(["compare", "--arm", "three_joint", "--random", "6", "--seed", seed, "--json", "-"]) == 0
        found.append(
            [
                {key: value for key, value in method.items() if key not in measured}
                for method in json.loads(capfd.readouterr().out)["methods"]
            ]
        )
    assert found[0] == found[1] != found[2]
