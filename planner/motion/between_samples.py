"""Where the tip is between samples, by both ways in which controllers join them: straight joint lines, and cubics.

A cubic goes through the four samples around, so the sample next to a contact bends the motion on the other side of it:
the first step of a stroke tilts the pen's way down, and the last height of the way down pushes the pen into the paper.
Every part of a trajectory is therefore measured as if it were held at its ends, and what it does to its neighbour is
bounded beside that.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.kinematics.chain import Kinematics
from planner.motion.stroke_motion import StrokeMotions
from planner.motion.tolerance import ACROSS_SHARE, ASIDE_SHARE, DRIFT_SHARE, HEIGHT_SHARE
from planner.placement.pen_path import PenPaths
from planner.ragged import starts_of, within

_WAY_PER_STEP = 6
"""Points of the way itself to a step: fewer would cut the corners that samples are blamed for."""
_PER_STEP = 4
_FRACTIONS = np.arange(1, _PER_STEP) / _PER_STEP
_ACROSS = 1 / (9 * np.sqrt(3))
"""Largest weight of the sample behind a contact on the near side of it: of u (1 - u) (2 - u) / 6, u in 0 to 1."""
_STEPS_AT_ONCE = 4096


def _lagrange(fractions: FloatArray) -> FloatArray:
    """(n, 4) weights of the samples -1, 0, 1, 2 in the cubic through them."""
    nodes = np.array([-1.0, 0.0, 1.0, 2.0])
    return np.stack(
        [np.prod([(fractions - other) / (node - other) for other in nodes if other != node], axis=0) for node in nodes],
        axis=1,
    )


_WEIGHTS = np.concatenate(
    (np.column_stack((0 * _FRACTIONS, 1 - _FRACTIONS, _FRACTIONS, 0 * _FRACTIONS)), _lagrange(_FRACTIONS))
)
"""(2 (_PER_STEP - 1), 4) of straight lines and of cubics."""


def tips_between(kinematics: Kinematics, joints: Sequence[FloatArray]) -> tuple[FloatArray, IntArray]:
    """Tips (total steps, n_points, 3) in mm between samples, for samples (n, n_joints) of motions that are held before
    and after; and the number of steps of each."""
    counts = np.array([len(samples) for samples in joints])
    held = np.concatenate([part for samples in joints for part in (samples[:1], samples, samples[-1:])])
    first = np.repeat(starts_of(counts + 2)[:-1], counts - 1) + within(counts - 1)
    tips = np.empty((len(first), len(_WEIGHTS), 3))
    for begin in range(0, len(first), _STEPS_AT_ONCE):
        part = slice(begin, begin + _STEPS_AT_ONCE)
        around = held[first[part, None] + np.arange(4)]
        between = np.einsum("pw,nwj->npj", _WEIGHTS, around)
        tips[part] = kinematics.tip_mm(kinematics.independent_of(between.reshape(-1, held.shape[1]))).reshape(
            len(around), len(_WEIGHTS), 3
        )
    return tips, counts - 1


def stroke_excess(
    kinematics: Kinematics, paths: PenPaths, motion: StrokeMotions, samples: Sequence[FloatArray], tolerance_mm: float
) -> FloatArray:
    """(total steps,) by how much the tip strays from its path in each step of a stroke, 1 where it is just allowed.

    samples: those of the motion. How far it strays grows with the square of the speed, and so does this figure.
    """
    tips, n_steps = tips_between(kinematics, samples)
    cells, fractions = motion.places(_WAY_PER_STEP)
    way = paths.at(cells, fractions)
    # The way from a step before to a step behind, held at the ends of each stroke.
    last = np.repeat(_WAY_PER_STEP * n_steps, n_steps)
    begin = np.repeat(starts_of(_WAY_PER_STEP * n_steps + 1)[:-1], n_steps)
    offsets = np.arange(-_WAY_PER_STEP, 2 * _WAY_PER_STEP + 1)
    excess = np.empty(len(tips))
    place = within(n_steps) * _WAY_PER_STEP
    for first in range(0, len(tips), _STEPS_AT_ONCE):
        part = slice(first, first + _STEPS_AT_ONCE)
        near = way[begin[part, None] + np.clip(place[part, None] + offsets, 0, last[part, None])]
        own = near[:, _WAY_PER_STEP + 1 : 2 * _WAY_PER_STEP]
        aside = np.maximum(_to_polyline(tips[part, :, :2], near), _to_polyline(own, near[:, ::_WAY_PER_STEP]))
        height = np.abs(tips[part, :, 2]).max(axis=1)
        excess[part] = np.maximum(aside / (ASIDE_SHARE * tolerance_mm), height / (HEIGHT_SHARE * tolerance_mm))
    # The first step and the last grow with the cube of the speed.
    ends = starts_of(_WAY_PER_STEP * n_steps + 1)
    into = np.hypot(*(way[ends[:-1] + _WAY_PER_STEP] - way[ends[:-1]]).T)
    out = np.hypot(*(way[ends[1:] - 1] - way[ends[1:] - 1 - _WAY_PER_STEP]).T)
    steps = starts_of(n_steps)
    for step, length in ((steps[:-1], into), (steps[1:] - 1, out)):
        across = np.cbrt(_ACROSS * length / (ACROSS_SHARE * tolerance_mm)) ** 2
        excess[step] = np.maximum(excess[step], across)
    return excess


def travel_move_excess(
    kinematics: Kinematics,
    joints: Sequence[FloatArray],
    contacts_mm: Sequence[FloatArray],
    on_paper: Sequence[tuple[bool, bool]],
    clearance_mm: float,
    tolerance_mm: float,
) -> FloatArray:
    """(n_travel_moves,) by how much the tip strays between the samples (n, n_joints) of each travel move, 1 where it is
    just allowed: below the clearance from the places that it leaves and comes down on, below the paper, and into its
    neighbours.

    contacts_mm: (2, 2) where it starts and ends; on_paper: which of the two is on the paper. All this shrinks with
    the square of the speed at least, and so does the figure.
    """
    tips, n_steps = tips_between(kinematics, joints)
    bounds = np.cumsum(n_steps)[:-1]
    excess = np.zeros(len(joints))
    for move, (near, samples, places, on) in enumerate(
        zip(np.split(tips, bounds), joints, contacts_mm, on_paper, strict=True)
    ):
        points = near.reshape(-1, 3)
        drift = np.min(
            [np.hypot(*(points[:, :2] - place).T) for place, contact in zip(places, on, strict=True) if contact],
            axis=0,
        )
        strays = np.minimum(drift, clearance_mm - points[:, 2])  # aside, it may be low only where it may be aside
        depth = max(float(strays.max(initial=0.0)), -float(points[:, 2].min(initial=0.0)))
        beside = samples[[min(1, len(samples) - 1), max(len(samples) - 2, 0)]]
        heights = np.abs(kinematics.tip_mm(kinematics.independent_of(beside))[:, 2])
        across = np.cbrt(_ACROSS * heights[list(on)].max() / (ACROSS_SHARE * tolerance_mm)) ** 2
        excess[move] = max(depth / (DRIFT_SHARE * tolerance_mm), float(across))
    return excess


def _to_polyline(points: FloatArray, line: FloatArray) -> FloatArray:
    """(n,) largest distance of points (n, k, 2) to the polylines (n, m, 2) of the same row."""
    start, along = line[:, None, :-1], np.diff(line, axis=1)[:, None]
    offset = points[:, :, None] - start
    share = (offset * along).sum(axis=-1) / np.maximum((along * along).sum(axis=-1), 1e-18)
    off = offset - np.clip(share, 0.0, 1.0)[..., None] * along
    worst: FloatArray = np.sqrt((off * off).sum(axis=-1).min(axis=2).max(axis=1))
    return worst
