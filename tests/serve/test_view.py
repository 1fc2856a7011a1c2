"""What the page shows of arms and trajectories: people wait for it, so that it loads what it needs and no more."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from planner.cli import main
from tests.drawn_shapes import lines_svg

LOADED = """
import json, sys
from planner.serve.view import main
code = main(sys.argv[1:])
print(json.dumps([code, sorted({name.partition(".")[0] for name in sys.modules})]))
"""


@pytest.fixture(scope="module")
def trajectory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("line")
    (folder / "line.svg").write_text(lines_svg('<path d="M0 0h3"/>', 'viewBox="0 0 3 3"'))
    assert main([str(folder / "line.svg"), "-o", str(folder / "line.csv"), "--quiet"]) == 0
    return folder / "line.csv"


@pytest.mark.parametrize(
    ("kind", "unneeded"), [("film", {"casadi", "matplotlib", "scipy"}), ("arm", {"matplotlib", "scipy"})]
)
def test_a_view_loads_what_it_needs(kind: str, unneeded: set[str], trajectory: Path, tmp_path: Path) -> None:
    source = str(trajectory) if kind == "film" else "drawing_arm"
    command = [sys.executable, "-c", LOADED, kind, source, str(tmp_path / "view.json")]
    code, loaded = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    assert code == 0 and json.loads((tmp_path / "view.json").read_text())
    assert not unneeded & set(loaded)
