"""From motions to the trajectory: all samples in order, what the header tells, and every limit once more."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray, IntArray
from planner.errors import PlanError
from planner.head import PenInk
from planner.kinematics.limits import Limits
from planner.pen_drawing import PenDrawing
from planner.trajectory import TRAVELLING, Trajectory
from planner.travel.pen_change import PenChange, plan_pen_change

_BLOCK_SAMPLES = 65_536


@dataclass(frozen=True, eq=False, slots=True)
class Samples:
    """positions: (n, n_joints) in file units. stroke: (n,). pens: those that draw, in order; pen_changes: the sample
    at which each but the first is put in. parts: first and last sample of what each of them draws, and kinds: of which
    layers, colours or widths that is."""

    positions: FloatArray
    stroke: IntArray
    pens: tuple[PenInk, ...]
    pen_changes: tuple[int, ...]
    parts: tuple[tuple[int, int], ...]
    kinds: tuple[tuple[str, ...], ...]


def assembled(drawings: Sequence[PenDrawing]) -> Samples:
    """What all pens draw, one after the other, with the pen changed at the park pose in between; at where the drawing
    of the pen that sticks out furthest begins for an arm that has none. Errors: PlanError where there is no way."""
    model = drawings[0].context.model
    arm = model.arm
    start = max(drawings, key=lambda one: one.group.pen.height_mm).moves[0].joints[0]  # clear of the paper for all
    park = start if arm.park is None else np.asarray(arm.park)
    positions: list[FloatArray] = []
    strokes: list[IntArray] = []
    pens: list[PenInk] = []
    changes: list[int] = []
    parts: list[tuple[int, int]] = []
    kinds: list[tuple[str, ...]] = []
    n_strokes = n_samples = 0
    for before, after in pairwise((None, *drawings)):
        assert after is not None
        joints, stroke = _drawn(after)
        change = None if before is None else _change(before, after, park if after.group.halts else None)
        if change is not None:
            way = change.joints[1:-1]  # both ends are there already
            positions.append(way)
            strokes.append(np.full(len(way), TRAVELLING))
            if change.rest is not None:
                changes.append(n_samples + change.rest - 1)
            n_samples += len(way)
        if change is None or change.rest is not None:
            pens.append(_ink(after))
            parts.append((n_samples, n_samples + len(joints) - 1))
            kinds.append(after.group.kinds)
        else:
            parts[-1] = parts[-1][0], n_samples + len(joints) - 1
            kinds[-1] += after.group.kinds
        positions.append(joints)
        strokes.append(np.where(stroke == TRAVELLING, TRAVELLING, stroke + n_strokes))
        n_strokes += len(after.timed)
        n_samples += len(joints)
    return Samples(
        arm.to_file_units(np.concatenate(positions)),
        np.concatenate(strokes),
        tuple(pens) if drawings[0].group.is_named else (),
        tuple(changes),
        tuple(parts),
        tuple(kinds),
    )


def _ink(drawing: PenDrawing) -> PenInk:
    pen = drawing.group.pen
    return PenInk(pen.name, pen.colour, pen.width_mm, pen.height_mm)


def _change(before: PenDrawing, after: PenDrawing, park: FloatArray | None) -> PenChange:
    return plan_pen_change(
        before.context.model.level,
        after.context.model.level,
        Limits.of(before.context.model.arm),
        before.rules,
        before.moves[-1].joints[-1],
        after.moves[0].joints[0],
        park,
        after.group.delay_s,
    )


def _drawn(drawing: PenDrawing) -> tuple[FloatArray, IntArray]:
    """Joints (n, n_joints), rad or mm, and strokes (n,) of what one pen draws, counted from 0. Travel moves and strokes
    share the samples where they meet; these count as drawn."""
    timed, moves = drawing.timed, drawing.moves
    n_samples = (
        sum(stroke.dwell_samples + len(stroke.joints) for stroke in timed)
        + sum(len(move.joints) for move in moves)
        - 2 * len(timed)
    )
    joints = np.empty((n_samples, moves[0].joints.shape[1]))
    strokes = np.full(n_samples, TRAVELLING)
    end = 0
    for index, move in enumerate(moves):
        begin, end = end, end + len(move.joints) - (index > 0) - (index < len(timed))
        first = 1 if index else 0
        joints[begin:end] = move.joints[first : first + end - begin]
        if index < len(timed):
            stroke = timed[index]
            begin, resting, end = end, end + stroke.dwell_samples, end + stroke.dwell_samples + len(stroke.joints)
            strokes[begin:end] = index
            joints[begin:resting] = stroke.joints[:1]
            joints[resting:end] = stroke.joints
    return joints, strokes


def verify(trajectory: Trajectory, arm: Arm) -> None:
    """Every limit, once more, on the samples as they will be written. Errors: PlanError."""
    limits, period_s = Limits.of(arm), 1 / trajectory.rate_hz
    rounding = arm.from_file_units(trajectory.rounding.max(axis=0))
    slowing = max(  # blocks overlap by the three samples that a third difference looks back
        limits.slowing_of(
            arm.from_file_units(trajectory.positions[begin : begin + _BLOCK_SAMPLES + 3]), period_s, rounding
        )
        for begin in range(0, trajectory.n_samples, _BLOCK_SAMPLES)
    )
    if not np.isfinite(trajectory.positions).all():
        raise PlanError(
            "the trajectory has positions that are no finite numbers: a defect of the planner, please"
            " report it with the drawing"
        )
    if slowing > 1 + 1e-6:
        raise PlanError(
            f"the timing exceeds a joint limit by {100 * (slowing - 1):.3f} % of speed:"
            " a defect of the planner, please report it with the drawing"
        )
