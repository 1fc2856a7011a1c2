"""TOPP-RA slowed until its samples keep all limits: what one does who has that library alone, and a jerk limit.

The profile without jerk limits, on the planner's own joint path, is played evenly slower until the differences of its
samples keep velocity, acceleration and jerk limits, from rest to rest.
"""

from __future__ import annotations

import numpy as np

from benchmarks.targets.toppra_profile import Profile
from planner.arrays import FloatArray
from planner.kinematics.limits import Limits

_ROUNDS = 100
_AT_LEAST = 1.001
"""What a round slows by at least: the samples lie elsewhere then, and may need no more."""
_HELD = 3


def slowed(profile: Profile, rate_hz: float) -> FloatArray:
    """Samples (n, n_joints) at the rate, both ends included."""
    slower = 1.0
    for _ in range(_ROUNDS):
        n_periods = max(int(np.ceil(profile.duration_s * slower * rate_hz - 1e-9)), 1)
        samples = profile.at(np.linspace(0.0, profile.duration_s, n_periods + 1))[0]
        needed = slowing_needed(samples, profile.path.limits, rate_hz)
        if needed <= 1.0:
            break
        slower *= max(needed, _AT_LEAST)
    return samples


def slowing_needed(samples: FloatArray, limits: Limits, rate_hz: float) -> float:
    """How much slower samples (n, n_joints) that are held at both ends have to be played to keep all limits; 1 or less
    where they do."""
    difference = np.concatenate((_HELD * [samples[0]], samples, _HELD * [samples[-1]]))
    needed = 0.0
    for order, limit in enumerate((limits.velocity, limits.acceleration, limits.jerk), 1):
        difference = np.diff(difference, axis=0) * rate_hz
        needed = max(needed, float((np.abs(difference) / limit).max()) ** (1 / order))
    return needed
