"""The configuration map: one configuration for each distance from the base axis, chosen once for an arm.

An arm whose first joint turns about the vertical meets a paper point (rho, azimuth) with the configuration of
(rho, 0) turned by the azimuth. So the arm's redundancy has to be decided along one line only, from
the inner to the outer radius, and the choice is global: a dynamic program over sampled configurations finds
the branch and a coarse configuration path, further ones over its neighbours polish it. The same paper point
is then always drawn with the same configuration, whatever the drawing. Where the paper does not lie square to the base
axis, the map is that of a level paper of the same height, and the configurations nearest to it are taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from planner.arms.arm import Arm, JointKind, PenHold
from planner.arms.paper_pose import BASE_PLANE
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.errors import ArmFileError, PlanError
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import within_limits
from planner.kinematics.projection import project
from planner.redundancy.configuration_path import (
    cheapest_configuration_path,
    polished_configuration_path,
    smoothed_configuration_path,
)
from planner.redundancy.configuration_tests import slowest_direction_mm_s
from planner.redundancy.cost import ConfigurationCost
from planner.redundancy.refusal import no_usable_configuration
from planner.redundancy.samples import COARSE_STEP_MM, on_ray, sampled_rays, stretched_to_edges
from planner.settings import ConfigurationWeights
from planner.spline import evaluate_at, interpolating

_UPRIGHT_PROBES = 16
_UPRIGHT_DEG = 3.0
"""A real arm leaves its pen so far from upright; what is beyond is a mistake in its file."""
_STEEPEST_RAD = float(np.radians(20.0))
_FEWEST_RADII = 2
"""Sampled radii that a further branch has to add."""
_NODES = 81
_LEAST_RING_MM = 1.0
"""No configuration path can be laid through less."""
_ROUNDING_MM = 2.0
"""Corners, where one joint comes to rest and another starts, become bends: the standard deviation of the weights."""
_DEGREE = 5
_EDGE_MM = 1.0
"""The map is laid out over sqrt(outer + this - rho): near the stretched arm configurations go with that root."""


@dataclass(frozen=True, eq=False)
class ConfigurationMap:
    """Configurations along the ray of azimuth zero, pen on the paper, which is taken to be level.

    kinematics: of the arm; level: of the arm on the level paper that the map was made for.
    radii_mm: (n,) increasing, laid out evenly over the square root of the distance from just beyond the last;
    configurations: (n, n_independent) of the independent joints, rad or mm.
    """

    kinematics: Kinematics
    level: Kinematics
    radii_mm: FloatArray
    configurations: FloatArray

    @property
    def arm(self) -> Arm:
        return self.kinematics.arm

    @property
    def home(self) -> FloatArray:
        """(n_independent,) the configuration in the middle of the map: clear of limits and singularities."""
        configuration: FloatArray = self.configurations[len(self.configurations) // 2]
        return configuration

    @cached_property
    def _controls(self) -> FloatArray:
        return interpolating(self.configurations, _DEGREE)

    def _sigma(self, radius_mm: FloatArray) -> FloatArray:
        """(n,) where radii lie among the map's own, counted in nodes."""
        edge = float(self.radii_mm[-1]) + _EDGE_MM
        inside = np.clip(radius_mm, self.radii_mm[0] - 0.5 * _EDGE_MM, self.radii_mm[-1] + 0.5 * _EDGE_MM)
        first, last = np.sqrt(edge - self.radii_mm[[0, -1]])
        sigma: FloatArray = (first - np.sqrt(edge - inside)) / (first - last) * (len(self.radii_mm) - 1)
        return sigma

    def polar(self, tip_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distances from the base axis (...) and azimuths about it (...) of points of the paper's frame (..., 3)."""
        at_mm = tip_mm if self.arm.paper.is_base_plane else self.arm.paper.to_base(tip_mm)
        return np.hypot(at_mm[..., 0], at_mm[..., 1]), np.arctan2(at_mm[..., 1], at_mm[..., 0])

    def reference(self, tip_mm: FloatArray) -> FloatArray:
        """(n, n_independent) the map's configurations at tips (n, 3), whatever their height; outside the map's radii,
        those of its edge."""
        radius, azimuth = self.polar(tip_mm)
        sigma = self._sigma(radius)
        cell = np.clip(sigma.astype(np.int64), 0, len(self.radii_mm) - 2)
        reference = evaluate_at(self._controls, cell, sigma - cell, _DEGREE)
        reference[:, 0] += azimuth
        return reference

    def reaches(self, points_mm: FloatArray) -> BoolArray:
        """(n,) whether points of the paper (n, 2) lie within the map's radii and the joint limits."""
        tips_mm = np.column_stack((points_mm, np.zeros(len(points_mm))))
        radius, _ = self.polar(tips_mm)
        reached: BoolArray = (radius >= self.radii_mm[0]) & (radius <= self.radii_mm[-1])
        reached[reached] = self.configurations_at(tips_mm[reached])[1]
        return reached

    def configurations_at(self, tip_mm: FloatArray) -> tuple[FloatArray, BoolArray]:
        """Exact configurations (n, n_independent) at tips (n, 3), and where they exist within the joint limits."""
        configurations, exact = project(self.kinematics, self.reference(tip_mm), tip_mm)
        return configurations, exact & within_limits(self.arm, self.arm.complete(configurations))


def levelled(arm: Arm) -> Arm:
    """The arm on a level paper of the same height at the base axis: itself, where its paper is the base plane. A paper
    that is higher is a first row that is shorter. Errors: PlanError where the paper is far from level."""
    if arm.paper.is_base_plane:
        return arm
    T = arm.paper.T_base_paper
    if T[2, 2] < np.cos(_STEEPEST_RAD):
        raise PlanError(
            f"arm {arm.name}: method 'path' needs a paper within {np.degrees(_STEEPEST_RAD):g} degrees of level"
        )
    height_mm = float(T[2, 3] + (T[0, 2] * T[0, 3] + T[1, 2] * T[1, 3]) / T[2, 2])
    first = replace(arm.joints[0], d_mm=arm.joints[0].d_mm - height_mm)
    return replace(arm, joints=(first, *arm.joints[1:]), paper=BASE_PLANE)


def configuration_branches(
    kinematics: Kinematics, level: Kinematics, weights: ConfigurationWeights
) -> tuple[ConfigurationMap, ...]:
    """The map that reaches over most radii, then maps in other branches, each over as many as it can of those that
    the ones before leave out. Nearly all arms have one. level: of the arm on a level paper. This takes a while:
    `ArmModel` keeps them. Errors: PlanError where the arm cannot have one, ArmFileError where its file contradicts
    itself."""
    cost, radii, samples = choice_of_configurations(level, weights)
    left_out = np.array([len(configurations) > 0 for configurations in samples])
    branches: list[ConfigurationMap] = []
    while not branches or left_out.sum() >= _FEWEST_RADII:
        branch = _configuration_map(cost, radii, samples, left_out if branches else None)
        covered = (radii > branch.radii_mm[0] - COARSE_STEP_MM) & (radii < branch.radii_mm[-1] + COARSE_STEP_MM)
        if branches and (left_out & covered).sum() < _FEWEST_RADII:
            break
        branches.append(branch)
        left_out &= ~covered
    return tuple(replace(branch, kinematics=kinematics) for branch in branches)


def _configuration_map(
    cost: ConfigurationCost, radii: FloatArray, samples: list[FloatArray], wanted: BoolArray | None
) -> ConfigurationMap:
    arm = cost.kinematics.arm
    nodes, configuration_path = sharp_configuration_path(cost, radii, samples, wanted)
    spacing_mm = (nodes[-1] - nodes[0]) / (_NODES - 1)
    configuration_path, exact = project(
        cost.kinematics, smoothed_configuration_path(configuration_path, _ROUNDING_MM / spacing_mm), on_ray(nodes)
    )
    if not exact.all():
        raise PlanError(f"arm {arm.name}: the configuration map did not converge")
    return ConfigurationMap(cost.kinematics, cost.kinematics, nodes, configuration_path)


def branch_references(branches: Sequence[ConfigurationMap], tips_mm: FloatArray, starts: IntArray) -> FloatArray:
    """(n, n_independent) the map's configurations at tips (n, 3), those of each path in the branch that holds most of
    it. starts: (n_paths,) the first tip of each."""
    if len(branches) == 1 or len(tips_mm) == 0:
        return branches[0].reference(tips_mm)
    held = np.array([np.add.reduceat(branch.reaches(tips_mm[:, :2]), starts, dtype=np.int64) for branch in branches])
    chosen = np.repeat(held.argmax(axis=0), np.diff(np.append(starts, len(tips_mm))))
    references = np.empty((len(tips_mm), len(branches[0].arm.independent_joints)))
    for index, branch in enumerate(branches):
        references[chosen == index] = branch.reference(tips_mm[chosen == index])
    return references


def choice_of_configurations(
    kinematics: Kinematics, weights: ConfigurationWeights
) -> tuple[ConfigurationCost, FloatArray, list[FloatArray]]:
    """What a map is chosen from, and by what: the cost, some radii (n,) and usable configurations (m, n_independent) at
    each.
    Errors: as `configuration_branches`."""
    arm = kinematics.arm
    first = arm.joints[0]
    if first.kind is not JointKind.REVOLUTE or 0 not in arm.independent_joints:
        what = "slides" if first.kind is JointKind.PRISMATIC else "is driven by a coupling"
        raise PlanError(
            f"arm {arm.name} cannot be planned for: its first joint, {first.name}, {what}, and it has to be"
            " one that turns about the vertical by itself, as the canvas and all configurations are found along"
            " one line from the base and turned from there"
        )
    if not first.origin.is_identity:
        raise PlanError(
            f"arm {arm.name} cannot be planned for: its first joint, {first.name}, has an origin, and has to turn about"
            " the vertical through the base"
        )
    if any(other == 0 for coupling in arm.couplings for other, _ in coupling.coefficients):
        raise PlanError(
            f"arm {arm.name}: joint {first.name} turns the arm about the vertical axis; no coupling may depend on it"
        )
    if kinematics.n_redundant < 0:
        pointed = ", and pointed," if arm.pen.hold is PenHold.TOOL_AXIS else ""
        raise PlanError(
            f"arm {arm.name} cannot be planned for: to have its pen held{pointed} anywhere on the paper"
            f" takes {kinematics.n_task} joints that move by themselves, and it has {kinematics.n_independent}"
        )
    _require_upright(kinematics)
    radii, samples = sampled_rays(kinematics)
    if not any(len(configurations) for configurations in samples):
        raise no_usable_configuration(kinematics)
    quickness = float(np.median(slowest_direction_mm_s(kinematics, np.concatenate(samples))))
    return ConfigurationCost(kinematics, weights, quickness, float(radii[-1])), radii, samples


def sharp_configuration_path(
    cost: ConfigurationCost, radii_mm: FloatArray, samples: list[FloatArray], wanted: BoolArray | None = None
) -> tuple[FloatArray, FloatArray]:
    """The map before its corners are rounded: its radii (n,) and configurations (n, n_independent). Errors: PlanError
    where the path through the samples leaves its branch between them."""
    kinematics = cost.kinematics
    radii, configurations = stretched_to_edges(
        kinematics, *cheapest_configuration_path(cost, radii_mm, samples, wanted)
    )
    if radii[-1] - radii[0] < _LEAST_RING_MM:
        raise PlanError(
            f"arm {kinematics.arm.name}: the pen gets to the paper only at {radii[0]:.1f} mm from the base"
            f" axis, in a ring less than {_LEAST_RING_MM:g} mm wide; widen the joint limits, or check d_mm,"
            " a_mm and workspace.inner_radius_mm"
        )
    outer = radii[-1] + _EDGE_MM
    nodes = outer - np.linspace(np.sqrt(outer - radii[0]), np.sqrt(_EDGE_MM), _NODES) ** 2
    nodes[0], nodes[-1] = radii[0], radii[-1]
    keep = np.concatenate(([True], np.diff(radii) > 1e-6))
    guess = np.column_stack([np.interp(nodes, radii[keep], column) for column in configurations[keep].T])
    configuration_path, exact = project(kinematics, guess, on_ray(nodes))
    if not exact.all():
        raise PlanError(f"arm {kinematics.arm.name}: the configuration map did not converge")
    return nodes, polished_configuration_path(cost, nodes, on_ray(nodes), configuration_path)


def _require_upright(kinematics: Kinematics) -> None:
    """Refuse an arm that says its couplings or its chain keep the pen upright when they do not."""
    arm = kinematics.arm
    if arm.pen.hold not in (PenHold.COUPLING, PenHold.CONSTRUCTION):
        return
    configurations = np.random.default_rng(0).uniform(
        kinematics.independent_of(arm.minimum),
        kinematics.independent_of(arm.maximum),
        (_UPRIGHT_PROBES, kinematics.n_independent),
    )
    tilt = float(np.degrees(np.arccos(np.clip(-kinematics.tool_axis(configurations)[:, 2], -1.0, 1.0))).max())
    if tilt > _UPRIGHT_DEG:
        raise ArmFileError(
            arm.name,
            [
                f"pen.hold is '{arm.pen.hold}', but the joints leave pen.tool_axis up to"
                f" {tilt:.1f} degrees from straight down: correct the coupling, the DH rows or"
                " pen.tool_axis, or let the planner hold the pen with 'tool_axis' or 'free'"
            ],
        )
