"""`--report DIR` of a plan: the page about it."""

from __future__ import annotations

import os
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from planner.cli.output import check_folder_target
from planner.errors import OutputError
from planner.settings import PlanSettings

if TYPE_CHECKING:
    from planner.pipeline import Plan

_PAGE = "index.html"


def check_report(folder: Path, drawing: Path, target: Path) -> None:
    """Errors: OutputError where the page cannot be written, or would replace the drawing or the trajectory."""
    check_folder_target(folder, _PAGE, drawing)
    if os.path.realpath(folder / _PAGE) == os.path.realpath(target):
        raise OutputError(str(target), "the report goes there")


def write_report_of(planned: Plan, settings: PlanSettings, arguments: Sequence[str], folder: Path) -> Path:
    """Judge the plan and write the page about it; the page. Errors: OutputError."""
    from planner.arms.arm_file import load_arm
    from planner.checking.check import check_trajectory
    from planner.redundancy.arm_model import ArmModel
    from planner.report.report import Planned, write_report
    from planner.workspace.reach import paper_in_reach

    model = ArmModel(load_arm(settings.arm))
    check_result = check_trajectory(planned.trajectory, model.arm, planned.drawing, settings.tolerance_mm)
    page = folder / _PAGE
    write_report(
        Planned(
            shlex.join(("plan", *arguments)),
            settings,
            planned.summary,
            planned.trajectory,
            model,
            planned.drawing,
            check_result,
            paper_in_reach(model).reach_mm,
        ),
        page,
    )
    return page
