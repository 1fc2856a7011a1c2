"""The posture field: one posture for each distance from the base axis, chosen once for an arm.

An arm whose first joint turns about the vertical meets a paper point (rho, azimuth) with the posture of
(rho, 0) turned by the azimuth. So the arm's redundancy has to be decided along one line only, from
the inner to the outer radius, and the choice is global: a dynamic programme over sampled postures finds
the branch and the coarse course, further ones over its neighbours polish it. The same paper point
is then always drawn with the same posture, whatever the drawing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from planner.arms.arm import Arm, JointKind, PenHold
from planner.arms.kinematics import Kinematics, kinematics_of
from planner.arms.posture_cost import PostureCost
from planner.arms.posture_course import cheapest_course, polished_course, smoothed_course
from planner.arms.posture_refusal import no_usable_posture
from planner.arms.posture_samples import COARSE_STEP_MM, on_ray, sampled_rays, stretched_to_edges
from planner.arms.posture_tests import slowest_direction_mm_s
from planner.arms.projection import project
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.errors import ArmFileError, PlanError
from planner.settings import PostureWeights
from planner.spline import evaluate_at, interpolating

_WEIGHTS = PostureWeights()
_UPRIGHT_PROBES = 16
_FEWEST_RADII = 2
"""Sampled radii that a further sheet has to add."""
_NODES = 81
_LEAST_RING_MM = 1.0
"""No course can be laid through less."""
_ROUNDING_MM = 2.0
"""Corners, where one joint comes to rest and another starts, become bends: the standard deviation of the weights."""
_DEGREE = 5
_EDGE_MM = 1.0
"""The field is laid out over sqrt(outer + this - rho): near the stretched arm postures go with that root."""


@dataclass(frozen=True, eq=False)
class PostureField:
    """Postures along the ray of azimuth zero, pen on the paper.

    radii_mm: (n,) increasing, laid out evenly over the square root of the distance from just beyond the last;
    postures: (n, n_free) of the free joints, rad or mm.
    """

    arm: Arm
    radii_mm: FloatArray
    postures: FloatArray

    @property
    def home(self) -> FloatArray:
        """(n_free,) the posture in the middle of the field: clear of limits and singularities."""
        posture: FloatArray = self.postures[len(self.postures) // 2]
        return posture

    @cached_property
    def _controls(self) -> FloatArray:
        return interpolating(self.postures, _DEGREE)

    def _sigma(self, radius_mm: FloatArray) -> FloatArray:
        """(n,) where radii lie among the field's own, counted in nodes."""
        edge = float(self.radii_mm[-1]) + _EDGE_MM
        inside = np.clip(radius_mm, self.radii_mm[0] - 0.5 * _EDGE_MM, self.radii_mm[-1] + 0.5 * _EDGE_MM)
        first, last = np.sqrt(edge - self.radii_mm[[0, -1]])
        sigma: FloatArray = (first - np.sqrt(edge - inside)) / (first - last) * (len(self.radii_mm) - 1)
        return sigma

    def reference(self, tip_mm: FloatArray) -> FloatArray:
        """(n, n_free) field postures at tips (n, 3), whatever their height; outside the field's radii,
        those of its edge."""
        radius = np.hypot(tip_mm[:, 0], tip_mm[:, 1])
        sigma = self._sigma(radius)
        cell = np.clip(sigma.astype(np.int64), 0, len(self.radii_mm) - 2)
        reference = evaluate_at(self._controls, cell, sigma - cell, _DEGREE)
        reference[:, 0] += np.arctan2(tip_mm[:, 1], tip_mm[:, 0])
        return reference

    def reaches(self, points_mm: FloatArray) -> BoolArray:
        """(n,) whether points of the paper (n, 2) lie within the field's radii and the joint limits."""
        radius = np.hypot(*points_mm.T)
        reached: BoolArray = (radius >= self.radii_mm[0]) & (radius <= self.radii_mm[-1])
        near = points_mm[reached]
        reached[reached] = self.postures_at(np.column_stack((near, np.zeros(len(near)))))[1]
        return reached

    def postures_at(self, tip_mm: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Exact postures (n, n_free) at tips (n, 3), and where they exist within the joint limits."""
        postures, exact = project(kinematics_of(self.arm), self.reference(tip_mm), tip_mm)
        return postures, exact & within_limits(self.arm, postures)


def within_limits(arm: Arm, free: FloatArray, slack: float = 1e-9, first_joint: bool = True) -> BoolArray:
    """(n,) whether postures (n, n_free) keep all joint limits (without the first joint's, if not asked for)."""
    joints = arm.complete(free)
    start = 0 if first_joint else 1
    inside = (joints >= arm.minimum - slack) & (joints <= arm.maximum + slack)
    kept: BoolArray = np.all(inside[:, start:], axis=1)
    return kept


def posture_field(arm: Arm, weights: PostureWeights = _WEIGHTS) -> PostureField:
    """The field of an arm, computed once. Errors: PlanError where the arm cannot have one, ArmFileError where its file
    contradicts itself."""
    return _sheets(arm, weights)[0]


def posture_sheets(arm: Arm, weights: PostureWeights = _WEIGHTS) -> tuple[PostureField, ...]:
    """The field that reaches over most radii, then fields in other branches, each over as many as it can of those that
    the ones before leave out. Nearly all arms have one. Errors: as `posture_field`."""
    return _sheets(arm, weights)


@lru_cache(maxsize=16)
def _sheets(arm: Arm, weights: PostureWeights) -> tuple[PostureField, ...]:
    cost, radii, samples = choice_of_postures(arm, weights)
    left_out = np.array([len(postures) > 0 for postures in samples])
    sheets: list[PostureField] = []
    while not sheets or left_out.sum() >= _FEWEST_RADII:
        sheet = _field(cost, radii, samples, left_out if sheets else None)
        covered = (radii > sheet.radii_mm[0] - COARSE_STEP_MM) & (radii < sheet.radii_mm[-1] + COARSE_STEP_MM)
        if sheets and (left_out & covered).sum() < _FEWEST_RADII:
            break
        sheets.append(sheet)
        left_out &= ~covered
    return tuple(sheets)


def _field(cost: PostureCost, radii: FloatArray, samples: list[FloatArray], wanted: BoolArray | None
           ) -> PostureField:
    arm = cost.kinematics.arm
    nodes, course = sharp_course(cost, radii, samples, wanted)
    spacing_mm = (nodes[-1] - nodes[0]) / (_NODES - 1)
    course, exact = project(cost.kinematics, smoothed_course(course, _ROUNDING_MM / spacing_mm), on_ray(nodes))
    if not exact.all():
        raise PlanError(f"arm {arm.name}: the posture field did not converge")
    return PostureField(arm, nodes, course)


def sheet_references(sheets: Sequence[PostureField], tips_mm: FloatArray, starts: IntArray) -> FloatArray:
    """(n, n_free) field postures at tips (n, 3), those of each path in the sheet that holds most of it.
    starts: (n_paths,) the first tip of each."""
    if len(sheets) == 1 or len(tips_mm) == 0:
        return sheets[0].reference(tips_mm)
    held = np.array([np.add.reduceat(sheet.reaches(tips_mm[:, :2]), starts, dtype=np.int64) for sheet in sheets])
    chosen = np.repeat(held.argmax(axis=0), np.diff(np.append(starts, len(tips_mm))))
    references = np.empty((len(tips_mm), len(sheets[0].arm.free_joints)))
    for index, sheet in enumerate(sheets):
        references[chosen == index] = sheet.reference(tips_mm[chosen == index])
    return references


def choice_of_postures(arm: Arm, weights: PostureWeights) -> tuple[PostureCost, FloatArray, list[FloatArray]]:
    """What a field is chosen from, and by what: the cost, some radii (n,) and usable postures (m, n_free) at each.
    Errors: as `posture_field`."""
    first = arm.joints[0]
    if first.kind is not JointKind.REVOLUTE or 0 not in arm.free_joints:
        what = "slides" if first.kind is JointKind.PRISMATIC else "is driven by a coupling"
        raise PlanError(f"arm {arm.name} cannot be planned for: its first joint, {first.name}, {what}, and it has to be"
                        " one that turns about the vertical by itself, as the canvas and all postures are found along"
                        " one line from the base and turned from there")
    if any(other == 0 for coupling in arm.couplings for other, _ in coupling.coefficients):
        raise PlanError(f"arm {arm.name}: joint {first.name} turns the arm about the vertical axis;"
                        " no coupling may depend on it")
    kinematics = kinematics_of(arm)
    if kinematics.n_redundant < 0:
        pointed = ", and pointed," if arm.pen.hold is PenHold.TOOL_AXIS else ""
        raise PlanError(f"arm {arm.name} cannot be planned for: to have its pen held{pointed} anywhere on the paper"
                        f" takes {kinematics.n_task} joints that move by themselves, and it has {kinematics.n_free}")
    _require_upright(kinematics)
    radii, samples = sampled_rays(kinematics)
    if not any(len(postures) for postures in samples):
        raise no_usable_posture(kinematics)
    quickness = float(np.median(slowest_direction_mm_s(kinematics, np.concatenate(samples))))
    return PostureCost(kinematics, weights, quickness, float(radii[-1])), radii, samples


def sharp_course(cost: PostureCost, radii_mm: FloatArray, samples: list[FloatArray], wanted: BoolArray | None = None
                 ) -> tuple[FloatArray, FloatArray]:
    """The field before its corners are rounded: its radii (n,) and postures (n, n_free). Errors: PlanError where the
    course through the samples leaves its branch between them."""
    kinematics = cost.kinematics
    radii, postures = stretched_to_edges(kinematics, *cheapest_course(cost, radii_mm, samples, wanted))
    if radii[-1] - radii[0] < _LEAST_RING_MM:
        raise PlanError(f"arm {kinematics.arm.name}: the pen gets to the paper only at {radii[0]:.1f} mm from the base"
                        f" axis, in a ring less than {_LEAST_RING_MM:g} mm wide; widen the joint limits, or check d_mm,"
                        " a_mm and workspace.inner_radius_mm")
    outer = radii[-1] + _EDGE_MM
    nodes = outer - np.linspace(np.sqrt(outer - radii[0]), np.sqrt(_EDGE_MM), _NODES) ** 2
    nodes[0], nodes[-1] = radii[0], radii[-1]
    keep = np.concatenate(([True], np.diff(radii) > 1e-6))
    guess = np.column_stack([np.interp(nodes, radii[keep], column) for column in postures[keep].T])
    course, exact = project(kinematics, guess, on_ray(nodes))
    if not exact.all():
        raise PlanError(f"arm {kinematics.arm.name}: the posture field did not converge")
    return nodes, polished_course(cost, nodes, on_ray(nodes), course)


def _require_upright(kinematics: Kinematics) -> None:
    """Refuse an arm that says its couplings or its chain keep the pen upright when they do not."""
    arm = kinematics.arm
    if arm.pen.hold not in (PenHold.COUPLING, PenHold.CONSTRUCTION):
        return
    postures = np.random.default_rng(0).uniform(kinematics.free_of(arm.minimum), kinematics.free_of(arm.maximum),
                                                (_UPRIGHT_PROBES, kinematics.n_free))
    tilt = float(np.degrees(np.arccos(np.clip(-kinematics.tool_axis(postures)[:, 2], -1.0, 1.0))).max())
    if tilt > 0.01:
        raise ArmFileError(arm.name, [f"pen.hold is '{arm.pen.hold}', but the joints leave pen.tool_axis up to"
                                      f" {tilt:.1f} degrees from straight down: correct the coupling, the DH rows or"
                                      " pen.tool_axis, or let the planner hold the pen with 'tool_axis' or 'free'"])
