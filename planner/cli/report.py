"""`--report DIR` of a plan: the page about it."""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from planner.cli.output import check_folder_target
from planner.counted import clock
from planner.errors import OutputError, PlannerError
from planner.settings import PlanSettings

if TYPE_CHECKING:
    from planner.arms.arm import Arm
    from planner.error_model.prediction import Prediction
    from planner.pipeline import Plan
    from planner.trajectory import Trajectory

_PAGE = "index.html"
_CHECKED, _FORETOLD = 15, 30
"""Of a hundred parts of the work, when these are done."""
_FORETOLD_S = 300.0
"""Of a trajectory: a prediction plays it many times, which of a long one takes minutes."""


def check_report(folder: Path, drawing: Path, target: Path) -> None:
    """Errors: OutputError where the page cannot be written, or would replace the drawing or the trajectory."""
    check_folder_target(folder, _PAGE, drawing)
    if os.path.realpath(folder / _PAGE) == os.path.realpath(target):
        raise OutputError(str(target), "the report goes there")


def write_report_of(
    planned: Plan,
    settings: PlanSettings,
    arguments: Sequence[str],
    folder: Path,
    report: Callable[[int, int], None],
) -> Path:
    """Judge the plan and write the page about it; the page. report: is told how far that has come.
    Errors: OutputError."""
    report(0, 100)
    from planner.arms.arm_file import load_arm
    from planner.checking.check import check_trajectory
    from planner.redundancy.arm_model import ArmModel
    from planner.report.report import Planned, write_report
    from planner.workspace.reach import paper_in_reach

    model = ArmModel(load_arm(settings.arm, cache=settings.cache), cache=settings.cache)
    check_result = check_trajectory(planned.trajectory, model.arm, planned.drawing, settings.tolerance_mm)
    report(_CHECKED, 100)
    expected, accuracy = _expected(model.arm, planned.trajectory)
    report(_FORETOLD, 100)
    page = folder / _PAGE
    told = Planned(
        shlex.join(("plan", *arguments)),
        settings,
        planned.summary,
        planned.trajectory,
        model,
        planned.drawing,
        check_result,
        paper_in_reach(model).ring_mm,
        expected,
        accuracy,
    )
    write_report(told, page, lambda done, total: report(_FORETOLD + (100 - _FORETOLD) * done // total, 100))
    return page


def _expected(arm: Arm, trajectory: Trajectory) -> tuple[Prediction | None, str]:
    """How well the arm is going to draw, by as much of the trajectory as is foretold in seconds, and that in words."""
    from planner.cli.predict import prediction_of

    part = trajectory.opening(round(_FORETOLD_S * trajectory.rate_hz))
    try:
        expected = prediction_of(arm, part, Path(trajectory.drawing), seed=0)
    except PlannerError as error:
        return None, f"nobody can say: {error}"
    by = f" (told by its first {clock(part.duration_s)})" if part is not trajectory else ""
    cure = f"; {expected.causes[0].text()}" if expected.causes else ""
    return expected, f"{expected.summary()}{by}{cure}"
