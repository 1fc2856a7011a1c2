"""The configuration map of an arm that turns over its paper: one configuration for each distance from the base axis.

An arm whose first joint turns about the paper's normal meets a paper point (rho, azimuth) with the configuration of
(rho, 0) turned by the azimuth. So the arm's redundancy has to be decided along one line only, from
the inner to the outer radius, and the choice is global: a dynamic program over sampled configurations finds
the branch and a coarse configuration path, further ones over its neighbours polish it. The same paper point
is then always drawn with the same configuration, whatever the drawing. Where the paper does not lie quite square to the
base axis, the map is that of a level paper of the same height, and the configurations nearest to it are taken.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from planner.arms.arm import Arm
from planner.arms.paper_pose import PaperPose
from planner.arrays import BoolArray, FloatArray
from planner.errors import PlanError
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
from planner.redundancy.paper_samples import starts_for_paper
from planner.redundancy.refusal import no_usable_configuration
from planner.redundancy.requirements import require_drawing_arm
from planner.redundancy.samples import (
    COARSE_STEP_MM,
    on_ray,
    sampled_rays,
    stretched_to_edges,
)
from planner.settings import ConfigurationWeights
from planner.spline import evaluate_at, interpolating

_FEWEST_RADII = 2
"""Sampled radii that a further branch has to add."""
_NODES = 81
_LEAST_RING_MM = 1.0
"""No configuration path can be laid through less."""
_ROUNDING_MM = 2.0
"""Corners, where one joint comes to rest and another starts, become bends: the standard deviation of the weights."""
_SIDES_RAD, _AZIMUTHS = np.pi / 2 * np.array([0.0, 1.0, -1.0, 2.0]), 37
_TURNED, _NEAREST, _OFTEN = 8000, 1600, 0.3
"""Random configurations, and those of them nearest to the paper that tell where the arm turns to; and what counts as
often, of the azimuth that most of them are at."""
_DEGREE = 5
_EDGE_MM = 1.0
"""The map is laid out over sqrt(outer + this - rho): near the stretched arm configurations go with that root."""


@dataclass(frozen=True, eq=False)
class RingMap:
    """Configurations along a ray from the base axis, pen on the paper, which is taken to be level.

    kinematics: of the arm; level: of the arm on the level paper that the map was made for, whose x axis is that ray.
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

    @property
    def box_mm(self) -> FloatArray:
        """(2, 2) corners that all of what the map reaches lies between."""
        axis_mm = self.arm.paper.T_paper_base[:2, 3]
        outer = float(self.radii_mm[-1])
        return np.stack((axis_mm - outer, axis_mm + outer))

    @property
    def arrays(self) -> dict[str, FloatArray]:
        """What `of` makes the same map of."""
        return {"radii_mm": self.radii_mm, "configurations": self.configurations}

    @staticmethod
    def of(kinematics: Kinematics, level: Kinematics, arrays: Mapping[str, FloatArray]) -> RingMap:
        return RingMap(kinematics, level, arrays["radii_mm"], arrays["configurations"])

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

    @cached_property
    def _azimuths_rad(self) -> tuple[float, float]:
        """Between which the first joint's limits let the arm turn, somewhere amid the map."""
        at_zero = self.home[0] - self._ray_rad
        return float(self.arm.minimum[0] - at_zero), float(self.arm.maximum[0] - at_zero)

    @property
    def _ray_rad(self) -> float:
        return self.level.arm.paper.yaw_rad

    @cached_property
    def facing_rad(self) -> float:
        """The azimuth that the arm is never more than half a turn away from: ahead where the first joint's limits let
        it, else the middle of what they allow."""
        low, high = self._azimuths_rad
        return float(np.clip(0.0, low + np.pi, high - np.pi)) if high - low >= 2 * np.pi else (low + high) / 2

    @property
    def ahead_rad(self) -> float:
        """The azimuth, of the four along the paper's sides, with most of what the arm turns to on its two sides: that
        of the x axis, if it is as good as any."""
        low, high = self._azimuths_rad
        around = np.linspace(-np.pi / 2, np.pi / 2, _AZIMUTHS) + _SIDES_RAD[:, None]
        turned = around - 2 * np.pi * np.round((around - self.facing_rad) / (2 * np.pi))
        return float(_SIDES_RAD[((turned >= low) & (turned <= high)).sum(axis=1).argmax()])

    def polar(self, tip_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distances from the base axis (...) and azimuths about it (...), within half a turn of where the arm faces, of
        points of the paper's frame (..., 3)."""
        at_mm = tip_mm if self.arm.paper.is_base_plane else self.arm.paper.to_base(tip_mm)
        azimuth = np.arctan2(at_mm[..., 1], at_mm[..., 0])
        turns = np.round((azimuth - self.facing_rad) / (2 * np.pi))
        return np.hypot(at_mm[..., 0], at_mm[..., 1]), azimuth - 2 * np.pi * turns

    def reference(self, tip_mm: FloatArray) -> FloatArray:
        """(n, n_independent) the map's configurations at tips (n, 3), whatever their height; outside the map's radii,
        those of its edge."""
        radius, azimuth = self.polar(tip_mm)
        sigma = self._sigma(radius)
        cell = np.clip(sigma.astype(np.int64), 0, len(self.radii_mm) - 2)
        reference = evaluate_at(self._controls, cell, sigma - cell, _DEGREE)
        reference[:, 0] += azimuth - self._ray_rad
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


def levelled(kinematics: Kinematics, ray_rad: float) -> Kinematics:
    """The arm on a level paper of the same height at the base axis, whose x axis is the ray that a map is made for, as
    of `ray_of`: as it is, where its paper is the base plane and the arm turns to its x axis. A paper that is higher is
    a first row that is shorter."""
    arm = kinematics.arm
    if arm.paper.is_base_plane and ray_rad == 0.0:
        return kinematics
    T = arm.paper.T_base_paper
    height_mm = float(T[2, 3] + (T[0, 2] * T[0, 3] + T[1, 2] * T[1, 3]) / T[2, 2])
    first = replace(arm.joints[0], d_mm=arm.joints[0].d_mm - height_mm)
    return Kinematics(replace(arm, joints=(first, *arm.joints[1:]), paper=PaperPose(yaw_rad=ray_rad)))


def ray_of(kinematics: Kinematics) -> float:
    """An azimuth about the base axis, in radians, that the limits of the first joint leave to the arm: zero if it is
    one, else the middle of all."""
    starts = starts_for_paper(kinematics, _TURNED, _NEAREST)
    if not len(starts):
        return 0.0
    tips = kinematics.arm.paper.to_base(kinematics.tip_mm(starts))
    azimuths = np.arctan2(tips[:, 1], tips[:, 0])
    counts, _ = np.histogram(azimuths, _AZIMUTHS, (-np.pi, np.pi))
    if counts[_AZIMUTHS // 2] >= _OFTEN * counts.max():
        return 0.0
    return float(np.angle(np.exp(1j * azimuths).mean()))


def ring_branches(kinematics: Kinematics, level: Kinematics, weights: ConfigurationWeights) -> tuple[RingMap, ...]:
    """The map that reaches over most radii, then maps in other branches, each over as many as it can of those that
    the ones before leave out. Nearly all arms have one. level: of the arm on a level paper. This takes a while:
    `ArmModel` keeps them. Errors: PlanError where the arm cannot have one, ArmFileError where its file contradicts
    itself."""
    cost, radii, samples = choice_of_configurations(level, weights)
    left_out = np.array([len(configurations) > 0 for configurations in samples])
    branches: list[RingMap] = []
    while not branches or left_out.sum() >= _FEWEST_RADII:
        nodes, configuration_path = sharp_configuration_path(cost, radii, samples, left_out if branches else None)
        covered = (radii > nodes[0] - COARSE_STEP_MM) & (radii < nodes[-1] + COARSE_STEP_MM)
        is_ring = nodes[-1] - nodes[0] >= _LEAST_RING_MM
        if not is_ring and not branches:
            raise PlanError(
                f"arm {level.arm.name}: the pen gets to the paper only at {nodes[0]:.1f} mm from the base"
                f" axis, in a ring less than {_LEAST_RING_MM:g} mm wide; widen the joint limits, or check d_mm,"
                " a_mm and workspace.inner_radius_mm"
            )
        if branches and (not is_ring or (left_out & covered).sum() < _FEWEST_RADII):
            break
        branches.append(RingMap(kinematics, level, nodes, _rounded(level, nodes, configuration_path)))
        left_out &= ~covered
    return tuple(branches)


def _rounded(kinematics: Kinematics, nodes: FloatArray, configuration_path: FloatArray) -> FloatArray:
    """The path (n, n_independent) without its corners, exact again; as it is, where that would lead off its branch."""
    spacing_mm = (nodes[-1] - nodes[0]) / (_NODES - 1)
    smooth = smoothed_configuration_path(configuration_path, _ROUNDING_MM / spacing_mm)
    rounded, exact = project(kinematics, smooth, on_ray(nodes))
    return rounded if exact.all() else configuration_path


def choice_of_configurations(
    kinematics: Kinematics, weights: ConfigurationWeights
) -> tuple[ConfigurationCost, FloatArray, list[FloatArray]]:
    """What a map is chosen from, and by what: the cost, some radii (n,) and usable configurations (m, n_independent) at
    each.
    Errors: as `ring_branches`."""
    require_drawing_arm(kinematics)
    radii, samples = sampled_rays(kinematics)
    if not any(len(configurations) for configurations in samples):
        raise no_usable_configuration(kinematics)
    quickness = float(np.median(slowest_direction_mm_s(kinematics, np.concatenate(samples))))
    return ConfigurationCost(kinematics, weights, quickness, float(radii[-1])), radii, samples


def sharp_configuration_path(
    cost: ConfigurationCost, radii_mm: FloatArray, samples: list[FloatArray], wanted: BoolArray | None = None
) -> tuple[FloatArray, FloatArray]:
    """The map before its corners are rounded: its radii (n,), a ring of no width where there is hardly one, and
    configurations (n, n_independent)."""
    kinematics = cost.kinematics
    radii, configurations = stretched_to_edges(
        kinematics, *cheapest_configuration_path(cost, radii_mm, samples, wanted)
    )
    while radii[-1] - radii[0] >= _LEAST_RING_MM:
        outer = radii[-1] + _EDGE_MM
        nodes = outer - np.linspace(np.sqrt(outer - radii[0]), np.sqrt(_EDGE_MM), _NODES) ** 2
        nodes[0], nodes[-1] = radii[0], radii[-1]
        keep = np.concatenate(([True], np.diff(radii) > 1e-6))
        guess = np.column_stack([np.interp(nodes, radii[keep], column) for column in configurations[keep].T])
        configuration_path, exact = project(kinematics, guess, on_ray(nodes))
        if exact.all():
            return nodes, polished_configuration_path(cost, nodes, on_ray(nodes), configuration_path)
        # Between two samples that are no neighbours after all the path ends; a further branch may go on from there.
        run = _longest_run(exact)
        radii, configurations = nodes[run], configuration_path[run]
    return radii[:1], configurations[:1]


def _longest_run(flags: BoolArray) -> slice:
    """The longest run of true values, or else the first value."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(np.int8), [0]))))
    starts, ends = edges[0::2], edges[1::2]
    longest = int((ends - starts).argmax()) if len(starts) else None
    return slice(0, 1) if longest is None else slice(int(starts[longest]), int(ends[longest]))
