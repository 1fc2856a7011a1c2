"""Usable configurations along a ray from the base axis, the paper's x axis: what a ring's map is chosen from."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import PenHold
from planner.arrays import FloatArray, IntArray
from planner.kinematics.chain import Kinematics
from planner.kinematics.projection import project, turning_joints
from planner.redundancy.configuration_tests import usable_configurations

COARSE_STEP_MM = 6.0
"""Distance between the radii at which configurations are sampled."""

_EDGE_STEP_MM = 0.05
"""How closely the edge of what is usable is found."""

_DRAWN = 20_000
_SAMPLES = 120
_FEW = 25


def on_ray(radii_mm: FloatArray) -> FloatArray:
    return np.column_stack((radii_mm, np.zeros((len(radii_mm), 2))))


def starts_for_rays(kinematics: Kinematics) -> tuple[FloatArray, IntArray, FloatArray]:
    """Radii (n,) of some rays, and random configurations (m, n_independent) with the rays (m,) that they come close
    to."""
    arm = kinematics.arm
    random = np.random.default_rng(20220601)  # any seed will do; the same one always, for the same map
    low, high = kinematics.independent_of(arm.minimum), kinematics.independent_of(arm.maximum)
    drawn = random.uniform(low, high, (_DRAWN, kinematics.n_independent))
    task, _ = kinematics.task_and_jacobian(drawn)
    drawn[:, 0] -= np.arctan2(task[:, 1], task[:, 0])  # turned about the base so that the tip is above the ray
    if arm.pen.hold is PenHold.TOOL_AXIS:
        downward = kinematics.tool_axis(drawn)[:, 2] < 0
        drawn, task = drawn[downward], task[downward]
    reach, height = np.hypot(task[:, 0], task[:, 1]), task[:, 2]
    tilt = np.abs(task[:, 3:]).sum(axis=1)
    longest = float(reach.max(initial=0.0)) + COARSE_STEP_MM
    radii = np.arange(arm.workspace.inner_radius_mm, max(longest, arm.workspace.inner_radius_mm + 1), COARSE_STEP_MM)
    if not len(drawn):
        return radii, np.empty(0, dtype=np.int64), drawn
    count = min(_SAMPLES, len(drawn))
    closest = [
        np.argpartition(np.hypot(reach - radius, height) / longest + tilt, count - 1)[:count] for radius in radii
    ]
    return radii, np.repeat(np.arange(len(radii)), count), drawn[np.concatenate(closest)]


def sampled_rays(kinematics: Kinematics) -> tuple[FloatArray, list[FloatArray]]:
    """Usable configurations at each of some radii: the random configurations that come closest are projected onto the
    ray, and those found at one radius are carried on to its neighbours where few were found."""
    radii, rays, starts = starts_for_rays(kinematics)
    pools: list[FloatArray] = [np.empty((0, kinematics.n_independent)) for _ in radii]
    _add_usable(kinematics, pools, rays, starts, radii, 20)
    for order in (range(1, len(radii)), range(len(radii) - 2, -1, -1)):
        for index in order:
            neighbour = pools[index - order.step][:_SAMPLES]
            if len(pools[index]) < _FEW and len(neighbour):
                _add_usable(kinematics, pools, np.full(len(neighbour), index), neighbour, radii, 12)
    return radii, pools


def _add_usable(
    kinematics: Kinematics,
    pools: list[FloatArray],
    rays: IntArray,
    start: FloatArray,
    radii: FloatArray,
    iterations: int,
) -> None:
    """Project configurations onto the rays they are meant for, and add what is usable to the rays' pools."""
    found, exact = project(kinematics, start, on_ray(radii[rays]), iterations=iterations)
    found, rays = turned_into_range(kinematics, found[exact]), rays[exact]
    usable = usable_configurations(kinematics, found)
    for ray in np.unique(rays[usable]).tolist():
        pools[ray] = np.concatenate((pools[ray], found[usable & (rays == ray)]))


def turned_into_range(kinematics: Kinematics, found: FloatArray) -> FloatArray:
    """Configurations (n, n_independent) with whole turns taken off where they mean nothing."""
    arm = kinematics.arm
    counted = {other for coupling in arm.couplings for other, _ in coupling.coefficients}
    free = turning_joints(kinematics) & [index not in counted for index in arm.independent_joints]
    middle = kinematics.independent_of((arm.minimum + arm.maximum) / 2)
    turned: FloatArray = found - 2 * np.pi * np.round((found - middle) / (2 * np.pi)) * free
    return turned


def stretched_to_edges(
    kinematics: Kinematics, radii: FloatArray, configurations: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """The configuration path carried on from its two ends to where configurations stop being usable, with all that it
    passes on the way: what lies between its configurations has to be near them."""
    inner, first = _walk(kinematics, float(radii[0]), configurations[0], -COARSE_STEP_MM / 2)
    outer, last = _walk(kinematics, float(radii[-1]), configurations[-1], COARSE_STEP_MM / 2)
    return np.concatenate((inner[::-1], radii, outer)), np.concatenate((first[::-1], configurations, last))


def _walk(
    kinematics: Kinematics, radius: float, configuration: FloatArray, step: float
) -> tuple[FloatArray, FloatArray]:
    """Radii (n,) and configurations (n, n_independent) from one configuration on, not itself, as far as they stay
    usable; steps in mm, inwards where negative, become smaller towards the edge."""
    least = kinematics.arm.workspace.inner_radius_mm
    radii, configurations = [], [configuration]
    while abs(step) > _EDGE_STEP_MM:
        further = max(radius + step, least)
        if further == radius:
            break
        found, exact = project(kinematics, configurations[-1][None], on_ray(np.array([further])))
        if exact[0] and usable_configurations(kinematics, found)[0]:
            radius = further
            radii.append(radius)
            configurations.append(found[0])
        else:
            step /= 2
    return np.array(radii), np.array(configurations[1:]).reshape(-1, kinematics.n_independent)
