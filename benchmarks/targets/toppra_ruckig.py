"""TOPP-RA, then Ruckig from state to state: how MoveIt smooths a trajectory (`ruckig_traj_smoothing.cpp` of moveit2).

TOPP-RA's profile without jerk limits, on the planner's own joint path, is cut into states of position, velocity and
acceleration at even times; Ruckig, all joints synchronised, goes from each to the next within all limits, and never
sooner than the profile does. Where it finds no way, or the pen strays from the stroke by more than the tolerance, the
profile is stretched, as little as bisection finds; the best of a few spacings counts. MoveIt itself takes states 0.1 s
apart, and looks at no tolerance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from benchmarks.targets.toppra_profile import Profile
from planner.arrays import FloatArray
from planner.kinematics.chain import Kinematics

_SPACINGS_S = (0.025, 0.05, 0.1)
_STRETCHES = 1.08 ** np.arange(31)
_WITHIN = 1.0 - 1e-6
"""Ruckig refuses states that rounding puts beyond a limit."""
_BETWEEN_S = 0.01
"""How far apart in time the pen's place is looked at."""


@dataclass(frozen=True, eq=False, slots=True)
class Joined:
    """duration_s: NaN where Ruckig refuses. joints: (n, 3, n_joints) positions, velocities and accelerations on the
    way."""

    duration_s: float
    joints: FloatArray


def smoothed(profile: Profile, stroke: FloatArray, kinematics: Kinematics, tolerance_mm: float) -> Joined:
    """The best way within the tolerance of a stroke (n, 2); none, of NaN seconds, where there is none."""
    line = shapely.LineString(stroke)
    shapely.prepare(line)
    best = Joined(float("nan"), np.empty((0, 3, profile.path.joints.controls.shape[1])))
    for spacing_s in _SPACINGS_S:
        fails, works = -1, len(_STRETCHES)
        while works - fails > 1:
            tried = (fails + works) // 2
            if profile.duration_s * _STRETCHES[tried] >= best.duration_s:
                works = tried
                continue
            way = joined(profile, float(_STRETCHES[tried]), spacing_s)
            if np.isfinite(way.duration_s) and _strays_mm(way.joints, line, kinematics) <= tolerance_mm:
                works = tried
                best = best if best.duration_s <= way.duration_s else way
            else:
                fails = tried
    return best


def joined(profile: Profile, stretch: float, spacing_s: float) -> Joined:
    """Through states about so far apart in time, of the profile so many times as slow."""
    import ruckig

    limits = profile.path.limits
    count = max(round(profile.duration_s * stretch / spacing_s), 1)
    q, v, a = profile.at(np.linspace(0.0, profile.duration_s, count + 1))
    v = np.clip(v / stretch, -_WITHIN * limits.velocity, _WITHIN * limits.velocity)
    a = np.clip(a / stretch**2, -_WITHIN * limits.acceleration, _WITHIN * limits.acceleration)
    v[[0, -1]] = a[[0, -1]] = 0.0
    n_joints = q.shape[1]
    rig, given, way = ruckig.Ruckig(n_joints), ruckig.InputParameter(n_joints), ruckig.Trajectory(n_joints)
    given.max_velocity, given.max_acceleration, given.max_jerk = (
        limit.tolist() for limit in (limits.velocity, limits.acceleration, limits.jerk)
    )
    given.minimum_duration = profile.duration_s * stretch / count
    total_s, seen = 0.0, []
    for index in range(count):
        given.current_position, given.target_position = q[index].tolist(), q[index + 1].tolist()
        given.current_velocity, given.target_velocity = v[index].tolist(), v[index + 1].tolist()
        given.current_acceleration, given.target_acceleration = a[index].tolist(), a[index + 1].tolist()
        try:
            result = rig.calculate(given, way)
        except RuntimeError:
            result = ruckig.Result.Error
        if result not in (ruckig.Result.Working, ruckig.Result.Finished):
            return Joined(float("nan"), np.empty((0, 3, n_joints)))
        total_s += way.duration
        parts = max(int(np.ceil(way.duration / _BETWEEN_S)), 2)
        seen += [way.at_time(way.duration * part / parts) for part in range(parts)]
    return Joined(total_s, np.array(seen))


def _strays_mm(joints: FloatArray, line: shapely.LineString, kinematics: Kinematics) -> float:
    """How far the pen is off the stroke, sideways, at most."""
    tips = kinematics.tip_mm(kinematics.independent_of(joints[:, 0]))
    return float(shapely.distance(line, shapely.points(tips[:, :2])).max())
