"""The command `arm` in real vpype, and vpype in a pipe."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import vpype_cli
from click.testing import CliRunner

from planner.trajectory import read_trajectory

VPYPE = [str(Path(sys.executable).with_name("vpype"))]
PICTURE = [
    "line",
    "0",
    "0",
    "10cm",
    "5cm",
    "circle",
    "-l2",
    "3cm",
    "3cm",
    "2cm",
    "name",
    "-l1",
    "sky",
    "pagesize",
    "12cmx6cm",
]


def piped(*commands: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """The commands one after the other, the output of each the input of the next."""
    text = ""
    for command in commands:
        done = subprocess.run(command, cwd=folder, input=text, capture_output=True, text=True, check=False)
        if done.returncode:
            break
        text = done.stdout
    return done


def test_a_pipeline_ends_in_a_trajectory(tmp_path: Path) -> None:
    done = piped(
        [*VPYPE, *PICTURE, "arm", "--arm", "scara", "-x", "margin=1cm", "-x", "by=layer", "t.csv"], folder=tmp_path
    )
    assert done.returncode == 0, done.stderr
    made = read_trajectory(tmp_path / "t.csv")
    assert (made.arm, made.placement.margin_mm) == ("scara", 10.0)
    assert int(made.stroke.max()) == 1
    straight = piped(
        [*VPYPE, *PICTURE, "write", "t.svg"],
        [sys.executable, "-m", "planner", "t.svg", "-o", "u.csv", "--arm", "scara", "--margin", "1cm", "--by", "layer"],
        folder=tmp_path,
    )
    assert straight.returncode == 0, straight.stderr
    np.testing.assert_array_equal(read_trajectory(tmp_path / "u.csv").positions, made.positions)


@pytest.mark.parametrize("wrong", [["-x", "margn=1cm"], ["--arm", "nobody"], ["-x", "margin=1m"], ["-x", "tile"]])
def test_what_plan_refuses_ends_the_pipeline(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, wrong: list[str]) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(vpype_cli.cli, [*PICTURE, "arm", *wrong, "t.csv"])
    assert done.exit_code and isinstance(done.exception, SystemExit) and "Error: " in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_pipeline_that_plan_refuses_ends_without_a_traceback(tmp_path: Path) -> None:
    done = piped([*VPYPE, *PICTURE, "arm", "--arm", "nobody", "t.csv"], folder=tmp_path)
    assert done.returncode and "Traceback" not in done.stderr and "Error: " in done.stderr
    assert not list(tmp_path.iterdir())


def test_vpype_plan_and_run_work_in_a_pipe(tmp_path: Path) -> None:
    plan = [sys.executable, "-m", "planner"]
    done = piped(
        [*VPYPE, *PICTURE, "write", "--format", "svg", "-"],
        [*plan, "-", "-o", "-"],
        [*plan, "run", "-", "--fast"],
        folder=tmp_path,
    )
    assert done.returncode == 0 and "played" in done.stdout, done.stderr
