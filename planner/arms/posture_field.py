"""The posture field: one posture for each distance from the base axis, chosen once for an arm.

An arm whose first joint turns about the vertical meets a paper point (rho, azimuth) with the posture of
(rho, 0) turned by the azimuth. So the arm's redundancy has to be decided along one line only, from
the inner to the outer radius, and the choice is global: a dynamic programme over sampled postures finds
the branch and the coarse course, an NLP over all radii at once polishes it. The same paper point
is then always drawn with the same posture, whatever the drawing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import casadi
import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

from planner.arms.arm import Arm, JointKind, PenHold
from planner.arms.kinematics import Kinematics, kinematics_of
from planner.arms.projection import joint_scale, project
from planner.arrays import BoolArray, FloatArray, IntArray
from planner.errors import ArmFileError, PlanError

_COARSE_STEP_MM = 6.0
_DRAWN = 20_000
_SAMPLES = 120
_FEW = 25
_UPRIGHT_PROBES = 16
_NODES = 49
_EDGE_MM = 1.0
"""The field is laid out over sqrt(outer + this - rho): near the stretched arm postures go with that root."""

_LIMIT_MARGIN = 0.02
"""Share of a joint's range that the field keeps from each end, so that lifts and blends have room."""


@dataclass(frozen=True, eq=False)
class PostureField:
    """Postures along the ray of azimuth zero, pen on the paper.

    radii_mm: (n,) increasing; postures: (n, n_free) of the free joints, rad or mm.
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
    def _spline(self) -> BSpline:
        return make_interp_spline(self._coordinate(self.radii_mm)[::-1], self.postures[::-1], k=5)

    def _coordinate(self, radius_mm: FloatArray) -> FloatArray:
        edge = float(self.radii_mm[-1]) + _EDGE_MM
        inside = np.clip(radius_mm, self.radii_mm[0] - 0.5 * _EDGE_MM, self.radii_mm[-1] + 0.5 * _EDGE_MM)
        coordinate: FloatArray = np.sqrt(edge - inside)
        return coordinate

    def reference(self, tip_mm: FloatArray) -> FloatArray:
        """(n, n_free) field postures at tips (n, 3), whatever their height; outside the field's radii,
        those of its edge."""
        radius = np.hypot(tip_mm[:, 0], tip_mm[:, 1])
        reference: FloatArray = np.ascontiguousarray(self._spline(self._coordinate(radius)))
        reference[:, 0] += np.arctan2(tip_mm[:, 1], tip_mm[:, 0])
        return reference

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


def slowest_direction_mm_s(kinematics: Kinematics, free: FloatArray) -> FloatArray:
    """(n,) tip speed that is possible in every direction, with the pen held as it is held and joint speeds of unit
    norm in units of their limits: the smallest singular value of the tip's J diag(speed), restricted to motions
    that do not turn the tool axis. Zero at a singular posture."""
    _, jacobian = kinematics.task_and_jacobian(free)
    jacobian = jacobian * joint_scale(kinematics)
    tip, pointing = jacobian[:, :3], jacobian[:, 3:]
    if pointing.shape[1]:
        tip = tip - tip @ np.linalg.pinv(pointing) @ pointing
    singular: FloatArray = np.asarray(np.linalg.svd(tip, compute_uv=False))
    return singular[:, 2]


@lru_cache(maxsize=16)
def posture_field(arm: Arm) -> PostureField:
    """The field of an arm. Errors: PlanError where the arm cannot have one, ArmFileError where its file contradicts
    itself."""
    first = arm.joints[0]
    if first.kind is not JointKind.REVOLUTE or 0 not in arm.free_joints:
        raise PlanError(f"arm {arm.name}: method 'path' needs a first joint that turns about the vertical axis")
    if any(other == 0 for coupling in arm.couplings for other, _ in coupling.coefficients):
        raise PlanError(f"arm {arm.name}: joint {first.name} turns the arm about the vertical axis;"
                        " no coupling may depend on it")
    kinematics = kinematics_of(arm)
    _require_upright(kinematics)
    radii, samples = _sampled_rays(kinematics)
    course = _coarse_course(kinematics, radii, samples)
    if course is None:
        raise PlanError(f"arm {arm.name}: no posture within the joint limits puts the pen on the paper"
                        f" at {arm.workspace.inner_radius_mm:g} mm or more from the base axis")
    return _polished(kinematics, *_stretched_to_edges(kinematics, *course))


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


def _usable(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    """(n,) whether postures on the ray keep limits with a margin, stay clear of singularities and above the paper."""
    arm = kinematics.arm
    joints = arm.complete(free)
    room = _LIMIT_MARGIN * (arm.maximum - arm.minimum)
    inside = ((joints >= arm.minimum + room) & (joints <= arm.maximum - room)).all(axis=1)
    clear = slowest_direction_mm_s(kinematics, free) >= arm.workspace.min_tip_speed_mm_s
    above = (kinematics.nodes_mm(free)[:, :-1, 2] >= -1e-6).all(axis=1)
    usable: BoolArray = inside & clear & above
    if arm.pen.hold is PenHold.TOOL_AXIS:
        usable &= kinematics.tool_axis(free)[:, 2] < -0.5  # the task alone would let the pen point straight up
    return usable


def _on_ray(radii_mm: FloatArray) -> FloatArray:
    return np.column_stack((radii_mm, np.zeros((len(radii_mm), 2))))


def _sampled_rays(kinematics: Kinematics) -> tuple[FloatArray, list[FloatArray]]:
    """Usable postures at each of some radii: the random postures that come closest are projected onto the ray, and
    those found at one radius are carried on to its neighbours where few were found."""
    arm = kinematics.arm
    random = np.random.default_rng(20220601)  # any seed will do; the same one always, for the same field
    low, high = kinematics.free_of(arm.minimum), kinematics.free_of(arm.maximum)
    drawn = random.uniform(low, high, (_DRAWN, kinematics.n_free))
    task, _ = kinematics.task_and_jacobian(drawn)
    drawn[:, 0] -= np.arctan2(task[:, 1], task[:, 0])  # turned about the base so that the tip is above the ray
    if arm.pen.hold is PenHold.TOOL_AXIS:
        downward = kinematics.tool_axis(drawn)[:, 2] < 0
        drawn, task = drawn[downward], task[downward]
    reach, height = np.hypot(task[:, 0], task[:, 1]), task[:, 2]
    tilt = np.abs(task[:, 3:]).sum(axis=1)
    longest = float(reach.max(initial=0.0)) + _COARSE_STEP_MM
    radii = np.arange(arm.workspace.inner_radius_mm, max(longest, arm.workspace.inner_radius_mm + 1), _COARSE_STEP_MM)
    count = min(_SAMPLES, len(drawn))
    closest = [np.argpartition(np.hypot(reach - radius, height) / longest + tilt, count - 1)[:count]
               for radius in radii]
    pools: list[FloatArray] = [np.empty((0, kinematics.n_free)) for _ in radii]
    _add_usable(kinematics, pools, np.repeat(np.arange(len(radii)), count), drawn[np.concatenate(closest)], radii, 20)
    for order in (range(1, len(radii)), range(len(radii) - 2, -1, -1)):
        for index in order:
            neighbour = pools[index - order.step][:_SAMPLES]
            if len(pools[index]) < _FEW and len(neighbour):
                _add_usable(kinematics, pools, np.full(len(neighbour), index), neighbour, radii, 12)
    return radii, pools


def _add_usable(kinematics: Kinematics, pools: list[FloatArray], rays: IntArray, start: FloatArray, radii: FloatArray,
                iterations: int) -> None:
    """Project postures onto the rays they are meant for, and add what is usable to the rays' pools."""
    found, exact = project(kinematics, start, _on_ray(radii[rays]), iterations=iterations)
    found, rays = found[exact], rays[exact]
    joints = [kinematics.arm.joints[index] for index in kinematics.arm.free_joints]
    turning = np.array([joint.kind is JointKind.REVOLUTE for joint in joints])
    if not kinematics.arm.couplings:  # whole turns mean nothing where no other joint counts them
        middle = kinematics.free_of((kinematics.arm.minimum + kinematics.arm.maximum) / 2)
        turns = np.round((found - middle) / (2 * np.pi)) * turning
        found = found - 2 * np.pi * turns
    found[:, 0] = (found[:, 0] + np.pi) % (2 * np.pi) - np.pi
    usable = _usable(kinematics, found)
    for ray in np.unique(rays[usable]).tolist():
        pools[ray] = np.concatenate((pools[ray], found[usable & (rays == ray)]))


def _centredness(arm: Arm, free: FloatArray) -> FloatArray:
    """(n,) mean square distance of the joints from the middle of their ranges, 1 at the limits."""
    joints = arm.complete(free)
    middle, half = (arm.maximum + arm.minimum) / 2, (arm.maximum - arm.minimum) / 2
    cost: FloatArray = (((joints - middle) / half) ** 2).mean(axis=1)
    return cost


def _coarse_course(kinematics: Kinematics, radii: FloatArray, samples: list[FloatArray]
                   ) -> tuple[FloatArray, FloatArray] | None:
    """The run of neighbouring radii that reaches furthest with no jump, and in it the cheapest postures."""
    scale = joint_scale(kinematics)
    slowest_mm_s = 0.25 * kinematics.arm.workspace.min_tip_speed_mm_s
    longest_step_s = _COARSE_STEP_MM / slowest_mm_s
    reward = 1e3  # a radius more counts above any cost
    costs: list[FloatArray] = []
    came_from: list[FloatArray] = []
    for index, postures in enumerate(samples):
        own = _centredness(kinematics.arm, postures) - reward
        back = np.full(len(postures), -1)
        if index and len(samples[index - 1]) and len(postures):
            steps = np.abs(postures[:, None] - samples[index - 1][None]) / scale
            step_s = steps.max(axis=2)
            through = costs[-1] + 20.0 * (steps ** 2).sum(axis=2) / longest_step_s
            through[step_s > longest_step_s] = np.inf
            best = through.argmin(axis=1)
            better = through[np.arange(len(postures)), best] < 0.0
            back[better] = best[better]
            own[better] += through[np.arange(len(postures)), best][better]
        costs.append(own)
        came_from.append(back)
    ends = [(float(cost.min()), index) for index, cost in enumerate(costs) if len(cost)]
    if not ends:
        return None
    _, index = min(ends)
    choice = int(costs[index].argmin())
    chosen: list[tuple[float, FloatArray]] = []
    while choice >= 0:
        chosen.append((float(radii[index]), samples[index][choice]))
        choice = int(came_from[index][choice])
        index -= 1
    chosen.reverse()
    return np.array([radius for radius, _ in chosen]), np.array([posture for _, posture in chosen])


def _stretched_to_edges(kinematics: Kinematics, radii: FloatArray, postures: FloatArray
                        ) -> tuple[FloatArray, FloatArray]:
    """The course with its two ends moved out to where postures stop being usable."""

    def furthest(radius: float, posture: FloatArray, step: float, bound: float) -> tuple[float, FloatArray]:
        while abs(step) > 0.01:
            further = min(max(radius + step, bound), np.inf) if step < 0 else radius + step
            if further == radius:
                break
            found, exact = project(kinematics, posture[None], _on_ray(np.array([further])))
            if exact[0] and _usable(kinematics, found)[0]:
                radius, posture = further, found[0]
            else:
                step /= 2
        return radius, posture

    inner, first = furthest(float(radii[0]), postures[0], -_COARSE_STEP_MM / 2,
                            kinematics.arm.workspace.inner_radius_mm)
    outer, last = furthest(float(radii[-1]), postures[-1], _COARSE_STEP_MM / 2, 0.0)
    return (np.concatenate(([inner], radii, [outer])), np.concatenate((first[None], postures, last[None])))


def _polished(kinematics: Kinematics, radii: FloatArray, postures: FloatArray) -> PostureField:
    """The NLP over all radii at once: smooth, away from the limits, exactly on the paper."""
    arm = kinematics.arm
    outer = radii[-1] + _EDGE_MM
    coordinate = np.linspace(np.sqrt(outer - radii[0]), np.sqrt(_EDGE_MM), _NODES)
    nodes = outer - coordinate ** 2
    nodes[0], nodes[-1] = radii[0], radii[-1]
    keep = np.concatenate(([True], np.diff(radii) > 1e-6))
    guess = np.column_stack([np.interp(nodes, radii[keep], column) for column in postures[keep].T])
    scale = joint_scale(kinematics)
    q = casadi.SX.sym("q", kinematics.n_free, _NODES)
    task = casadi.Function("task", [kinematics.free], [kinematics.task])
    matrix, constant = arm.coupling_matrix
    joints = casadi.DM(matrix) @ q + casadi.repmat(casadi.DM(constant), 1, _NODES)
    middle, half = (arm.maximum + arm.minimum) / 2, (arm.maximum - arm.minimum) / 2
    spread = (joints - casadi.repmat(casadi.DM(middle), 1, _NODES)) / casadi.repmat(casadi.DM(half), 1, _NODES)
    step = (q[:, 1:] - q[:, :-1]) / casadi.repmat(casadi.DM(scale), 1, _NODES - 1)
    bend = step[:, 1:] - step[:, :-1]
    objective = (casadi.sumsqr(spread) / _NODES
                 + 20.0 * _NODES * casadi.sumsqr(step) + 2.0 * _NODES ** 3 * casadi.sumsqr(bend))
    tasks = casadi.horzcat(*[task(q[:, k]) for k in range(_NODES)])
    others = joints[1:, :]
    room = (_LIMIT_MARGIN * (arm.maximum - arm.minimum))[1:]
    solver = casadi.nlpsol("field", "ipopt", {
        "x": casadi.vec(q), "f": objective, "g": casadi.vertcat(casadi.vec(tasks), casadi.vec(others))},
        {"ipopt.print_level": 0, "ipopt.sb": "yes", "print_time": False, "ipopt.max_iter": 200})
    target = kinematics.task_target(_on_ray(nodes)).ravel()
    low = np.tile(arm.minimum[1:] + room, _NODES)
    high = np.tile(arm.maximum[1:] - room, _NODES)
    solution = solver(x0=guess.ravel(), lbg=np.concatenate((target, low)), ubg=np.concatenate((target, high)))
    refined = np.array(solution["x"]).reshape(_NODES, -1) if solver.stats()["success"] else guess
    refined, exact = project(kinematics, refined, _on_ray(nodes))
    if not exact.all():
        raise PlanError(f"arm {arm.name}: the posture field did not converge")
    return PostureField(arm, nodes, refined)
