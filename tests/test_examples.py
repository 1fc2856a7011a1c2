"""The numbered scripts and the recipes of `docs/python.md` are run as they stand, and what they write has to come of
it."""

from __future__ import annotations

import re
import runpy
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from planner import check

ROOT = Path(__file__).resolve().parent.parent
SCRIPTS = sorted((ROOT / "examples").glob("[0-9]*.py"))
PAGE = ROOT / "docs/python.md"
_RECIPE = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_WRITTEN = re.compile(r'"([\w-]+\.(?:csv|png|svg|pdf|gif|html))"')
"""A file name in a call, which a script or a recipe writes or has written before."""


def assert_is_what_its_name_says(file: Path) -> None:
    match file.suffix:
        case ".png" | ".gif":
            with Image.open(file) as picture:
                shades = np.asarray(picture.convert("L"))
            assert np.ptp(shades) > 100 and min(shades.shape) > 300, f"{file.name} shows nothing"
        case ".csv":
            assert check(file).passed, file.name
        case _:
            assert file.stat().st_size > 1000, file.name


def test_scripts_are_numbered_without_a_gap() -> None:
    assert [int(script.name[:2]) for script in SCRIPTS] == list(range(1, len(SCRIPTS) + 1))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.stem)
def test_a_script_runs_and_makes_a_picture(script: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(script), run_name="__main__")
    named = set(_WRITTEN.findall(script.read_text(encoding="utf-8")))
    written = {file.name for file in tmp_path.iterdir()}
    assert any(name.endswith((".png", ".gif")) for name in written)
    assert {name for name in named if not (script.parent / name).exists()} <= written
    for name in written:
        assert_is_what_its_name_says(tmp_path / name)


def test_recipes_are_of_five_lines_and_run_from_top_to_bottom(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for drawing in (ROOT / "examples").glob("*.svg"):
        shutil.copy(drawing, tmp_path)
    monkeypatch.chdir(tmp_path)
    recipes = _RECIPE.findall(PAGE.read_text(encoding="utf-8"))
    assert len(recipes) >= 8
    names: dict[str, object] = {}
    for recipe in recipes:
        lines = [line for line in recipe.splitlines() if line.strip()]
        assert len(lines) <= 5, recipe
        exec(compile(recipe, str(PAGE), "exec"), names)
        for name in _WRITTEN.findall(recipe):
            if (tmp_path / name).suffix != ".svg":
                assert_is_what_its_name_says(tmp_path / name)


def test_the_page_names_every_stable_name() -> None:
    import planner

    text = PAGE.read_text(encoding="utf-8") + (ROOT / "docs/api.md").read_text(encoding="utf-8")
    assert [name for name in planner.__all__ if not re.search(rf"\b{name}\b", text)] == []
