"""benchmarks/stages.py finds the stages that it names."""

from __future__ import annotations

from pathlib import Path

from benchmarks.stages import STAGES, stages_of
from planner.settings import PlanSettings

TWO_LINES = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="40">'
    '<path stroke="black" d="M5 5 30 8M8 30 30 28"/></svg>'
)


def test_every_stage_takes_its_share(tmp_path: Path) -> None:
    (tmp_path / "lines.svg").write_text(TWO_LINES)
    spent = stages_of(tmp_path / "lines.svg", PlanSettings(arm="drawing_arm"))
    assert set(spent) == {*STAGES, "whole"}
    assert all(0.0 < seconds <= spent["whole"] for seconds in spent.values())
