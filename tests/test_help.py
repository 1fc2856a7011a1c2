"""The examples in every command's `--help` are accepted as they stand there."""

from __future__ import annotations

import re
import shlex
import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest

import planner.pipeline
from planner.cli import main
from planner.drawing.source import SvgInMemory
from planner.pipeline import Plan, plan
from planner.progress import unreported
from planner.settings import PlanSettings
from tests.drawn_shapes import lines_svg

ROOT = Path(__file__).resolve().parent.parent
COMMANDS = (
    *("", "batch", "lines", "run", "pattern", "calibrate", "predict", "jog", "measure"),
    *("ports", "check", "plot", "compare", "fonts", "arm", "paper", "estimate", "config", "serve", "export", "step"),
    "identify",
)
NOT_RUN = {
    "|": "a pipe of the shell",
    "--port": "it needs an arm",
    "mujoco": "it needs graphics",
    "tcp://": "it needs a cluster",
    "lerobot": "it needs a file of another program",
    "pattern": "it takes long, and pages of the documentation run it",
    "serve": "it ends when somebody ends it",
    "measure": "it takes a photo, and pages of the documentation run it",
    "identify": "it takes what was recorded, and its own tests run it",
    "calibrate": "it takes records, and pages of the documentation run it",
    "--random": "it takes long",
    "--json flower.json": "it takes long",
    "--report": "it takes long, and has a test of its own",
    "--font": "it takes a font",
}
SVG = lines_svg('<path id="a" d="M2 2 5 4M7 7l1 0M1 1 8 1M3 3 8 3"/>', 'viewBox="0 0 9 9"')


URDF = (
    '<robot name="r"><link name="base_link"/><link name="tool0"/><joint name="j" type="continuous">'
    '<parent link="base_link"/><child link="tool0"/><axis xyz="0 0 1"/></joint></robot>'
)


@dataclass(frozen=True)
class Example:
    command: str
    words: str


def _examples() -> list[Example]:
    found = []
    for command in COMMANDS:
        text = (ROOT / "planner" / "cli" / f"{_module(command)}.py").read_text(encoding="utf-8")
        for block in re.findall(r"^examples:\n((?:  .*\n?)+)", text, re.MULTILINE):
            found += [
                Example(command, re.split(r" {2,}", line.strip().removesuffix('"""'))[0]) for line in block.splitlines()
            ]
    return found


def _module(command: str) -> str:
    return {"": "plan", "estimate": "batch", "run": "run_options"}.get(command, command)


def _can_run(example: Example) -> bool:
    return not any(hindrance in example.words for hindrance in NOT_RUN)


@pytest.fixture(scope="module")
def made() -> Plan:
    return plan(SvgInMemory("flower.svg", SVG.encode()), PlanSettings(), unreported)


def test_every_command_has_examples() -> None:
    with_examples = {example.command for example in _examples()}
    assert set(COMMANDS) - with_examples <= {"ports"}


def test_examples_are_accepted(made: Plan, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is planned is a plan that is there already: options are read, files written, and pictures drawn."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(planner.pipeline, "plan", lambda *_, **__: made)
    monkeypatch.setattr("planner.tiled_plan.planned", lambda *_, **__: made)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "preferences"))
    (tmp_path / "plan.toml").write_text('[presets.fast]\nspeed = "8cm/s"\n')
    for name in ("flower", "city", "letter", "stamp", "poster", "map", "logo", "drawings/one"):
        (tmp_path / f"{name}.svg").parent.mkdir(exist_ok=True)
        (tmp_path / f"{name}.svg").write_text(SVG)
    for name in ("my_arm", "my_arm_2"):
        shutil.copy(ROOT / "configs" / "drawing_arm.toml", tmp_path / f"{name}.toml")
    (tmp_path / "robot.urdf").write_text(URDF)
    (tmp_path / "pens.toml").write_text('[[pen]]\nname = "blue"\n')
    (tmp_path / "moves.txt").write_text("show\nquit\n")
    made.trajectory.save(tmp_path / "traj.csv")
    examples = [example.words for example in _examples() if _can_run(example)]
    assert len(examples) > 40
    for words in dict.fromkeys(examples):
        command, *arguments = shlex.split(words)
        assert command == "plan"
        extra = ["--fast"] if arguments[0] == "run" and "--fast" not in arguments else []
        assert main([*arguments, *extra]) == 0, words
