"""Whatever rate, tolerance, method and arm are asked for: what is planned passes the check with the same tolerance."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from planner.arms.arm_file import known_arms
from planner.checking.check import check_trajectory
from planner.drawing.svg import read_drawing
from planner.errors import PlanError, UsageError
from planner.pipeline import plan
from planner.settings import Method, PlanSettings
from tests.arms.chains import load_once
from tests.drawn_shapes import drawings_made, ellipse, polyline, svg_of, tap

LINE = [polyline((0, 0), (16, 0))]
SOME = [
    polyline((10, 10), (90, 12), (20, 60)),
    ellipse(70, 70, 8, 3),
    ellipse(20, 80, 0.4, 0.4),
    tap(50, 50),
    tap(50.4, 50),
]


def assert_agreed(folder: Path, svg: str, wanted: PlanSettings) -> None:
    file = folder / "drawing.svg"
    file.write_text(svg, encoding="utf-8")
    planned = plan(file, wanted, lambda *_: None)
    check_result = check_trajectory(planned.trajectory, load_once(wanted.arm), read_drawing(file), wanted.tolerance_mm)
    assert check_result.passed, check_result.text()


@pytest.mark.parametrize(
    ("rate_hz", "tolerance_mm", "method"),
    [
        (50.0, 0.01, Method.PATH),
        (50.0, 0.005, Method.PATH),
        (51.0, 0.02, Method.NLP),
        (75.0, 0.01, Method.DLS),
        (200.0, 0.005, Method.CLOSED_FORM),
    ],
)
@pytest.mark.parametrize("shapes", [LINE, SOME], ids=["line", "some"])
def test_rare_samples_and_narrow_tolerances_agree(
    tmp_path: Path, rate_hz: float, tolerance_mm: float, method: Method, shapes: list
) -> None:  # type: ignore[type-arg]
    assert_agreed(tmp_path, svg_of(shapes), PlanSettings(rate_hz=rate_hz, tolerance_mm=tolerance_mm, method=method))


@settings(deadline=None, max_examples=6, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    drawings_made,
    st.floats(50.0, 500.0),
    st.floats(0.01, 0.1),
    st.sampled_from(list(Method)),
    st.sampled_from(known_arms()),
)
def test_plan_and_check_agree(
    tmp_path: Path,
    shapes: list,
    rate_hz: float,
    tolerance_mm: float,  # type: ignore[type-arg]
    method: Method,
    arm: str,
) -> None:
    wanted = PlanSettings(arm=arm, method=method, rate_hz=rate_hz, tolerance_mm=tolerance_mm)
    with suppress(PlanError, UsageError):  # a method or an arm may be unable: that is said
        assert_agreed(tmp_path, svg_of(shapes), wanted)


@pytest.mark.parametrize(
    ("changed", "named"),
    [
        ({"lowering_speed_mm_s": 1e-6}, "--lowering-speed"),
        ({"speed_mm_s": 1e-6}, "--speed"),
        ({"dwell_s": 1e9}, "--dwell"),
    ],
)
def test_what_would_never_end_is_refused_with_what_to_change(
    tmp_path: Path, changed: dict[str, float], named: str
) -> None:
    with pytest.raises(UsageError, match=named):
        assert_agreed(tmp_path, svg_of(LINE), PlanSettings(**changed))  # type: ignore[arg-type]
