"""The independent check of a trajectory: nothing of the planner's own mathematics takes part in it."""

from __future__ import annotations

from planner.arms.arm import Arm
from planner.checking.between import Interpolation, points_per_step, sweep
from planner.checking.check_result import CheckResult
from planner.checking.coverage import drawing_findings
from planner.checking.joints import columns, couplings, position_limits, rate_limits, rest_at_the_ends
from planner.checking.mapping import map_findings, within_the_canvas
from planner.checking.pen import (
    above_the_paper,
    lift_notes,
    links_apart,
    on_the_paper,
    pen_as_the_tip,
    servo_notes,
    straight_up_and_down,
    stroke_order,
    upright,
)
from planner.drawing.drawing import Drawing
from planner.trajectory import PATTERN, Trajectory

FELT_MM = 4.5
"""How deep below the paper a calibration pattern may feel for it."""


def check_trajectory(
    trajectory: Trajectory, arm: Arm, drawing: Drawing | None = None, tolerance_mm: float = 0.05
) -> CheckResult:
    """Hold a trajectory against everything that one promises, at the samples and between them.

    Between samples the joints are taken both as straight lines and as cubics; the worse of the two counts.
    tolerance_mm: for the pen path against the drawing, the tip's height on the paper, depth below it, and
    sideways drift while it is lifted or lowered. Without a drawing, the pen path is not compared.
    """
    fitting = columns(trajectory, arm)
    if not fitting.passed:
        return CheckResult((fitting,))
    per_step = points_per_step(trajectory.rate_hz)
    sweeps = [sweep(trajectory, arm, interpolation, per_step) for interpolation in Interpolation]
    feels = trajectory.method == PATTERN  # for the paper: its marks are pressed into it, on purpose
    findings = [
        fitting,
        *rest_at_the_ends(trajectory, arm),
        *position_limits(trajectory, arm),
        *rate_limits(trajectory, arm),
        *couplings(trajectory, arm),
        *stroke_order(trajectory),
        *on_the_paper(trajectory, sweeps, tolerance_mm, FELT_MM if feels else 0.0),
        *([] if feels else pen_as_the_tip(trajectory, arm, sweeps[0])),
        *upright(trajectory, arm, sweeps),
        *above_the_paper(trajectory, sweeps, FELT_MM if feels else tolerance_mm),
        *links_apart(trajectory, sweeps, tolerance_mm),
        *([] if feels else straight_up_and_down(trajectory, sweeps, arm.pen.clearance_mm, tolerance_mm)),
        *lift_notes(trajectory, arm, sweeps[0], tolerance_mm),
        *servo_notes(trajectory, arm, sweeps[0], tolerance_mm),
    ]
    findings += within_the_canvas(trajectory, sweeps[0], tolerance_mm)
    findings += (
        map_findings(trajectory, None, tolerance_mm)
        if drawing is None
        else drawing_findings(trajectory, drawing, sweeps, tolerance_mm)
    )
    return CheckResult(tuple(findings))
