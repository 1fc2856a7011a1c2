"""A small computer beside the arm has neither solver nor pictures: what plays a trajectory does without them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from planner.trajectory import write_trajectory
from tests.hardware.conftest import ArcMaker

ROOT = Path(__file__).parents[2]
BLOCKED = ("casadi", "imageio", "matplotlib", "mujoco", "ruckig", "scipy", "shapely", "svgelements", "tinycss2")
_WITHOUT = f"import sys; sys.modules.update(dict.fromkeys({BLOCKED!r})); "  # None: an import of it fails


def _python(script: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", _WITHOUT + script, *arguments], cwd=ROOT, capture_output=True, text=True
    )


def test_every_module_of_the_hardware_side_is_imported_without_them() -> None:
    names = sorted(
        ".".join(path.with_suffix("").relative_to(ROOT).parts)
        for path in (ROOT / "hardware").rglob("*.py")
        if path.name != "__init__.py"
    )
    assert "hardware.playback.preflight" in names
    done = _python("import importlib; [importlib.import_module(name) for name in sys.argv[1:]]", *names)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_trajectory_is_examined_without_them(tmp_path: Path, arc: ArcMaker) -> None:
    path = tmp_path / "arc.csv"
    write_trajectory(arc(1.0), path)
    done = _python("from planner.cli import main; sys.exit(main(sys.argv[1:]))", "run", str(path), "--dry-run")
    assert (done.returncode, done.stderr) == (0, "")
    assert "can be played" in done.stdout
