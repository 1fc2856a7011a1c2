"""Laws of the pen: when it is on the paper, how it comes there, and that nothing else touches it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from planner.arms.arm import Arm, PenHold
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.checking.between import POINTS_PER_STEP, Sweep
from planner.checking.verdict import Finding, Place
from planner.trajectory import Trajectory

TILT_TOLERANCE_DEG = 0.1


def stroke_order(trajectory: Trajectory) -> list[Finding]:
    """Strokes are counted from 0, each drawn in one go and once; the pen is up elsewhere and at the ends."""
    pen, stroke = trajectory.pen, trajectory.stroke
    drawn = np.flatnonzero(stroke >= 0)
    begins = drawn[np.concatenate(([True], np.diff(drawn) > 1))] if len(drawn) else drawn
    # Without a lift between them, a stroke still begins where its index changes.
    changes = 1 + np.flatnonzero((np.diff(stroke) != 0) & (stroke[1:] >= 0) & (stroke[:-1] >= 0))
    begins = np.union1d(begins, changes)
    wrong = np.flatnonzero(stroke[begins] != np.arange(len(begins)))
    remark = f"{len(begins)} stroke{'' if len(begins) == 1 else 's'}, each once and in order"
    place = None
    if len(wrong):
        place = place_of(trajectory, int(begins[wrong[0]]))
        remark = f"stroke {stroke[begins[wrong[0]]]} begins where stroke {wrong[0]} should"
    findings = [Finding("strokes in order", not len(wrong), place=place, remark=remark)]
    differ = np.flatnonzero(pen != (stroke >= 0))
    findings.append(Finding(
        "pen down within strokes", not len(differ), place=place_of(trajectory, int(differ[0])) if len(differ) else None,
        remark="pen is 1 exactly within strokes" if not len(differ) else "pen and stroke contradict each other"))
    for name, sample in (("first", 0), ("last", trajectory.n_samples - 1)):
        down = bool(pen[sample])
        findings.append(Finding(f"pen up at the {name} sample", not down,
                                place=place_of(trajectory, sample) if down else None))
    return findings


def on_the_paper(trajectory: Trajectory, sweeps: Sequence[Sweep], tolerance_mm: float) -> list[Finding]:
    """Height of the tip while the pen is down, either way."""
    return _worst(trajectory, sweeps, "tip on the paper while the pen is down", tolerance_mm, "mm",
                  lambda sweep: (np.abs(sweep.tip_mm[:, 2]), sweep.down))


def above_the_paper(trajectory: Trajectory, sweeps: Sequence[Sweep], tolerance_mm: float) -> list[Finding]:
    """Depth below the paper, of the lifted tip and of every link; negative figures are above it."""
    return [
        *_worst(trajectory, sweeps, "tip below the paper while the pen is up", tolerance_mm, "mm",
                lambda sweep: (-sweep.tip_mm[:, 2], ~sweep.down)),
        *_worst(trajectory, sweeps, "links below the paper", tolerance_mm, "mm",
                lambda sweep: (-sweep.lowest_mm, np.ones(len(sweep.sample), dtype=bool))),
    ]


def links_apart(trajectory: Trajectory, sweeps: Sequence[Sweep], tolerance_mm: float) -> list[Finding]:
    """Room between links that have a thickness, where it is least; they may overlap by the tolerance."""
    thick = [(sweep, sweep.rooms) for sweep in sweeps if sweep.rooms is not None]
    if not thick:
        return []
    sweep, rooms = min(thick, key=lambda entry: float(entry[1].room_mm.min()))
    point = int(np.argmin(rooms.room_mm))
    room = float(rooms.room_mm[point])
    if np.isinf(room):
        return [Finding("links apart", True, remark="none is folded under the next")]
    return [Finding("links apart", room >= -tolerance_mm, room, 0.0, "mm",
                    place_of(trajectory, int(sweep.sample[point]), point, sweep),
                    f"between {rooms.names[rooms.pair[point]]}, {sweep.interpolation.value} joints")]


def straight_up_and_down(
        trajectory: Trajectory, sweeps: Sequence[Sweep], clearance_mm: float, tolerance_mm: float) -> list[Finding]:
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
            contact = down[np.clip(neighbour, 0, len(down) - 1)] * POINTS_PER_STEP
            gap = np.linalg.norm(sweep.tip_mm[:, :2] - sweep.tip_mm[contact, :2], axis=1)
            distance = np.where(exists, np.minimum(distance, gap), distance)
        return distance, low

    return _worst(trajectory, sweeps, "straight up and down below clearance", tolerance_mm, "mm", drift)


def upright(trajectory: Trajectory, arm: Arm, sweeps: Sequence[Sweep]) -> list[Finding]:
    """Angle of the tool axis to straight down while the pen is down, for arms that have to hold it so."""
    if arm.pen.hold is not PenHold.TOOL_AXIS:
        return []
    return _worst(trajectory, sweeps, "pen upright on the paper", TILT_TOLERANCE_DEG, "deg",
                  lambda sweep: (np.degrees(sweep.tilt_rad), sweep.down))


def lift_notes(trajectory: Trajectory, arm: Arm, sweep: Sweep, tolerance_mm: float) -> list[Finding]:
    """What is worth knowing and no fault: the highest tip, and travels that stay below clearance height."""
    height = sweep.tip_mm[:, 2]
    top = int(np.argmax(height))
    notes = [Finding(
        "highest tip", True, float(height[top]), unit="mm", is_note=True,
        remark=f"the arm's own lift is {arm.pen.lift_mm:g} mm", place=place_of(trajectory, int(sweep.sample[top])))]
    down = np.flatnonzero(trajectory.pen)
    leaves = down[:-1][np.diff(down) > 1]
    returns = down[1:][np.diff(down) > 1]
    low = [sample for sample, back in zip(leaves.tolist(), returns.tolist(), strict=True)
           if height[sample * POINTS_PER_STEP:back * POINTS_PER_STEP].max() < arm.pen.clearance_mm - tolerance_mm]
    if low:
        notes.append(Finding("travels below clearance", True, float(len(low)), is_note=True,
                             remark=f"of {len(leaves)} lifts", place=place_of(trajectory, low[0])))
    return notes


def place_of(trajectory: Trajectory, sample: int, point: int | None = None, sweep: Sweep | None = None) -> Place:
    """The place of a sample, or of a point of a sweep."""
    time_s = sample / trajectory.rate_hz
    tip_mm = None
    if sweep is not None and point is not None:
        time_s = point / POINTS_PER_STEP / trajectory.rate_hz
        tip_mm = tuple(sweep.tip_mm[point].tolist())
    stroke = int(trajectory.stroke[sample])
    return Place(time_s, sample, trajectory.line(sample), stroke=stroke if stroke >= 0 else None, tip_mm=tip_mm)


def _worst(trajectory: Trajectory, sweeps: Sequence[Sweep], check: str, limit: float, unit: str,
           figure: Callable[[Sweep], tuple[FloatArray, BoolArray]]) -> list[Finding]:
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
    between = point % POINTS_PER_STEP > 0
    return [Finding(check, worst <= limit, worst, limit, unit, place_of(trajectory, sample, point, sweep),
                    f"between samples, {sweep.interpolation.value} joints" if between else "")]
