"""The extension for Inkscape: its parameters are options of plan, and Inkscape saves a document as a trajectory."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from planner.cli import main
from planner.cli.plan import plan_parser
from planner.cli.plan_options import settings_of
from planner.drawing.source import SvgInMemory
from planner.inkscape.drawing_arm import name_of, options_of
from planner.inkscape.installing import EXTENSION_ID, extension_folder, install
from planner.pipeline import plan
from planner.progress import unreported
from planner.settings import PlanSettings
from planner.trajectory import read_trajectory

SVG = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 60" width="100mm" height="60mm" fill="none"
 stroke="red" xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd" sodipodi:docname="boat.svg"
 xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape">
<g inkscape:groupmode="layer" inkscape:label="1 sky"><path d="M10 10H40"/></g>
<g inkscape:groupmode="layer" inkscape:label="2 sea"><path d="M10 40C30 10 60 60 90 30"/></g></svg>"""
INX = ElementTree.parse(Path(sys.modules["planner"].__file__ or "").with_name("inkscape") / "drawing_arm.inx")
SPACE = "{http://www.inkscape.org/namespace/inkscape/extension}"


@pytest.fixture
def document(tmp_path: Path) -> Path:
    path = tmp_path / "ink_ext_XX1234.svg"
    path.write_text(SVG, encoding="utf-8")
    return path


def parameters() -> dict[str, list[str]]:
    """Every parameter that Inkscape asks for, with values that it may have, the usual one first."""
    found = {}
    for param in INX.iter(f"{SPACE}param"):
        match param.get("type"):
            case "bool":
                values = [param.text or "", "true"]
            case "optiongroup":
                values = [option.get("value", "") for option in param.iter(f"{SPACE}option")]
            case "notebook":
                values = [page.get("name", "") for page in param.iter(f"{SPACE}page")]
            case _:
                values = [(param.text or "").strip()]
        found[param.get("name", "")] = values
    return found


def test_parameters_are_options_of_plan_and_the_usual_ones_change_nothing() -> None:
    def settings(**told: str) -> PlanSettings:
        usual = {name: values[0] for name, values in parameters().items()}
        options = options_of([f"--{name}={value}" for name, value in {**usual, **told}.items()])
        return settings_of(plan_parser().parse_args(["d.svg", *options]))

    assert settings() == replace(PlanSettings(), rate_hz=50.0)  # that of the arm's servos
    for name, values in parameters().items():
        for value in values[1:] if name != "tab" else ():
            paper = {"paper": "a5"} if name == "orientation" else {}
            assert settings(**{name: value}, **paper) != settings(**paper), (name, value)
    asked = settings(speed="4cm/s", layers="2 sea,1", more="--passes 3 --layers 'my sky'", lift="6mm", paper="a5")
    assert (asked.speed_mm_s, asked.lift_mm, asked.passes, asked.layers) == (40.0, 6.0, 3, ("my sky",))


def test_a_document_is_called_as_in_inkscape(document: Path) -> None:
    assert name_of(document) == "boat.svg"
    for text in ("", "<svg", "<svg/>", SVG.replace("boat.svg", "../../boat.svg").replace("boat", "a b/ü")):
        document.write_text(text, encoding="utf-8")
        assert name_of(document) in (document.name, "ü.svg")


def as_inkscape_runs_it(script: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    surroundings = {**os.environ, "PYTHONPATH": str(script.parent)}  # as for extensions
    command = [sys.executable, str(script), *arguments]
    return subprocess.run(command, cwd=script.parent, env=surroundings, capture_output=True, text=True, check=False)


def test_the_script_hands_the_document_to_the_planner_that_installed_it(document: Path, tmp_path: Path) -> None:
    assert main(["inkscape", "--folder", str(tmp_path / "new" / "extensions")]) == 0
    script = tmp_path / "new" / "extensions" / "drawing_arm.py"
    done = as_inkscape_runs_it(script, "--arm=scara", "--mirror=true", "--paper=", "--more=", str(document))
    assert done.returncode == 0, done.stderr
    (tmp_path / "t.csv").write_text(done.stdout, encoding="utf-8")
    saved = read_trajectory(tmp_path / "t.csv")
    same = plan(SvgInMemory("boat.svg", SVG.encode()), PlanSettings(arm="scara", mirror=True), unreported)
    assert saved.head == same.trajectory.head
    assert "2 strokes" in done.stderr

    for wrong, why in (("--arm=nobody", "nobody"), ("--paper=huge", "huge"), ("--more='", "other options")):
        done = as_inkscape_runs_it(script, wrong, str(document))
        assert done.returncode == 2 and not done.stdout and why in done.stderr and "Traceback" not in done.stderr
    told = script.with_suffix(".json")
    told.write_text(json.dumps({"python": str(tmp_path / "gone"), "packages": "."}))
    done = as_inkscape_runs_it(script, str(document))
    assert done.returncode == 2 and "run 'plan inkscape' again" in done.stderr


def test_where_it_cannot_be_installed_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    assert main(["inkscape", "--folder", str(tmp_path / "file")]) == 2
    assert "file" in capsys.readouterr().err


def test_inkscape_saves_a_document_as_a_trajectory(
    document: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if shutil.which("inkscape") is None and not os.environ.get("CI"):
        pytest.skip("inkscape is not installed")
    monkeypatch.setenv("INKSCAPE_PROFILE_DIR", str(tmp_path / "profile"))
    folder = extension_folder()
    assert folder == tmp_path / "profile" / "extensions"
    install(folder)
    asked = {"arm": "scara", "paper": "a6", "align": "top-left", "by": "layer", "margin": "8", "more": "--passes 2"}
    known = " ".join(f'{EXTENSION_ID}.{name}="{value}"' for name, value in asked.items())
    (folder.parent / "preferences.xml").write_text(
        f'<inkscape version="1"><group id="extensions" {known}/></inkscape>', encoding="utf-8"
    )
    boat = document.rename(tmp_path / "boat.svg")
    command = ["inkscape", str(boat), f"--export-extension={EXTENSION_ID}", f"--export-filename={tmp_path / 't.csv'}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    saved = read_trajectory(tmp_path / "t.csv")
    options = options_of([f"--{name}={value}" for name, value in asked.items()])
    assert main([str(boat), "-o", str(tmp_path / "u.csv"), "--quiet", *options]) == 0
    assert saved.head == read_trajectory(tmp_path / "u.csv").head
    assert main(["check", str(tmp_path / "t.csv"), "--drawing", str(boat)]) == 0
