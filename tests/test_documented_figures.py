"""Figures in the prose that are constants of the code are those of the code."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from planner.arms import file_section
from planner.arms.arm_file import known_arms, load_arm
from planner.inverse_kinematics import dls, guesses, nlp
from planner.redundancy import cost
from planner.settings import MIN_RATE_HZ, PlanSettings
from planner.workspace.canvas import usable_canvas
from tests.arms.chains import model_of

_DOCS = Path(__file__).resolve().parent.parent / "docs"

_FIGURES = [
    ("mathematics.md", r"less (\S+) % of each range", 100 * nlp._ROOM),
    ("mathematics.md", r"up to (\d+) other configurations", guesses._GUESSES),
    ("mathematics.md", r"error is below (\S+) mm along the paper", dls.DOCUMENTED.tolerance_xy_mm),
    ("mathematics.md", r"and (\S+) mm across it", dls.DOCUMENTED.tolerance_z_mm),
    ("mathematics.md", r"\$\\lambda\^2 = (\d+)\$ weighs", dls.DOCUMENTED.lambda_squared),
    ("mathematics.md", r"For drawing, the tolerance is (\S+) mm", dls.FOR_DRAWING.tolerance_xy_mm),
    ("mathematics.md", r"where a radian counts as (\d+) cm", dls._LEVER_CM),
    ("arms.md", r"lengths together are (\d+) m", file_section.LONGEST_MM / 1000),
    ("commands.md", r"time counts for a (twentieth) of", cost._LEAST_TIME),
    ("commands.md", r"--tolerance LENGTH` .*?\| ([\d.]+) mm", PlanSettings().tolerance_mm),
    ("commands.md", r"--rate HZ` \| samples per second, (\d+) or more", MIN_RATE_HZ),
]

_WORDS = {"twentieth": 1 / 20}


@pytest.mark.parametrize(("page", "phrase", "value"), _FIGURES)
def test_a_figure_in_the_prose_is_that_of_the_code(page: str, phrase: str, value: float) -> None:
    text = re.sub(r"\s+", " ", (_DOCS / page).read_text(encoding="utf-8"))
    found = re.findall(phrase, text)
    assert len(found) == 1, f"{page} says {found} where it should say one figure"
    figure = _WORDS[found[0]] if found[0] in _WORDS else float(found[0])
    assert figure == pytest.approx(value)


def test_messages_that_are_looked_up_are_said_by_the_code() -> None:
    page = (_DOCS / "troubleshooting.md").read_text(encoding="utf-8")
    rows = page[page.index("## Before there is a line") :].splitlines()
    messages = re.findall(r"^\| `([^`]+)` \|", "\n".join(rows), re.MULTILINE)
    assert len(messages) >= 6
    sources = [path for name in ("planner", "hardware") for path in (_DOCS.parent / name).rglob("*.py")]
    code = re.sub(r'"\s*f?"|\s+', " ", " ".join(path.read_text(encoding="utf-8") for path in sources))
    for message in messages:
        for part in message.split(" ... "):
            assert part in code, part


@pytest.mark.parametrize("name", known_arms())
def test_the_table_of_arms_tells_their_canvases(name: str) -> None:
    arm = load_arm(name)
    canvas = usable_canvas(model_of(arm), arm.pen.lift_mm)
    row = next(
        line
        for line in (_DOCS / "arms.md").read_text(encoding="utf-8").splitlines()
        if line.startswith(f"| `{name}` |")
    )
    assert f"| {canvas.width_mm:.0f} × {canvas.height_mm:.0f} |" in row
