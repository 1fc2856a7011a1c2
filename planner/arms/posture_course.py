"""The course of postures from the inner to the outer radius: a dynamic programme over samples finds it, an NLP over
all radii at once polishes it."""

from __future__ import annotations

import casadi
import numpy as np

from planner.arms.posture_cost import PostureCost
from planner.arms.posture_samples import COARSE_STEP_MM, LIMIT_MARGIN, on_ray
from planner.arms.projection import joint_scale
from planner.arrays import FloatArray

_BEND = 0.02
"""Cost of a change of slope: keeps the course smooth where the other terms would leave it corners."""


def coarse_course(cost: PostureCost, radii_mm: FloatArray, samples: list[FloatArray]
                  ) -> tuple[FloatArray, FloatArray]:
    """The run of neighbouring radii that reaches furthest with no jump, and in it the cheapest postures.

    samples: usable postures (n, n_free) at each radius, some at least at one. Returns radii (k,) and postures
    (k, n_free).
    """
    arm = cost.kinematics.arm
    longest_step_s = COARSE_STEP_MM / (0.25 * arm.workspace.min_tip_speed_mm_s)
    reward = 1e6  # a radius more counts above any cost
    costs: list[FloatArray] = []
    came_from: list[FloatArray] = []
    before = np.empty((0, arm.n_joints))
    for postures in samples:
        joints = arm.complete(postures)
        own = cost.postures(postures) - reward
        back = np.full(len(postures), -1)
        if len(before) and len(postures):
            steps = joints[:, None] - before[None]
            through = costs[-1] + cost.steps(steps, COARSE_STEP_MM)
            through[(np.abs(steps) / arm.max_velocity).max(axis=2) > longest_step_s] = np.inf
            best = through.argmin(axis=1)
            cheapest = through[np.arange(len(postures)), best]
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
    return np.array([radius for radius, _ in chosen]), np.array([posture for _, posture in chosen])


def polished_course(cost: PostureCost, nodes_mm: FloatArray, guess: FloatArray) -> FloatArray:
    """(n, n_free) the course that costs least with all postures exactly on the paper and within limits.

    nodes_mm: (n,) increasing radii; guess: (n, n_free). Where the solver runs out of iterations its last iterate is
    returned, which is near the paper but not on it.
    """
    kinematics, arm = cost.kinematics, cost.kinematics.arm
    count, lengths = len(nodes_mm), np.diff(nodes_mm)
    per_posture = casadi.Function("posture", [kinematics.free], [
        kinematics.task, kinematics.joints[1:], cost.posture_symbol()]).map(count)
    q = casadi.MX.sym("q", kinematics.n_free, count)
    task, others, density = per_posture(q)
    steps = casadi.SX.sym("steps", arm.n_joints, count - 1)
    per_step = casadi.Function("steps", [steps], [cost.steps_symbol(steps, lengths)])
    matrix, _ = arm.coupling_matrix
    moved = casadi.DM(matrix) @ (q[:, 1:] - q[:, :-1])
    slope = (q[:, 1:] - q[:, :-1]) * casadi.DM(cost.quickness_mm_s / np.outer(joint_scale(kinematics), lengths))
    share = np.concatenate(([lengths[0]], lengths[:-1] + lengths[1:], [lengths[-1]])) / 2
    span = float(nodes_mm[-1] - nodes_mm[0])
    objective = (casadi.dot(density.T, casadi.DM(share)) + casadi.dot(per_step(moved).T, casadi.DM(lengths))) / span
    objective += _BEND * count * casadi.sumsqr(slope[:, 1:] - slope[:, :-1])
    solver = casadi.nlpsol("course", "ipopt", {
        "x": casadi.vec(q), "f": objective, "g": casadi.vertcat(casadi.vec(task), casadi.vec(others))},
        {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False, "ipopt.max_iter": 150})
    target = kinematics.task_target(on_ray(nodes_mm)).ravel()
    room = (LIMIT_MARGIN * (arm.maximum - arm.minimum))[1:]
    low, high = np.tile(arm.minimum[1:] + room, count), np.tile(arm.maximum[1:] - room, count)
    solution = solver(x0=guess.ravel(), lbg=np.concatenate((target, low)), ubg=np.concatenate((target, high)))
    course = np.array(solution["x"]).reshape(count, -1)
    return course if np.isfinite(course).all() else guess
