"""Usable postures along the ray of azimuth zero: what a posture field is chosen from."""

from __future__ import annotations

import numpy as np

from planner.arms.arm import JointKind, PenHold
from planner.arms.kinematics import Kinematics
from planner.arms.link_clearance import link_clearance
from planner.arms.projection import joint_scale, project
from planner.arms.quickest_lift import quickest_lifts
from planner.arrays import BoolArray, FloatArray, IntArray

COARSE_STEP_MM = 6.0
"""Distance between the radii at which postures are sampled."""

LIMIT_MARGIN = 0.02
"""Share of a joint's range that postures keep from each end, so that lifts and blends have room."""

LINK_ROOM_MM = 1.0
"""Room that postures leave between links that have a thickness, for the same."""

_NEAR_LIMIT = 3.0
"""A limit is near where so many lifts would pass it."""
_CURVED = 1.1
"""Allowance for the curvature of a lift."""

_EDGE_STEP_MM = 0.05
"""How closely the edge of what is usable is found."""

_DRAWN = 20_000
_SAMPLES = 120
_FEW = 25


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


def usable_postures(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    """(n,) whether postures on the ray keep limits with a margin, stay clear of singularities and above the paper, and
    keep their links apart, raised too."""
    arm = kinematics.arm
    joints = arm.complete(free)
    room = LIMIT_MARGIN * (arm.maximum - arm.minimum)
    inside = ((joints >= arm.minimum + room) & (joints <= arm.maximum - room)).all(axis=1)
    clear = slowest_direction_mm_s(kinematics, free) >= arm.workspace.min_tip_speed_mm_s
    above = (kinematics.nodes_mm(free)[:, :-1, 2] >= -1e-6).all(axis=1)
    usable: BoolArray = inside & clear & above & _links_apart(kinematics, free)
    if arm.pen.hold is PenHold.TOOL_AXIS:
        usable &= kinematics.tool_axis(free)[:, 2] < -0.5  # the task alone would let the pen point straight up
    usable[usable] = _may_be_raised(kinematics, free[usable], joints[usable])
    if link_clearance(arm).names:
        lifts = quickest_lifts(kinematics, arm.max_jerk, free[usable])
        usable[usable] = _links_apart(kinematics, free[usable] + arm.pen.lift_mm * lifts)
    return usable


def _links_apart(kinematics: Kinematics, free: FloatArray) -> BoolArray:
    apart: BoolArray = link_clearance(kinematics.arm).least_mm(free)[0] >= LINK_ROOM_MM
    return apart


def _may_be_raised(kinematics: Kinematics, free: FloatArray, joints: FloatArray) -> BoolArray:
    """(n,) whether joint limits leave room for the arm's quickest lift, to first order. Only postures near a limit, for
    the cheaper lift in the least joint time, are looked at closely."""
    arm = kinematics.arm
    matrix, _ = arm.coupling_matrix

    def has_room(lifts: FloatArray, rows: BoolArray, times: float) -> BoolArray:
        raised = joints[rows] + times * arm.pen.lift_mm * (lifts @ matrix.T)
        kept: BoolArray = np.all((raised >= arm.minimum) & (raised <= arm.maximum), axis=1)
        return kept

    _, jacobian = kinematics.task_and_jacobian(free)
    lifts = np.linalg.pinv(jacobian * joint_scale(kinematics))[:, :, 2] * joint_scale(kinematics)
    room = has_room(lifts, np.ones(len(free), dtype=np.bool_), _NEAR_LIMIT)
    close = ~room
    if close.any():
        room[close] = has_room(quickest_lifts(kinematics, arm.max_jerk, free[close]), close, _CURVED)
    return room


def on_ray(radii_mm: FloatArray) -> FloatArray:
    return np.column_stack((radii_mm, np.zeros((len(radii_mm), 2))))


def sampled_rays(kinematics: Kinematics) -> tuple[FloatArray, list[FloatArray]]:
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
    longest = float(reach.max(initial=0.0)) + COARSE_STEP_MM
    radii = np.arange(arm.workspace.inner_radius_mm, max(longest, arm.workspace.inner_radius_mm + 1), COARSE_STEP_MM)
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
    found, exact = project(kinematics, start, on_ray(radii[rays]), iterations=iterations)
    found, rays = found[exact], rays[exact]
    joints = [kinematics.arm.joints[index] for index in kinematics.arm.free_joints]
    turning = np.array([joint.kind is JointKind.REVOLUTE for joint in joints])
    if not kinematics.arm.couplings:  # whole turns mean nothing where no other joint counts them
        middle = kinematics.free_of((kinematics.arm.minimum + kinematics.arm.maximum) / 2)
        turns = np.round((found - middle) / (2 * np.pi)) * turning
        found = found - 2 * np.pi * turns
    turn = (kinematics.arm.minimum[0] + kinematics.arm.maximum[0]) / 2 - np.pi
    found[:, 0] = (found[:, 0] - turn) % (2 * np.pi) + turn
    usable = usable_postures(kinematics, found)
    for ray in np.unique(rays[usable]).tolist():
        pools[ray] = np.concatenate((pools[ray], found[usable & (rays == ray)]))


def stretched_to_edges(kinematics: Kinematics, radii: FloatArray, postures: FloatArray
                        ) -> tuple[FloatArray, FloatArray]:
    """The course carried on from its two ends to where postures stop being usable, with all that it passes on the way:
    what lies between its postures has to be near them."""
    inner, first = _walk(kinematics, float(radii[0]), postures[0], -COARSE_STEP_MM / 2)
    outer, last = _walk(kinematics, float(radii[-1]), postures[-1], COARSE_STEP_MM / 2)
    return np.concatenate((inner[::-1], radii, outer)), np.concatenate((first[::-1], postures, last))


def _walk(kinematics: Kinematics, radius: float, posture: FloatArray, step: float) -> tuple[FloatArray, FloatArray]:
    """Radii (n,) and postures (n, n_free) from one posture on, not itself, as far as they stay usable; steps in mm,
    inwards where negative, become smaller towards the edge."""
    least = kinematics.arm.workspace.inner_radius_mm
    radii, postures = [], [posture]
    while abs(step) > _EDGE_STEP_MM:
        further = max(radius + step, least)
        if further == radius:
            break
        found, exact = project(kinematics, postures[-1][None], on_ray(np.array([further])))
        if exact[0] and usable_postures(kinematics, found)[0]:
            radius = further
            radii.append(radius)
            postures.append(found[0])
        else:
            step /= 2
    return np.array(radii), np.array(postures[1:]).reshape(-1, kinematics.n_free)
