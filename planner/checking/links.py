"""Links as capsules: how far they are from each other, and how low they come.

A link with a thickness is a capsule about each segment of its row, and about the way on to the next. Capsules of one
row are held to each other. Two capsules between which the chain is shorter than half of both thicknesses together touch
at that joint whatever the arm does: they count where they are folded to less than a right angle, by the far end of the
shorter one.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from planner.arms.arm import Arm, JointKind
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.checking.chain import ChainPoses

_RIGHT_ANGLE = 1e-9
"""A cosine below this is that of a right angle."""


@dataclass(frozen=True, eq=False, slots=True)
class Clearances:
    """clearance_mm: (n,) between the two capsules that are closest, below zero where they overlap, infinite where no
    two count.
    pair: (n,) which of the pairs that is, by their names."""

    clearance_mm: FloatArray
    pair: IntArray
    names: tuple[str, ...]


class Capsules:
    """The capsules of an arm whose chain has these segments: the row of each, as in `ChainPoses.rows`."""

    def __init__(self, arm: Arm, rows: tuple[int, ...]) -> None:
        thickness_mm = [None if row < 0 else arm.joints[row].thickness_mm for row in rows]
        self._half_mm = [None if thickness is None else thickness / 2 for thickness in thickness_mm]
        lengths = _greatest_lengths(arm)
        thick = [capsule for capsule, half in enumerate(self._half_mm) if half is not None]
        self._pairs = []
        for one, other in combinations(thick, 2):
            if rows[one] != rows[other]:
                halves = (self._half_mm[one] or 0.0) + (self._half_mm[other] or 0.0)
                self._pairs.append((one, other, halves, sum(lengths[one + 1 : other]) < halves))
        self.pair_names = tuple(
            f"{arm.joints[rows[one]].name} and {arm.joints[rows[other]].name}" for one, other, _, _ in self._pairs
        )
        # Up to the joint where the last row, which carries the pen, begins.
        self._counted = rows.index(rows[-1]) if rows else 0

    def clearances(self, poses: ChainPoses) -> tuple[FloatArray, IntArray]:
        """As in `Clearances`; there have to be pairs."""
        clearances = []
        for one, other, halves, contact in self._pairs:
            near, start = poses.nodes_mm[one + 1], poses.nodes_mm[other]
            away, along = poses.nodes_mm[one] - near, poses.nodes_mm[other + 1] - start
            if not contact:
                clearances.append(_gap_mm(near, away, start, along) - halves)
                continue
            sizes = np.linalg.norm(away, axis=0), np.linalg.norm(along, axis=0)
            folded: BoolArray = (away * along).sum(axis=0) > _RIGHT_ANGLE * sizes[0] * sizes[1]
            nothing = np.zeros_like(near)
            gap = np.where(
                sizes[0] <= sizes[1],
                _gap_mm(near + away, nothing, start, along),
                _gap_mm(start + along, nothing, near, away),
            )
            clearances.append(np.where(folded, gap - halves, np.inf))
        table = np.stack(clearances)
        return table.min(axis=0), table.argmin(axis=0)

    def lowest_mm(self, poses: ChainPoses) -> FloatArray:
        """(n,) height of the lowest part of the capsules, the foot that the arm stands on and the capsule with the pen
        aside; infinite where there is none."""
        lowest = np.full(poses.tip_mm.shape[1], np.inf)
        for node in range(1, self._counted + 1):
            half = max(self._half_mm[node - 1] or 0.0, self._half_mm[node] or 0.0)
            if half:
                lowest = np.minimum(lowest, poses.nodes_mm[node, 2] - half)
        return lowest


def _greatest_lengths(arm: Arm) -> list[float]:
    """The greatest length of each segment that makes a node."""
    lengths = []
    for joint in arm.joints:
        if joint.origin.length_mm:
            lengths.append(joint.origin.length_mm)
        if joint.kind is JointKind.PRISMATIC:
            lengths.append(max(abs(joint.d_mm + joint.minimum), abs(joint.d_mm + joint.maximum)))
        elif joint.d_mm:
            lengths.append(abs(joint.d_mm))
        if joint.a_mm:
            lengths.append(abs(joint.a_mm))
    if arm.tool.length_mm:
        lengths.append(arm.tool.length_mm)
    return lengths


def _gap_mm(p: FloatArray, u: FloatArray, q: FloatArray, v: FloatArray) -> FloatArray:
    """(n,) least |p + s u - q - t v| for s and t from 0 to 1, all (3, n). For any s the best t is known, and the other
    way round; s is begun with where the lines are closest, within its bounds, or anywhere if they are parallel."""
    between = p - q
    uu, uv, vv = (u * u).sum(axis=0), (u * v).sum(axis=0), (v * v).sum(axis=0)
    ub, vb = (u * between).sum(axis=0), (v * between).sum(axis=0)
    s = np.clip(_ratio(uv * vb - vv * ub, uu * vv - uv * uv), 0.0, 1.0)
    t = np.clip(_ratio(vb + uv * s, vv), 0.0, 1.0)
    s = np.clip(_ratio(uv * t - ub, uu), 0.0, 1.0)
    gap: FloatArray = np.linalg.norm(between + s * u - t * v, axis=0)
    return gap


def _ratio(numerator: FloatArray, denominator: FloatArray) -> FloatArray:
    """(n,) zero where the denominator is."""
    ratio: FloatArray = np.where(denominator > 0, numerator, 0.0) / np.where(denominator > 0, denominator, 1.0)
    return ratio
