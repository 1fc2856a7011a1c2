"""The bar of a plan: it moves from the first moment on, through every stage, and never back."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from planner.pipeline import plan
from planner.progress import STAGES, of_all_stages
from planner.settings import PlanSettings
from tests.drawn_shapes import lines_svg


def test_the_bar_goes_through_all_stages_and_never_back(tmp_path: Path) -> None:
    drawing = tmp_path / "drawing.svg"
    drawing.write_text(lines_svg('<path d="M2 2 5 4M7 7l1 0"/>', 'viewBox="0 0 9 9"'))
    told: list[tuple[str, int, int]] = []
    plan(drawing, PlanSettings(), lambda *now: told.append(now))
    stages = list(dict.fromkeys(stage for stage, _, _ in told))
    assert stages == [stage for stage in STAGES if stage not in {"writing", "report"}]
    assert len([stage for stage, _, _ in told if stage == "reading"]) > 3
    shares = [done / total for done, total in (of_all_stages(*now) for now in told)]
    assert shares[0] == 0.0 and all(before <= after for before, after in pairwise(shares))
    for last in ("travels", "writing", "report"):
        done, total = of_all_stages(last, 1, 1, last)
        assert done == total
