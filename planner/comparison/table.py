"""A comparison as lines to read, a column for each method, and the documented iterations one by one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from textwrap import wrap

import numpy as np

from planner.arms.arm import Arm
from planner.comparison.compare import Comparison, MethodResult
from planner.comparison.convergence import Convergence
from planner.comparison.targets import TargetKind
from planner.comparison.worked_example import ERRATA
from planner.counted import counted
from planner.inverse_kinematics.dls import DOCUMENTED, FOR_DRAWING, DlsStep

WIDTH = 100
_LABEL, _COLUMN = 39, 12
_NOTHING = "n/a"
_HEAD, _TAIL = 20, 5
"""Iterations that are shown of many, at the beginning and at the end."""

_ROUNDING = 1e-6
"""What is less than this is the rounding of the computer's numbers."""

Report = Callable[[float], str]


def _share(value: float) -> str:
    return f"{100 * value:.1f}"


def _count(value: float) -> str:
    return f"{value:.0f}"


def _three_digits(value: float) -> str:
    """Three significant digits of a figure that is not negative, but no more than seven decimals."""
    if value == 0:
        return "0"
    if value < _ROUNDING:
        return f"<{_ROUNDING:g}"
    return f"{value:.{min(max(2 - int(np.floor(np.log10(value))), 0), 7)}f}"


_ROWS: tuple[tuple[str, str, Report], ...] = (
    ("solved_share", "solved (%)", _share),
    ("usable_share", "solved within the joint limits (%)", _share),
    ("iterations", "iterations, mean", _three_digits),
    ("iterations_max", "iterations, most", _count),
    ("cold_ms", "cold: build, first point (ms)", _three_digits),
    ("warm_us", "warm: each point (us)", _three_digits),
    ("error_mean_mm", "position error, mean (mm)", _three_digits),
    ("error_max_mm", "position error, largest (mm)", _three_digits),
    ("outside_share", "of the solved, outside limits (%)", _share),
    ("excess_joint", "  the joint furthest outside", str),
    ("excess_deg", "  furthest outside (deg)", _three_digits),
    ("excess_mm", "  furthest outside (mm)", _three_digits),
    ("step_deg", "joint step to the next, largest (deg)", _three_digits),
    ("step_mm", "joint step to the next, largest (mm)", _three_digits),
    ("roughness_deg_mm2", "second difference, rms (deg/mm2)", _three_digits),
    ("roughness_mm_mm2", "second difference, rms (mm/mm2)", _three_digits),
    ("manipulability_mean", "manipulability, mean (mm, rad)", _three_digits),
    ("manipulability_min", "manipulability, least (mm, rad)", _three_digits),
    ("sideways_mean_mm", "tip error per deg off, mean (mm)", _three_digits),
    ("sideways_max_mm", "tip error per deg off, largest (mm)", _three_digits),
    ("repeat_deg", "same point again, joints move (deg)", _three_digits),
    ("repeat_mm", "same point again, joints move (mm)", _three_digits),
    ("strokes_refused", "strokes refused", _count),
    ("drawing_s", "drawing time of the others (s)", _three_digits),
    ("drawing_common_s", "drawing time, strokes all can draw (s)", _three_digits),
    ("ruckig_common_s", "  the same by --timing ruckig (s)", _three_digits),
)
_OF_SLIDES = {"excess_mm", "step_mm", "roughness_mm_mm2", "repeat_mm"}


def table_lines(comparison: Comparison) -> list[str]:
    """Aligned columns within 100 characters, then why methods failed."""
    arm, results = comparison.arm, comparison.results
    lines = [_heading(comparison), ""]
    first, second = zip(*(result.method.title.rsplit(" ", 1) for result in results), strict=True)
    lines += [_line("", first), _line("", second)]
    slides = any(joint.file_unit == "mm" for joint in arm.joints)
    for key, label, show in _ROWS:
        if slides or key not in _OF_SLIDES:
            lines.append(_line(label, [_cell(result, key, show) for result in results]))
    lines.append("")
    return lines + [line for note in _notes(comparison) for line in wrap(note, WIDTH, subsequent_indent="  ")]


def convergence_lines(arm: Arm, found: Convergence) -> Iterator[str]:
    """The documented iterations: joints before each, the tip, and its error along and across the paper."""
    decimals = 4 if arm.n_joints <= 5 else 3
    names = [f"{joint.name} {joint.file_unit}" for joint in arm.joints]
    widths = [max(decimals + 6, len(name) + 2) for name in names]
    head = "".join(f"{name:>{width}}" for name, width in zip(names, widths, strict=True))
    yield f"DLS documented towards ({', '.join(f'{value:g}' for value in found.target_mm)}) mm, iteration by iteration"
    yield f" i{head}" + "".join(f"{name:>9}" for name in ("x mm", "y mm", "z mm", "along mm", "across"))
    elided = len(found.steps) > _HEAD + _TAIL
    for index, state in enumerate(found.steps):
        if elided and _HEAD <= index < len(found.steps) - _TAIL:
            if index == _HEAD:
                yield f" ... {len(found.steps) - _HEAD - _TAIL} more"
            continue
        yield _iteration(arm, index, state, decimals, widths)
    if not found.converged:
        yield f"not within {_tolerances()} after {DOCUMENTED.most_iterations} iterations"
    yield from _misprints(arm, found)


def _iteration(arm: Arm, index: int, state: DlsStep, decimals: int, widths: Sequence[int]) -> str:
    along, across = float(np.hypot(*state.error_mm[:2])), abs(float(state.error_mm[2]))
    joints = "".join(
        f"{round(value, decimals) + 0.0:>{width}.{decimals}f}"
        for value, width in zip(arm.to_file_units(state.joints).tolist(), widths, strict=True)
    )
    lengths = "".join(f"{round(value, 3) + 0.0:>9.3f}" for value in (*state.tip_mm.tolist(), along, across))
    return f"{index:>2}{joints}{lengths}"


def _misprints(arm: Arm, found: Convergence) -> Iterator[str]:
    if found.printed:
        yield "The documents print the same figures, in cm, but for these of the joints:"
    for (index, column, place), correct in ERRATA.items():
        if found.printed and column == "angles_deg":
            printed = found.printed[index].angles_deg[place]
            yield (
                f"  iteration {index}, {arm.joints[place].name}: {printed:.4f} printed,"
                f" {correct:.4f} by their equations"
            )


def _heading(comparison: Comparison) -> str:
    targets = comparison.targets
    count = len(targets.tips_mm)
    what = {
        TargetKind.SINGLE: f"{counted(count, 'single target')}",
        TargetKind.RANDOM: f"{counted(count, 'random target')} on the paper, each from the start",
        TargetKind.DRAWING: f"{counted(count, 'target')} along {counted(len(targets.firsts), 'stroke')}",
    }[targets.kind]
    return f"{comparison.arm.name}: {what}"


def _notes(comparison: Comparison) -> Iterator[str]:
    yield (
        f"DLS documented stops within {_tolerances()}, DLS drawing within {FOR_DRAWING.tolerance_xy_mm:g} mm;"
        " neither knows of limits. Cold and warm are processor time."
    )
    if comparison.targets.kind is TargetKind.RANDOM:
        yield "The same points again: one after the other, in the opposite order."
    if comparison.targets.kind is TargetKind.DRAWING:
        yield "The same points again: the drawing backwards."
    for result in comparison.results:
        name = result.method.title
        if result.refusal is not None:
            yield f"{name}: {result.refusal}"
        for failure in result.failures:
            place = ", ".join(f"{value:.1f}" for value in failure.first_mm)
            yield f"{name}: {failure.what} failed: {failure.count}, the first at ({place}) mm: {failure.reason}"


def _tolerances() -> str:
    return f"{DOCUMENTED.tolerance_xy_mm:g} mm along the paper and {DOCUMENTED.tolerance_z_mm:g} mm across it"


def _cell(result: MethodResult, key: str, show: Report) -> str:
    value = getattr(result.figures, key)
    return _NOTHING if value is None else show(value)


def _line(label: str, cells: Sequence[str]) -> str:
    return f"{label:<{_LABEL}}" + "".join(f"{cell:>{_COLUMN}}" for cell in cells)
