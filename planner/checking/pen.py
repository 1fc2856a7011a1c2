"""Laws of the pen: when it is on the paper, how it comes there, and that nothing else touches it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from planner.arms.arm import Arm, JointKind, PenHold
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.checking.between import Sweep
from planner.checking.check_result import Finding, Place
from planner.counted import counted
from planner.trajectory import Trajectory

TILT_TOLERANCE_DEG = 0.1
PLANNED_TO_MM = 1e-6


def stroke_order(trajectory: Trajectory) -> list[Finding]:
    """Strokes are counted from 0, each drawn in one go and once; the pen is up elsewhere and at the ends."""
    pen, stroke = trajectory.pen, trajectory.stroke
    drawn = np.flatnonzero(stroke >= 0)
    begins = drawn[np.concatenate(([True], np.diff(drawn) > 1))] if len(drawn) else drawn
    # Without a lift between them, a stroke still begins where its index changes.
    changes = 1 + np.flatnonzero((np.diff(stroke) != 0) & (stroke[1:] >= 0) & (stroke[:-1] >= 0))
    begins = np.union1d(begins, changes)
    wrong = np.flatnonzero(stroke[begins] != np.arange(len(begins)))
    remark = f"{counted(len(begins), 'stroke')}, each once and in order"
    place = None
    if len(wrong):
        place = place_of(trajectory, int(begins[wrong[0]]))
        remark = f"stroke {stroke[begins[wrong[0]]]} begins where stroke {wrong[0]} should"
    findings = [Finding("strokes in order", not len(wrong), place=place, remark=remark)]
    differ = np.flatnonzero(pen != (stroke >= 0))
    findings.append(
        Finding(
            "pen down within strokes",
            not len(differ),
            place=place_of(trajectory, int(differ[0])) if len(differ) else None,
            remark="pen is 1 exactly within strokes" if not len(differ) else "pen and stroke contradict each other",
        )
    )
    for name, sample in (("first", 0), ("last", trajectory.n_samples - 1)):
        down = bool(pen[sample])
        findings.append(
            Finding(f"pen up at the {name} sample", not down, place=place_of(trajectory, sample) if down else None)
        )
    return findings


def on_the_paper(
    trajectory: Trajectory, sweeps: Sequence[Sweep], tolerance_mm: float, pressed_mm: float = 0.0
) -> list[Finding]:
    """Height of the tip while the pen is down, either way; it may be as deep as `pressed_mm`."""
    return _worst(
        trajectory,
        sweeps,
        "tip on the paper while the pen is down",
        tolerance_mm,
        "mm",
        lambda sweep: (np.maximum(sweep.tip_mm[:, 2], -sweep.tip_mm[:, 2] - pressed_mm), sweep.down),
    )


def pen_as_the_tip(trajectory: Trajectory, arm: Arm, sweep: Sweep) -> list[Finding]:
    """Where the pen flag changes, the tip leaves the paper or comes to it, in this very step.

    Told by which way the tip goes. In a step that the flag changes in, it rises from the paper, more than it moves
    along it; in the next step within the stroke, it does not. A tip that rests with the pen up has not begun to rise.
    """
    tip = sweep.tip_mm[:: sweep.points_per_step]
    noise_mm = _tip_noise_mm(trajectory, arm)
    worst = (0.0, -1, "")
    for step in (1, -1):
        edge = np.flatnonzero(trajectory.pen[1:-1] & ~trajectory.pen[1 + step : trajectory.n_samples - 1 + step]) + 1
        up, inner = edge + step, edge - step
        rise, along = tip[up, 2] - tip[edge, 2], np.linalg.norm(tip[up, :2] - tip[edge, :2], axis=1)
        stays: BoolArray = (along > np.maximum(rise, noise_mm)) | (rise < -noise_mm) | _rests(trajectory, arm, edge, up)
        lift = np.abs(tip[edge, 2] - tip[inner, 2])
        slide = np.linalg.norm(tip[edge, :2] - tip[inner, :2], axis=1)
        leaves: BoolArray = trajectory.pen[inner] & (lift > np.maximum(slide, noise_mm))
        for wrong, samples, figure, remark in (
            (stays, up, np.maximum(along, np.abs(rise)), "the pen is up, and the tip still on the paper"),
            (leaves, edge, lift, "the pen is down, and the tip off the paper"),
        ):
            figure = np.where(wrong, np.maximum(figure, noise_mm), 0.0)
            if len(figure) and figure.max() > worst[0]:
                worst = float(figure.max()), int(samples[np.argmax(figure)]), remark
    figure_mm, sample, remark = worst
    if sample < 0:
        return [Finding("pen as the tip", True, remark="each stroke begins and ends with the tip on the paper")]
    return [
        Finding(
            "pen as the tip",
            False,
            figure_mm,
            unit="mm",
            remark=f"in this step: {remark}",
            place=place_of(trajectory, sample, sample * sweep.points_per_step, sweep),
        )
    ]


def _tip_noise_mm(trajectory: Trajectory, arm: Arm) -> float:
    """How much of a step of the tip may be none: positions are rounded, and planned to a tenth of a micrometre."""
    reach_mm = arm.tool.length_mm + sum(one.length_mm for one in arm.joints)
    rounding = arm.from_file_units(trajectory.rounding.max(axis=0, keepdims=True))[0]
    moves = [
        amount * (1.0 if one.kind is JointKind.PRISMATIC else reach_mm)
        for one, amount in zip(arm.joints, rounding.tolist(), strict=True)
    ]
    return PLANNED_TO_MM + float(2 * sum(moves))


def _rests(trajectory: Trajectory, arm: Arm, one: IntArray, other: IntArray) -> BoolArray:
    """Whether no joint moves from one sample to the other. Never, where the file's decimals would not show a motion
    that begins with a tenth of the jerk that the joints may have."""
    moved = np.abs(trajectory.positions[one] - trajectory.positions[other])
    rounding = trajectory.rounding[one] + trajectory.rounding[other]
    begun = arm.to_file_units(arm.max_jerk) / trajectory.rate_hz**3 / 60
    rests: BoolArray = np.all((moved <= rounding) & (rounding < begun), axis=1)
    return rests


def above_the_paper(trajectory: Trajectory, sweeps: Sequence[Sweep], tolerance_mm: float) -> list[Finding]:
    """Depth below the paper, of the lifted tip and of every link; negative figures are above it."""
    return [
        *_worst(
            trajectory,
            sweeps,
            "tip below the paper while the pen is up",
            tolerance_mm,
            "mm",
            lambda sweep: (-sweep.tip_mm[:, 2], ~sweep.down),
        ),
        *_worst(
            trajectory,
            sweeps,
            "links below the paper",
            tolerance_mm,
            "mm",
            lambda sweep: (-sweep.lowest_mm, np.ones(len(sweep.sample), dtype=bool)),
        ),
    ]


def links_apart(trajectory: Trajectory, sweeps: Sequence[Sweep], tolerance_mm: float) -> list[Finding]:
    """Clearance between links that have a thickness, where it is least; they may overlap by the tolerance."""
    thick = [(sweep, sweep.clearances) for sweep in sweeps if sweep.clearances is not None]
    if not thick:
        return []
    sweep, clearances = min(thick, key=lambda entry: float(entry[1].clearance_mm.min()))
    point = int(np.argmin(clearances.clearance_mm))
    clearance = float(clearances.clearance_mm[point])
    if np.isinf(clearance):
        return [Finding("links apart", True, remark="none is folded under the next")]
    return [
        Finding(
            "links apart",
            clearance >= -tolerance_mm,
            clearance,
            0.0,
            "mm",
            place_of(trajectory, int(sweep.sample[point]), point, sweep),
            f"between {clearances.names[clearances.pair[point]]}, {sweep.interpolation.value} joints",
        )
    ]


def straight_up_and_down(
    trajectory: Trajectory, sweeps: Sequence[Sweep], clearance_mm: float, tolerance_mm: float
) -> list[Finding]:
    """Below clearance height (less the tolerance) a lifted tip stays over the point where it left the
    paper or over the one where it comes down: distance to the nearer of the two, seen from above."""
    down = np.flatnonzero(trajectory.pen)
    if not len(down):
        return []

    def drift(sweep: Sweep) -> tuple[FloatArray, BoolArray]:
        low = ~sweep.down & (sweep.tip_mm[:, 2] < clearance_mm - tolerance_mm)
        following = np.searchsorted(down, sweep.sample, side="right")
        distance = np.full(len(sweep.sample), np.inf)
        for neighbour, exists in ((following - 1, following > 0), (following, following < len(down))):
            contact = down[np.clip(neighbour, 0, len(down) - 1)] * sweep.points_per_step
            gap = np.linalg.norm(sweep.tip_mm[:, :2] - sweep.tip_mm[contact, :2], axis=1)
            distance = np.where(exists, np.minimum(distance, gap), distance)
        return distance, low

    return _worst(trajectory, sweeps, "straight up and down below clearance", tolerance_mm, "mm", drift)


def upright(trajectory: Trajectory, arm: Arm, sweeps: Sequence[Sweep]) -> list[Finding]:
    """Angle of the tool axis to how it has to be held while the pen is down, for arms that hold the pen by it."""
    if arm.pen.hold is not PenHold.TOOL_AXIS:
        return []
    return _worst(
        trajectory,
        sweeps,
        "pen upright on the paper",
        TILT_TOLERANCE_DEG,
        "deg",
        lambda sweep: (np.degrees(sweep.tilt_rad), sweep.down),
    )


def lift_notes(trajectory: Trajectory, arm: Arm, sweep: Sweep, tolerance_mm: float) -> list[Finding]:
    """What is worth knowing and no fault: the highest tip, and travels that stay below clearance height."""
    height = sweep.tip_mm[:, 2]
    top = int(np.argmax(height))
    notes = [
        Finding(
            "highest tip",
            True,
            float(height[top]),
            unit="mm",
            is_note=True,
            remark=f"the arm's own lift is {arm.pen.lift_mm:g} mm",
            place=place_of(trajectory, int(sweep.sample[top])),
        )
    ]
    down = np.flatnonzero(trajectory.pen)
    leaves = down[:-1][np.diff(down) > 1]
    returns = down[1:][np.diff(down) > 1]
    per_step, enough_mm = sweep.points_per_step, arm.pen.clearance_mm - tolerance_mm
    low = [
        sample
        for sample, back in zip(leaves.tolist(), returns.tolist(), strict=True)
        if height[sample * per_step : back * per_step].max() < enough_mm
    ]
    if low:
        notes.append(
            Finding(
                "travels below clearance",
                True,
                float(len(low)),
                is_note=True,
                remark=f"of {counted(len(leaves), 'lift')}",
                place=place_of(trajectory, low[0]),
            )
        )
    return notes


def servo_notes(trajectory: Trajectory, arm: Arm, sweep: Sweep, tolerance_mm: float) -> list[Finding]:
    """How far the pen is beside the path where servos take one of several samples alone, whichever they begin with, and
    go straight to it. Worth knowing, and no fault: the promise is one of the samples."""
    if arm.set_point_period_s is None:
        return []
    every = max(int(np.ceil(arm.set_point_period_s * trajectory.rate_hz - 1e-6)), 1)
    if every == 1:
        return []
    tip_mm = sweep.tip_mm[:: sweep.points_per_step]
    worst_mm, where = 0.0, 0
    for first in range(every):
        taken = tip_mm[first::every]
        for k in range(1, every):
            passed = tip_mm[first + k :: every][: len(taken) - 1]
            at = first + k + every * np.arange(len(passed))
            down = trajectory.pen[at - k] & trajectory.pen[np.minimum(at - k + every, trajectory.n_samples - 1)]
            away = np.where(down, _to_segments(passed, taken[: len(passed)], taken[1 : len(passed) + 1]), 0.0)
            if len(away) and away.max() > worst_mm:
                worst_mm, where = float(away.max()), int(at[np.argmax(away)])
    beyond = "; more than the tolerance: a lower rate or speed cuts less" if worst_mm > tolerance_mm else ""
    remark = f"one of {every} samples, every {1e3 * arm.set_point_period_s:g} ms, with straight lines between{beyond}"
    return [
        Finding(
            "pen path as servos see it", True, worst_mm, unit="mm", place=place_of(trajectory, where), remark=remark
        )
    ]


def _to_segments(points: FloatArray, begins: FloatArray, ends: FloatArray) -> FloatArray:
    """(n,) distance of each point (n, 3) to its segment."""
    along = ends - begins
    square = (along**2).sum(axis=1)
    share = np.clip(((points - begins) * along).sum(axis=1) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    away: FloatArray = np.linalg.norm(points - begins - share[:, None] * along, axis=1)
    return away


def place_of(trajectory: Trajectory, sample: int, point: int | None = None, sweep: Sweep | None = None) -> Place:
    """The place of a sample, or of a point of a sweep."""
    time_s = sample / trajectory.rate_hz
    tip_mm = None
    if sweep is not None and point is not None:
        time_s = point / sweep.points_per_step / trajectory.rate_hz
        tip_mm = tuple(sweep.tip_mm[point].tolist())
    stroke = int(trajectory.stroke[sample])
    return Place(time_s, sample, trajectory.line(sample), stroke=stroke if stroke >= 0 else None, tip_mm=tip_mm)


def _worst(
    trajectory: Trajectory,
    sweeps: Sequence[Sweep],
    check: str,
    limit: float,
    unit: str,
    figure: Callable[[Sweep], tuple[FloatArray, BoolArray]],
) -> list[Finding]:
    """The worst figure among the points that count, over all interpolations; nothing where none counts."""
    found: list[tuple[float, int, Sweep]] = []
    for sweep in sweeps:
        values, counts = figure(sweep)
        points: IntArray = np.flatnonzero(counts)
        if len(points):
            point = int(points[np.argmax(values[points])])
            found.append((float(values[point]), point, sweep))
    if not found:
        return []
    worst, point, sweep = max(found, key=lambda entry: entry[0])
    sample = int(sweep.sample[point])
    between = point % sweep.points_per_step > 0
    return [
        Finding(
            check,
            worst <= limit,
            worst,
            limit,
            unit,
            place_of(trajectory, sample, point, sweep),
            f"between samples, {sweep.interpolation.value} joints" if between else "",
        )
    ]
