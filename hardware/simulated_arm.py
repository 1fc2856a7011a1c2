"""An arm without metal: its joints run after their set points as fast as their speed limits allow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hardware.clock import Clock
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import HardwareError

_STOP_ALLOWANCE = 1e-6
"""How far beyond a limit, in rad or mm, a set point may be before the simulated joint hits its end stop."""


@dataclass(frozen=True, eq=False, slots=True)
class Recording:
    """What a simulated arm was told and what it did.

    times_s: (n,) clock time of each set point. set_points and positions: (n, n_joints), rad or mm,
    where the joints were to be and where they stood when told.
    """

    times_s: FloatArray
    set_points: FloatArray
    positions: FloatArray


class SimulatedArm:
    """A driver that moves nothing and remembers everything."""

    def __init__(self, arm: Arm, clock: Clock) -> None:
        self._arm, self._clock = arm, clock
        self._target: FloatArray | None = None
        self._position = np.zeros(arm.n_joints)
        self._at_s = 0.0
        self._times_s: list[float] = []
        self._set_points: list[FloatArray] = []
        self._positions: list[FloatArray] = []

    @property
    def recording(self) -> Recording:
        shape = (len(self._times_s), self._arm.n_joints)
        return Recording(np.array(self._times_s), np.reshape(self._set_points, shape),
                         np.reshape(self._positions, shape))

    @property
    def connected(self) -> bool:
        return self._target is not None

    def connect(self, start: FloatArray) -> None:
        self._refuse_beyond_stops(start)
        self._target = self._position = start.copy()
        self._at_s = self._clock.now_s()

    def send(self, positions: FloatArray) -> None:
        if self._target is None:
            raise HardwareError("the simulated arm is not connected")
        self._refuse_beyond_stops(positions)
        now_s = self._clock.now_s()
        furthest = self._arm.max_velocity * (now_s - self._at_s)
        self._position = self._position + np.clip(self._target - self._position, -furthest, furthest)
        self._target, self._at_s = positions.copy(), now_s
        self._times_s.append(now_s)
        self._set_points.append(self._target)
        self._positions.append(self._position)

    def close(self) -> None:
        self._target = None

    def _refuse_beyond_stops(self, positions: FloatArray) -> None:
        beyond = (positions < self._arm.minimum - _STOP_ALLOWANCE) | (positions > self._arm.maximum + _STOP_ALLOWANCE)
        if beyond.any():
            joint = int(np.argmax(beyond))
            value = self._arm.to_file_units(positions)[joint]
            raise HardwareError(f"joint {self._arm.joints[joint].name} was sent to {value:g} "
                                f"{self._arm.joints[joint].file_unit}, into its end stop")
