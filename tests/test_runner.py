"""The runner plays trajectories without the packages that planning needs."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from planner.cli import main as plan
from planner.runner.command import COMMANDS, main
from tests.drawn_shapes import lines_svg

ROOT = Path(__file__).resolve().parents[1]
WITHOUT = """
import importlib.abc, sys
MISSING = {"casadi", "cssselect2", "fontTools", "loky", "matplotlib", "PIL", "ruckig", "scipy", "shapely", "tinycss2",
           "uharfbuzz"}
class Gone(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in MISSING:
            raise ModuleNotFoundError(name, name=name)
sys.meta_path.insert(0, Gone())
from planner.runner.command import main
sys.exit(main(sys.argv[1:]))
"""


@pytest.fixture(scope="module")
def trajectory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runner")
    (folder / "d.svg").write_text(lines_svg('<path d="M5 5 H55"/>', 'viewBox="0 0 60 60" width="60mm" height="60mm"'))
    assert plan([str(folder / "d.svg"), "--arm", "so101", "-o", str(folder / "t.csv"), "--quiet"]) == 0
    return folder / "t.csv"


@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "TRAJECTORY", "--fast", "--record", "RECORD"],
        ["run", "TRAJECTORY", "--fast", "--servos", "real"],
        ["run", "TRAJECTORY", "--dry-run", "--driver", "feetech"],
        ["jog", "--arm", "so101", "-o", "ARM", "--script", "SCRIPT"],
        ["ports"],
        *([name, "--help"] for name in COMMANDS),
    ],
)
def test_its_commands_need_nothing_of_the_planner(trajectory: Path, tmp_path: Path, arguments: list[str]) -> None:
    (tmp_path / "script").write_text("joint 1\nmove 2\nshow\n")
    places = {
        "TRAJECTORY": trajectory,
        "RECORD": tmp_path / "r.csv",
        "ARM": tmp_path / "a.toml",
        "SCRIPT": tmp_path / "script",
    }
    words = [str(places.get(word, word)) for word in arguments]
    ran = subprocess.run([sys.executable, "-c", WITHOUT, *words], capture_output=True, text=True, cwd=ROOT)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout


@pytest.mark.parametrize("words", [["check", "t.csv"], ["d.svg"], ["run"], ["run", "t.csv", "--frame"]])
def test_what_it_cannot_do_it_says(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    code, said = main(words), capsys.readouterr().err
    assert code == 2 and len(said.splitlines()) == 1 and "error" in said


def test_what_it_asks_of_others_the_planner_asks_too() -> None:
    whole, runner = (
        tomllib.loads(file.read_text(encoding="utf-8"))["project"]["dependencies"]
        for file in (ROOT / "pyproject.toml", ROOT / "planner" / "runner" / "pyproject.toml")
    )
    assert set(runner) <= set(whole)
