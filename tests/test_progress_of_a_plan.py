"""The bar of a plan: it moves from the first moment on, through every stage, and never back."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from planner.counted import clock, whole_clock
from planner.pipeline import plan
from planner.progress import STAGES, left, of_all_stages, pace
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


@given(st.integers(4, 99), st.integers(1, 10**5))
def test_the_time_left_goes_on_at_the_pace_so_far(percent: int, whole_s: int) -> None:
    elapsed_s = whole_s * percent / 100
    assert pace(elapsed_s, percent, 100) == f"{whole_clock(elapsed_s)}, about {left(whole_s - elapsed_s)}"


def test_no_pace_is_made_up() -> None:
    assert pace(7.0, 0, 100) == pace(7.0, 100, 100) == pace(7.0, 0, 0) == "7 s"


@given(st.floats(0, 10**7))
def test_durations_carry_over(seconds: float) -> None:
    for words in (clock(seconds), whole_clock(seconds)):
        numbers, units = words.split()[::2], words.split()[1::2]
        assert all(float(number) < 60 for number, unit in zip(numbers, units, strict=True) if unit != "h")
        told_s = sum(
            float(number) * {"h": 3600, "min": 60, "s": 1}[unit] for number, unit in zip(numbers, units, strict=True)
        )
        assert abs(told_s - seconds) <= {"h": 30.5, "min": 0.5, "s": 0.5}[units[0]]
