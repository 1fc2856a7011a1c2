"""The configuration path from the inner to the outer radius: a dynamic program over samples of all configurations finds
it, dynamic programs over ever closer neighbours polish it.

The cost of a path has a corner wherever a joint stands still, and the best paths consist of corners: each stretch
of radii has its resting joint. A solver that follows derivatives needs the corners rounded, and then stops at the first
path where rounding leaves nothing to gain. So the neighbours are configurations in which one joint has one of a few
values that are the same at all radii: a joint can rest over any stretch, exactly.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.kinematics.projection import Pins, project
from planner.redundancy.configuration_tests import usable_configurations
from planner.redundancy.cost import ConfigurationCost
from planner.redundancy.samples import COARSE_STEP_MM

_SPACINGS = (0.4, 0.1, 0.02)
"""Between the values of a joint, in shares of the time that the arm takes for a step between sampled radii."""
_NEIGHBOURS = 3
_ROUNDS = 2
"""With each spacing. More of them would lower the cost by less than a percent; a course is usable after any."""
_PROJECTION_STEPS = 4


def cheapest_configuration_path(
    cost: ConfigurationCost, radii_mm: FloatArray, samples: list[FloatArray], wanted: BoolArray | None = None
) -> tuple[FloatArray, FloatArray]:
    """The run of neighbouring radii that reaches furthest with no jump, and in it the cheapest configurations.

    radii_mm: (n,) increasing; samples: usable configurations (m, n_independent) at each radius, some at least at one;
    wanted: (n,) the radii that count, where not all do. Returns radii (k,) and configurations (k, n_independent).
    """
    arm = cost.kinematics.arm
    lengths = np.diff(radii_mm)
    shares = np.concatenate((lengths[:1], lengths[:-1] + lengths[1:], lengths[-1:])) / 2
    reward = np.full(len(radii_mm), 1e6)  # a radius more counts above any cost
    if wanted is not None:
        reward[wanted] *= 1e3
    costs: list[FloatArray] = []
    came_from: list[FloatArray] = []
    before = np.empty((0, arm.n_joints))
    for index, configurations in enumerate(samples):
        joints = arm.complete(configurations)
        density, squares = cost.configurations(configurations)
        own = density * shares[index] - reward[index]
        back = np.full(len(configurations), -1)
        if len(before) and len(configurations):
            length = float(lengths[index - 1])
            steps = joints[:, None] - before[None]
            through = costs[-1] + cost.steps(steps, length, squares[:, None]) * length
            longest_step_s = length / (0.25 * arm.workspace.min_tip_speed_mm_s)
            through[(np.abs(steps) / arm.max_velocity).max(axis=2) > longest_step_s] = np.inf
            best = through.argmin(axis=1)
            cheapest = through[np.arange(len(configurations)), best]
            better = cheapest < 0.0
            back[better] = best[better]
            own[better] += cheapest[better]
        costs.append(own)
        came_from.append(back)
        before = joints
    _, index = min((float(each.min()), index) for index, each in enumerate(costs) if len(each))
    choice = int(costs[index].argmin())
    chosen: list[tuple[float, FloatArray]] = []
    while choice >= 0:
        chosen.append((float(radii_mm[index]), samples[index][choice]))
        choice = int(came_from[index][choice])
        index -= 1
    chosen.reverse()
    return np.array([radius for radius, _ in chosen]), np.array([configuration for _, configuration in chosen])


def polished_configuration_path(
    cost: ConfigurationCost, along_mm: FloatArray, tips_mm: FloatArray, configuration_path: FloatArray
) -> FloatArray:
    """(n, n_independent) the path that costs least among those near a first one, all usable and exact like it.

    along_mm: (n,) increasing, the radii or the way along another line; tips_mm: (n, 3) its points; configuration_path:
    (n, n_independent) with no jump.
    """
    if cost.kinematics.n_redundant == 0:
        return configuration_path
    for share in _SPACINGS:
        spacing_s = share * COARSE_STEP_MM / cost.quickness_mm_s
        for _ in range(_ROUNDS):
            before = configuration_path
            reached, configuration_path = cheapest_configuration_path(
                cost, along_mm, _neighbours(cost, tips_mm, configuration_path, spacing_s)
            )
            if len(reached) < len(tips_mm) or np.array_equal(configuration_path, before):
                configuration_path = before
                break
    return configuration_path


def _neighbours(
    cost: ConfigurationCost, tips_mm: FloatArray, configuration_path: FloatArray, spacing_s: float
) -> list[FloatArray]:
    """At each tip the configuration of the path first, then usable ones nearby in which one joint (not the first,
    which the azimuth decides) is at a multiple of its spacing: spacing_s times its speed."""
    kinematics, arm = cost.kinematics, cost.kinematics.arm
    matrix, constant = arm.coupling_matrix
    joints = arm.complete(configuration_path)[:, 1:]
    spacing = spacing_s * arm.max_velocity[1:]
    values = (np.round(joints / spacing)[..., None] + np.arange(-_NEIGHBOURS, _NEIGHBOURS + 1)) * spacing[:, None]
    count = values[0].size
    at = np.repeat(np.arange(len(tips_mm)), count)
    rows = np.tile(np.repeat(matrix[1:], values.shape[-1], axis=0), (len(tips_mm), 1))
    fixed = np.tile(np.repeat(constant[1:], values.shape[-1]), len(tips_mm))
    found, exact = project(
        kinematics,
        configuration_path[at],
        tips_mm[at],
        iterations=_PROJECTION_STEPS,
        pins=Pins(rows, values.ravel() - fixed),
    )
    away_s = (np.abs(arm.complete(found)[:, 1:] - joints[at]) / arm.max_velocity[1:]).max(axis=1)
    good = exact & (away_s < 3 * _NEIGHBOURS * spacing_s)
    good[good] = usable_configurations(kinematics, found[good])
    return [
        np.concatenate(
            (
                configuration_path[index : index + 1],
                found[index * count : (index + 1) * count][good[index * count : (index + 1) * count]],
            )
        )
        for index in range(len(tips_mm))
    ]


def smoothed_configuration_path(configuration_path: FloatArray, deviation: float) -> FloatArray:
    """(n, n_independent) running means with binomial weights of that standard deviation, in nodes: they round the
    corners. The ends stay, a joint at rest stays at rest, and none leaves the range that it had."""
    for _ in range(max(round(2 * deviation**2), 1)):  # each pass has variance 1/2
        configuration_path = np.concatenate(
            (
                configuration_path[:1],
                (configuration_path[:-2] + 2 * configuration_path[1:-1] + configuration_path[2:]) / 4,
                configuration_path[-1:],
            )
        )
    return configuration_path
