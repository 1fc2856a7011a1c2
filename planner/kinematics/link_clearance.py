"""How much clearance is left between the links of an arm, and between them and the paper.

A link whose thickness is known is a capsule about each of the segments of its row, along d, along a and on to where the
next joint has its origin. The
clearance of two capsules is the distance of their segments less half of each thickness. Where a joint holds two
together they always touch, so there the fold counts: under a right angle, the far end of the shorter one has to keep
that far from the axis of the other. So it does where what lies between two is too short to ever hold them apart.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from planner.arms.arm import Arm, Joint, JointKind
from planner.arrays import FloatArray, IntArray

KEPT_MM = 0.1
"""Clearance that is left at samples for what joints do between them."""

_SQUARE = 1e-9
"""Cosine of what is a right angle but for rounding: the segments of a row, and of rows that follow each other."""


@dataclass(frozen=True, slots=True)
class _Capsule:
    """About the segment from one corner of the chain to the next; half_mm: half its thickness."""

    link: int
    begin: int
    end: int
    half_mm: float


@dataclass(frozen=True, slots=True)
class Collision:
    """The two links, or one and the paper, that come closest in a sequence of configurations: where, and by how
    much."""

    links: tuple[str, str]
    clearance_mm: float
    configuration: int

    def __str__(self) -> str:
        one, other = self.links
        return f"there would be {self.clearance_mm:.2f} mm between {one} and {other}"


class LinkClearance:
    """Clearances of one arm's configurations. Where its file gives no thickness all are infinite.

    nodes_mm: from configurations (n, n_independent) to the corners of the chain (n, n_nodes, 3).
    """

    def __init__(self, arm: Arm, nodes_mm: Callable[[FloatArray], FloatArray]) -> None:
        self._arm, self._nodes_mm = arm, nodes_mm
        self._base_mm = arm.paper.T_paper_base[:3, 3]  # where the chain begins
        segments = _segments(arm)
        lengths = [length for _, length in segments]
        with_length = [segment for segment, length in enumerate(lengths) if length > 0]
        capsules = [
            _Capsule(link, segment, segment + 1, thickness / 2)
            for segment, (link, length) in enumerate(segments)
            if length > 0 and link >= 0 and (thickness := arm.joints[link].thickness_mm) is not None
        ]
        pairs = [(one, other) for one, other in combinations(capsules, 2) if one.link != other.link]

        def held_together(one: _Capsule, other: _Capsule) -> bool:
            return sum(lengths[one.end : other.begin]) < one.half_mm + other.half_mm

        self._held = [pair for pair in pairs if held_together(*pair)]
        self._apart = [pair for pair in pairs if not held_together(*pair)]
        # The arm stands with its first corner, beside the paper or anywhere, and the last row carries the pen.
        self._first_length = with_length[0] if with_length else 0
        last = max((segments[segment][0] for segment in with_length), default=0)
        pen_begins = min((segment for segment in with_length if segments[segment][0] == last), default=0)
        self._corners = [
            (capsule, corner)
            for capsule in capsules
            for corner in (capsule.begin, capsule.end)
            if with_length[0] < corner <= pen_begins
        ]
        names = [f"link {joint.name}" for joint in arm.joints]
        self.names = [(names[one.link], names[other.link]) for one, other in self._held + self._apart] + [
            (names[capsule.link], "the paper") for capsule, _ in self._corners
        ]

    def least_mm(self, independent: FloatArray) -> tuple[FloatArray, IntArray]:
        """(n,) signed clearances in mm of configurations (n, n_independent), below zero where links overlap, and (n,)
        which of `names` come that close. Infinite where nothing can collide."""
        if not self.names:
            return np.full(len(independent), np.inf), np.zeros(len(independent), dtype=np.int64)
        nodes = self._nodes_mm(independent).transpose(1, 0, 2)
        corners = np.concatenate((np.broadcast_to(self._base_mm, (1, *nodes.shape[1:])), nodes))
        clearances = [
            _fold_mm(
                corners[one.end],
                corners[one.begin],
                corners[other.begin],
                corners[other.end],
                one.half_mm + other.half_mm,
            )
            for one, other in self._held
        ]
        clearances += [
            segment_distance(corners[one.begin], corners[one.end], corners[other.begin], corners[other.end])
            - one.half_mm
            - other.half_mm
            for one, other in self._apart
        ]
        clearances += [corners[corner][:, 2] - capsule.half_mm for capsule, corner in self._corners]
        stacked = np.stack(clearances)
        return stacked.min(axis=0), stacked.argmin(axis=0)

    def lowest_mm(self, independent: FloatArray) -> FloatArray:
        """(n,) height over the paper of the lowest corner of the chain in configurations (n, n_independent), but for
        the tip and for the base, which may stand lower than a paper beside it."""
        heights = self._nodes_mm(independent)[:, self._first_length : -1, 2]
        lowest: FloatArray = heights.min(axis=1, initial=np.inf)
        return lowest

    def collisions(self, sequences: Sequence[FloatArray], kept_mm: float = KEPT_MM) -> list[Collision | None]:
        """For each sequence of configurations (n, n_joints), n > 0, where clearance is least, if it is less than
        kept_mm."""
        if not self.names or not sequences:
            return [None] * len(sequences)
        clearances, which = self.least_mm(self._arm.independent_of(np.concatenate(sequences)))
        found: list[Collision | None] = []
        start = 0
        for sequence in sequences:
            configuration = int(clearances[start : start + len(sequence)].argmin())
            clearance = float(clearances[start + configuration])
            pair = self.names[int(which[start + configuration])]
            found.append(Collision(pair, clearance, configuration) if clearance < kept_mm else None)
            start += len(sequence)
        return found


def _segments(arm: Arm) -> list[tuple[int, float]]:
    """The link that each segment between two corners belongs to, and the greatest length that it has. The way to a
    joint's origin belongs to the link before, to none for the first joint, and the tool to the last."""
    segments: list[tuple[int, float]] = []
    for index, joint in enumerate(arm.joints):
        if joint.origin.length_mm:
            segments.append((index - 1, joint.origin.length_mm))
        segments += [(index, length) for length in _longest(joint)]
    if arm.tool.length_mm:
        segments.append((arm.n_joints - 1, arm.tool.length_mm))
    return segments


def _longest(joint: Joint) -> tuple[float, float]:
    """Greatest lengths of the two segments of a row."""
    if joint.kind is JointKind.REVOLUTE:
        return abs(joint.d_mm), abs(joint.a_mm)
    return max(abs(joint.d_mm + joint.minimum), abs(joint.d_mm + joint.maximum)), abs(joint.a_mm)


def _fold_mm(
    near_one: FloatArray, far_one: FloatArray, near_other: FloatArray, far_other: FloatArray, halves_mm: float
) -> FloatArray:
    """(n,) clearance of two capsules that are held together at their near ends; infinite where they are not folded."""
    one, other = far_one - near_one, far_other - near_other
    lengths = np.linalg.norm(one, axis=1), np.linalg.norm(other, axis=1)
    folded = _dot(one, other) > _SQUARE * lengths[0] * lengths[1]
    distance = np.where(
        lengths[0] <= lengths[1], _to_segment(far_one, near_other, far_other), _to_segment(far_other, near_one, far_one)
    )
    clearance: FloatArray = np.where(folded, distance - halves_mm, np.inf)
    return clearance


def segment_distance(p0: FloatArray, p1: FloatArray, q0: FloatArray, q1: FloatArray) -> FloatArray:
    """(n,) distances of segments p0 p1 and q0 q1, all (n, 3): that of the nearest points of their lines, `p0 + s u` and
    `q0 + t v` with `s = (b e - c d) / (a c - b^2)`, `t = (a e - b d) / (a c - b^2)`, where both are within the
    segments; else that of an end from the other segment."""
    u, v, w = p1 - p0, q1 - q0, p0 - q0
    a, b, c, d, e = _dot(u, u), _dot(u, v), _dot(v, v), _dot(u, w), _dot(v, w)
    determinant = a * c - b * b
    crossing = determinant > 0  # parallel segments are as close at an end as anywhere
    scale = np.where(crossing, determinant, 1.0)
    s, t = (b * e - c * d) / scale, (a * e - b * d) / scale
    within = crossing & (s > 0) & (s < 1) & (t > 0) & (t < 1)
    lines = np.where(within, np.linalg.norm(w + s[:, None] * u - t[:, None] * v, axis=1), np.inf)
    distance: FloatArray = np.min(
        [lines, _to_segment(p0, q0, q1), _to_segment(p1, q0, q1), _to_segment(q0, p0, p1), _to_segment(q1, p0, p1)],
        axis=0,
    )
    return distance


def _to_segment(points: FloatArray, begins: FloatArray, ends: FloatArray) -> FloatArray:
    """(n,) distance of each point to its own segment."""
    along = ends - begins
    square = _dot(along, along)
    share = np.clip(_dot(points - begins, along) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    distance: FloatArray = np.linalg.norm(points - begins - share[:, None] * along, axis=1)
    return distance


def _dot(one: FloatArray, other: FloatArray) -> FloatArray:
    product: FloatArray = np.einsum("ij,ij->i", one, other)
    return product
