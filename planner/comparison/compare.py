"""The same targets by every method."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from planner.arms.arm import Arm, PenHold
from planner.arrays import BoolArray, FloatArray
from planner.comparison.convergence import Convergence, convergence
from planner.comparison.drawing_time import StrokeTimes, stroke_times
from planner.comparison.figures import Figures, figures_of
from planner.comparison.measured import Measured, measure
from planner.comparison.methods import METHODS, ComparedMethod
from planner.comparison.targets import TargetKind, Targets
from planner.comparison.worked_example import documented_start
from planner.errors import PlanError, PlannerError, TargetBeyondReach
from planner.inverse_kinematics.dls import FOR_DRAWING
from planner.inverse_kinematics.references import home_of
from planner.progress import Report
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings, Timing


@dataclass(frozen=True, slots=True)
class Failures:
    """Targets, or strokes, that a method fails on for the same reason, and where the first of them is."""

    what: str
    count: int
    reason: str
    first_mm: tuple[float, ...]


@dataclass(frozen=True, eq=False, slots=True)
class MethodResult:
    """refusal: why the arm has no such method; then nothing is measured."""

    method: ComparedMethod
    figures: Figures
    measured: Measured | None
    failures: tuple[Failures, ...] = ()
    refusal: str | None = None


@dataclass(frozen=True, eq=False, slots=True)
class Comparison:
    """start: (n_joints,) rad or mm; convergences: of the documented method, a target each, where targets are single."""

    arm: Arm
    targets: Targets
    start: FloatArray
    results: tuple[MethodResult, ...]
    convergences: tuple[Convergence, ...]

    def text(self) -> str:
        """The table, and the documented method's iterations for single targets, without a line end at the end."""
        from planner.comparison.table import convergence_lines, table_lines

        lines = table_lines(self)
        for found in self.convergences:
            lines += ["", *convergence_lines(self.arm, found)]
        return "\n".join(lines)

    def __str__(self) -> str:
        return self.text()

    def as_dict(self) -> dict[str, Any]:
        """The same and more as values for JSON, as `plan compare --json` writes them."""
        from planner.comparison.description import comparison_description

        return comparison_description(self)


def default_start(model: ArmModel, kind: TargetKind) -> FloatArray:
    """(n_joints,) for single and random targets the start of the documents on their arm; else the arm's home, and the
    middle of the joints' ranges if it has none."""
    arm = model.arm
    documented = documented_start(arm) if kind is not TargetKind.DRAWING else None
    if documented is not None:
        return documented
    try:
        return arm.complete(home_of(model))
    except PlanError:
        return arm.complete(arm.independent_of((arm.minimum + arm.maximum) / 2))


def compare(model: ArmModel, targets: Targets, start: FloatArray, settings: PlanSettings, report: Report) -> Comparison:
    """Every method on the same targets from joints (n_joints,). A method that the arm has not is a result that says
    why. Errors: TargetBeyondReach where a single target is."""
    arm = model.arm
    results = []
    times: dict[str, StrokeTimes] = {}
    baseline: dict[str, StrokeTimes] = {}
    for index, method in enumerate(METHODS):
        report("comparing", index, len(METHODS))
        result = _result(method, arm, targets, start, settings)
        if targets.strokes and result.measured is not None and method.drawn_by is not None:
            drawn_so = replace(settings, method=method.drawn_by)
            times[method.name], baseline[method.name] = (
                stroke_times(model, targets.strokes, replace(drawn_so, timing=timing))
                for timing in (settings.timing, Timing.RUCKIG)
            )
        results.append(result)
    report("comparing", len(METHODS), len(METHODS))
    if targets.kind is not TargetKind.SINGLE:
        return Comparison(arm, targets, start, _with_times(results, times, baseline), ())
    _require_reach(arm, targets, results)
    return Comparison(
        arm,
        targets,
        start,
        tuple(results),
        tuple(convergence(model.kinematics, target, start) for target in targets.tips_mm),
    )


def _result(
    method: ComparedMethod, arm: Arm, targets: Targets, start: FloatArray, settings: PlanSettings
) -> MethodResult:
    try:
        measured = measure(method, arm, settings.weights or arm.weights, targets, start)
    except PlannerError as error:
        return MethodResult(method, Figures(), None, refusal=str(error))
    missed = np.flatnonzero(~measured.solved)
    failures = (
        [Failures("targets", len(missed), method.unsolved, tuple(targets.tips_mm[missed[0]].tolist()))]
        if len(missed)
        else []
    )
    return MethodResult(method, figures_of(arm, targets, measured, iterates=method.iterates), measured, tuple(failures))


def _with_times(
    results: Sequence[MethodResult], times: dict[str, StrokeTimes], baseline: dict[str, StrokeTimes]
) -> tuple[MethodResult, ...]:
    """The results with the time of the strokes; those that one method is refused are left out of what is common."""
    if not times:
        return tuple(results)
    drawn_by_all: BoolArray = np.all(np.isfinite([each.seconds for each in times.values()]), axis=0)
    return tuple(
        _with_time(result, times[result.method.name], baseline[result.method.name], drawn_by_all)
        if result.method.name in times
        else result
        for result in results
    )


def _with_time(
    result: MethodResult, times: StrokeTimes, baseline: StrokeTimes, drawn_by_all: BoolArray
) -> MethodResult:
    drawn = ~np.isnan(times.seconds)
    joined_s = float(baseline.seconds[drawn_by_all].sum())
    figures = replace(
        result.figures,
        strokes_refused=int((~drawn).sum()),
        drawing_s=float(times.seconds[drawn].sum()) if drawn.any() else None,
        drawing_common_s=float(times.seconds[drawn_by_all].sum()) if drawn_by_all.any() else None,
        ruckig_common_s=joined_s if drawn_by_all.any() and np.isfinite(joined_s) else None,
    )
    if not times.infeasible_paths:
        return replace(result, figures=figures)
    first = times.infeasible_paths[0]
    refused = Failures("strokes", len(times.infeasible_paths), first.reason, first.tip_mm)
    return replace(result, figures=figures, failures=(*result.failures, refused))


def _require_reach(arm: Arm, targets: Targets, results: Sequence[MethodResult]) -> None:
    """Errors: TargetBeyondReach for a target that no method gets as near to as a drawing needs."""
    measured = [result.measured for result in results if result.measured is not None]
    for index, target in enumerate(targets.tips_mm):
        gap_mm = float(np.nanmin([each.error_mm[index] for each in measured]))
        fine = [each.solved[index] and each.error_mm[index] < 2 * FOR_DRAWING.tolerance_xy_mm for each in measured]
        if not any(fine):
            raise TargetBeyondReach(target.tolist(), gap_mm, pointed=arm.pen.hold is PenHold.TOOL_AXIS)
