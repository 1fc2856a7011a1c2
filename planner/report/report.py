"""The page about a plan, which holds all that it shows and asks nothing of any network."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from planner.arrays import FloatArray
from planner.checking.chain import chain_poses
from planner.checking.check_result import CheckResult
from planner.counted import clock
from planner.drawing.drawing import Drawing
from planner.error_model.prediction import Prediction
from planner.motion.speed_limit import pen_speed_mm_s
from planner.plots.motion import motion_of
from planner.redundancy.arm_model import ArmModel
from planner.report.film import film
from planner.report.markup import Markup, Section, clean, element, joined, table
from planner.report.opening import account_facts, contents, figure, opening
from planner.report.page import page, write_page
from planner.report.pictures import expected_picture, pictures, sheet_picture
from planner.report.tables import check, joints, making, strokes
from planner.settings import PlanSettings
from planner.stroke_figures import stroke_figures
from planner.summary import PlanSummary
from planner.trajectory import Trajectory
from planner.workspace.canvas import canvas_of

_N_SECTIONS = 14


@dataclass(frozen=True, eq=False, slots=True)
class Planned:
    """All that the page tells of. command: what was typed. reach_mm: inner and outer radius of what the pen reaches on
    the paper. expected: how well the arm is going to draw, None where nobody can say; accuracy: the same in words."""

    command: str
    settings: PlanSettings
    summary: PlanSummary
    trajectory: Trajectory
    model: ArmModel
    drawing: Drawing
    check_result: CheckResult
    reach_mm: tuple[float, float] | None
    expected: Prediction | None
    accuracy: str


def write_report(planned: Planned, target: Path, report: Callable[[int, int], None] = lambda done, total: None) -> None:
    """Write the page, whole or not at all, in the place of one that is there; folders that are missing are made.
    report: is told how many of its sections are done. Errors: OutputError."""
    write_page(report_page(planned, report), target)


def report_page(planned: Planned, report: Callable[[int, int], None] = lambda done, total: None) -> Markup:
    """The page as text, the same for the same plan."""
    trajectory, arm = planned.trajectory, planned.model.arm
    tip_mm = chain_poses(arm, arm.from_file_units(trajectory.positions), trajectory.pen_heights_mm).tip_mm.T
    canvas_mm = canvas_of(planned.model, planned.settings.canvas, arm.pen.lift_mm).corners_arm_mm
    frame, script = film(motion_of(trajectory, arm, tip_mm), canvas_mm, planned.reach_mm)
    sections: list[Section] = []
    for one in _sections(planned, tip_mm, frame):
        sections.append(one)
        report(min(len(sections), _N_SECTIONS), _N_SECTIONS)
    heading = clean(trajectory.title)
    return page(
        f"{heading} on {arm.name}",
        element("h1", heading),
        element("p", f"on {arm.name}, by method {trajectory.method}", class_="quiet"),
        opening(sheet_picture(trajectory, tip_mm), planned.summary, trajectory, planned.check_result, planned.accuracy),
        contents(sections),
        *(one.markup() for one in sections),
        script=script,
    )


def _sections(planned: Planned, tip_mm: FloatArray, frame: Markup) -> Iterator[Section]:
    """All that stands behind headings, in its order."""
    summary, trajectory, model, settings = planned.summary, planned.trajectory, planned.model, planned.settings
    warnings = summary.warnings
    yield Section(
        "warnings",
        f"Warnings ({len(warnings)})" if warnings else "Warnings",
        element("ul", *(element("li", warning) for warning in warnings), class_="warnings")
        if warnings
        else element("p", "None.", class_="quiet"),
    )
    yield Section("film", "Film", frame)
    yield Section("figures", "In figures", joined((account_facts(summary), _phases(summary))))
    if planned.expected is not None:
        picture = expected_picture(planned.expected, trajectory.title)
        yield Section(picture.name, picture.heading, figure(picture))
    for picture in pictures(trajectory, summary, model, planned.drawing, tip_mm, planned.reach_mm, settings):
        yield Section(picture.name, picture.heading, figure(picture))
    yield Section("joints", "Joints and their limits", joints(trajectory, model.arm))
    speed_mm_s = pen_speed_mm_s(model.arm, settings)
    yield Section("strokes", "Strokes", strokes(stroke_figures(trajectory, tip_mm), speed_mm_s))
    yield Section("check", "Check", check(planned.check_result))
    yield Section("making", "How it was made", making(planned.command, settings, model.arm, trajectory))


def _phases(summary: PlanSummary) -> Markup:
    return table(
        ("phase", "time", "share"),
        [(name, clock(seconds), f"{100 * share:.0f} %") for name, seconds, share in summary.phases.shares()],
    )
