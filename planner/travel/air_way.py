"""Ways through the air: from rest to rest in joint space, with tip and links clear of the paper and of each other.

Joints move along straight lines, if need be by way of a configuration from which all of the arm is seen to stay clear.
"""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits, within_limits
from planner.redundancy.configuration_tests import LINK_CLEARANCE_MM
from planner.travel.ruckig_profile import rest_to_rest
from planner.travel.travel_choice import coordinate_limits
from planner.travel.travel_moves import TravelRules

_VIAS = 2000
_PROBES = np.linspace(0.0, 1.0, 41)


def air_way(
    kinematics: Kinematics, limits: Limits, rules: TravelRules, start: FloatArray, end: FloatArray
) -> FloatArray:
    """(k, n_independent) corners of the quickest clear way: straight, or by one of some random configurations; the
    start alone where none is clear."""
    arm = kinematics.arm
    if _is_clear(kinematics, rules, start, end):
        return np.stack((start, end))
    vias = np.random.default_rng(20220601).uniform(arm.minimum, arm.maximum, (_VIAS, arm.n_joints))
    independent = kinematics.independent_of(vias)
    joints = arm.complete(independent)
    within = within_limits(arm, joints, slack=0.0)
    ends = arm.complete(np.stack((start, end)))
    times = sum((np.abs(joints - corner) / limits.velocity).max(axis=1) for corner in ends)
    for via in independent[within][np.argsort(np.asarray(times)[within], kind="stable")]:
        if _is_clear(kinematics, rules, start, via) and _is_clear(kinematics, rules, via, end):
            return np.stack((start, via, end))
    return start[None]


def _is_clear(kinematics: Kinematics, rules: TravelRules, start: FloatArray, end: FloatArray) -> bool:
    """Whether the tip stays above the clearance, the links above the paper and apart on the straight line."""
    line = start + _PROBES[:, None] * (end - start)
    heights = kinematics.nodes_mm(line)[:, :, 2]
    above = heights[:, -1].min() >= rules.clearance_mm and heights[:, :-1].min() >= 0.0
    return bool(above and kinematics.clearance.least_mm(line)[0].min() >= LINK_CLEARANCE_MM)


def air_leg(limits: Limits, rules: TravelRules, start: FloatArray, end: FloatArray) -> FloatArray:
    """(n, n_joints) samples from rest to rest along a straight line in joint space."""
    along = coordinate_limits(np.abs(end - start), limits)
    motion = rest_to_rest(1.0, float(along.velocity), float(along.acceleration), float(along.jerk))
    count = int(np.ceil(motion.duration_s * rules.rate_hz - 1e-9))
    way = motion.at(np.linspace(0.0, motion.duration_s, count + 1))
    samples: FloatArray = start + way[:, None] * (end - start)
    return samples
