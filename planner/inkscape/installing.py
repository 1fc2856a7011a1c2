"""The extension for Inkscape: where Inkscape looks for it, and how it finds this planner again."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from importlib.resources import files
from pathlib import Path
from typing import IO, cast

import platformdirs

from planner.errors import OutputError
from planner.files import written_aside

EXTENSION_ID = "org.drawing_arm_planner.trajectory"
_FILES = ("drawing_arm.inx", "drawing_arm.py")
_TOLD = "drawing_arm.json"
_MACOS = "Library/Application Support/org.inkscape.Inkscape/config/inkscape"
_ANSWERS_WITHIN_S = 60.0


def extension_folder() -> Path:
    """Where Inkscape looks for the extensions of this user: as it says itself, or by the platform's rule where it is
    not on the path."""
    program = shutil.which("inkscape")
    if program is not None:
        try:
            asked = [program, "--user-data-directory"]
            done = subprocess.run(asked, capture_output=True, text=True, timeout=_ANSWERS_WITHIN_S, check=True)
        except (OSError, subprocess.SubprocessError):
            pass  # it is there and does not work: the usual place is as good a guess as any
        else:
            if lines := done.stdout.split("\n"):
                return Path(lines[0]) / "extensions"
    elsewhere = platformdirs.user_config_path("inkscape", appauthor=False, roaming=True)
    return (Path.home() / _MACOS if sys.platform == "darwin" else elsewhere) / "extensions"


def install(folder: Path) -> list[Path]:
    """Put the extension there; the files that it consists of. Errors: OutputError."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(str(folder), error.strerror or str(error)) from error
    texts = {name: files(__package__).joinpath(name).read_text(encoding="utf-8") for name in _FILES}
    packages = Path(__file__).resolve().parents[2]
    texts[_TOLD] = json.dumps({"python": sys.executable, "packages": str(packages)}, indent=1) + "\n"
    for name, text in texts.items():
        with written_aside(folder / name) as file:
            cast("IO[str]", file).write(text)
    return [folder / name for name in texts]
