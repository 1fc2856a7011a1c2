"""A simulated arm: its joints follow their set points as well as its servos can."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from hardware.clock import Clock
from hardware.compensation.servo_values import own_calibration
from hardware.measurements import Measurements
from planner.arms.arm import SERVO_LAG_S, Arm, Joint
from planner.arms.slack import half_slack
from planner.arrays import FloatArray
from planner.errors import HardwareError

_STOP_ALLOWANCE = 1e-6
"""How far beyond a limit, in rad or mm, a set point may be before the simulated joint hits its end stop."""
_SETTLED_LAGS = 10


class Servos(StrEnum):
    """What the simulated joints are moved by."""

    IDEAL = "ideal"
    """Nothing between them and their set points but their limits of speed."""
    REAL = "real"
    """Those of an arm that need not be as its file says: commanded by the file, they do what the arm makes of it, with
    resolution, dead band, backlash and lag."""


@dataclass(frozen=True, eq=False, slots=True)
class Recording:
    """What a simulated arm was commanded to do and what it did.

    times_s: (n,) clock time of each set point. set_points and positions: (n, n_joints), rad or mm, where the joints
    were to be and where they were when the command came. Each `flush` adds a row with the last set point and where the
    joints came to rest.
    """

    times_s: FloatArray
    set_points: FloatArray
    positions: FloatArray


class Recorder:
    """A recording being made."""

    def __init__(self, n_joints: int) -> None:
        self._n_joints = n_joints
        self._times_s: list[float] = []
        self._set_points: list[FloatArray] = []
        self._positions: list[FloatArray] = []

    def __len__(self) -> int:
        return len(self._times_s)

    def add(self, time_s: float, set_point: FloatArray, positions: FloatArray) -> None:
        """A row. The arrays are kept as they are."""
        self._times_s.append(time_s)
        self._set_points.append(set_point)
        self._positions.append(positions)

    @property
    def recording(self) -> Recording:
        shape = (len(self), self._n_joints)
        return Recording(
            np.array(self._times_s), np.reshape(self._set_points, shape), np.reshape(self._positions, shape)
        )


class SimulatedArm:
    """A driver that moves nothing and records everything."""

    ahead_s = 0.0

    def __init__(self, arm: Arm, clock: Clock, servos: Servos = Servos.IDEAL, true_arm: Arm | None = None) -> None:
        """true_arm: what real servos move, where that is not as `arm` says; what is recorded are its joints.

        Errors: ArmFileError where real servos are asked for that the arm file does not describe."""
        self._arm, self._clock = arm, clock
        self._servos = _KINDS[servos](arm, true_arm or arm)
        self._room = half_slack(arm) if servos is Servos.REAL else np.zeros(arm.n_joints)
        self._target: FloatArray | None = None
        self._at_s = 0.0
        self._recorder = Recorder(arm.n_joints)

    @property
    def recording(self) -> Recording:
        return self._recorder.recording

    def measure(self) -> None:
        """It does in any case."""

    def measured(self) -> Measurements:
        recording = self.recording
        return Measurements(recording.times_s - recording.times_s[:1], recording.positions)

    @property
    def connected(self) -> bool:
        return self._target is not None

    def open(self) -> None:
        """There is no line."""

    def connect(self, pose: FloatArray) -> None:
        self._refuse_beyond_stops(pose)
        self._target = pose.copy()
        self._servos.stand_at(self._target)
        self._at_s = self._clock.now_s()

    def send(self, positions: FloatArray, duration_s: float) -> None:
        """The joints move at once, as fast as they can: no controller spreads the move over `duration_s`."""
        self._refuse_beyond_stops(positions)
        self._follow(self._connected_target())
        self._target = positions.copy()
        self._record()

    def executed(self) -> int:
        return len(self._recorder)

    def flush(self) -> None:
        target = self._connected_target()
        self._clock.sleep_until(self._clock.now_s() + self._servos.settling_s(target))
        self._follow(target)
        self._record()

    def emergency_stop(self) -> None:
        if self._target is not None:
            self._follow(self._target)
            self._target = self._servos.positions.copy()

    def close(self) -> None:
        self._target = None

    def statistics(self) -> list[str]:
        return []

    def _connected_target(self) -> FloatArray:
        if self._target is None:
            raise HardwareError("the simulated arm is not connected")
        return self._target

    def _follow(self, target: FloatArray) -> None:
        """Let the joints move as they have since the last call."""
        now_s = self._clock.now_s()
        self._servos.run(target, now_s - self._at_s)
        self._at_s = now_s

    def _record(self) -> None:
        self._recorder.add(self._at_s, self._connected_target(), self._servos.positions.copy())

    def _refuse_beyond_stops(self, positions: FloatArray) -> None:
        room = self._room + _STOP_ALLOWANCE  # slack that is taken up moves no joint
        beyond = (positions < self._arm.minimum - room) | (positions > self._arm.maximum + room)
        if beyond.any():
            joint = int(np.argmax(beyond))
            value = self._arm.to_file_units(positions)[joint]
            raise HardwareError(
                f"joint {self._arm.joints[joint].name} was sent to {value:g} "
                f"{self._arm.joints[joint].file_unit}, into its end stop"
            )


class _Ideal:
    """Joints that are limited in speed and in nothing else. positions: (n_joints,), rad or mm."""

    def __init__(self, arm: Arm, true_arm: Arm) -> None:
        self._max_velocity = arm.max_velocity
        self.positions = np.zeros(arm.n_joints)

    def stand_at(self, positions: FloatArray) -> None:
        self.positions = positions.copy()

    def run(self, target: FloatArray, duration_s: float) -> None:
        furthest = self._max_velocity * duration_s
        self.positions = self.positions + np.clip(target - self.positions, -furthest, furthest)

    def settling_s(self, target: FloatArray) -> float:
        return float(np.max(np.abs(target - self.positions) / self._max_velocity))


class _Real:
    """Joints behind servos: a pulse or a count of limited resolution, a motor that runs after what is beyond the dead
    band with a lag, and gears with play, inside which the joint stays where it is. Told as `arm` says, moved as
    `true_arm` is. positions: (n_joints,), rad or mm."""

    def __init__(self, arm: Arm, true_arm: Arm) -> None:
        self._assumed, self._true = own_calibration(arm), own_calibration(true_arm)
        self._step, self._dead_band, self._play = self._true.steps, self._true.dead_bands, self._true.backlash
        self._max_velocity = true_arm.max_velocity
        self._lag_s = np.array([_lag_s(joint) for joint in true_arm.joints])
        self._motors = self.positions = np.zeros(arm.n_joints)

    def stand_at(self, positions: FloatArray) -> None:
        self._motors = self.positions = self._true.to_joints(self._rounded(positions))

    def run(self, target: FloatArray, duration_s: float) -> None:
        furthest = self._max_velocity * duration_s
        share = -np.expm1(-duration_s / self._lag_s)
        self._motors = self._motors + np.clip(share * self._pull(target), -furthest, furthest)
        self.positions = np.clip(self.positions, self._motors - self._play / 2, self._motors + self._play / 2)

    def settling_s(self, target: FloatArray) -> float:
        away = np.abs(self._true.to_joints(self._rounded(target)) - self._motors)
        return float(np.max(away / self._max_velocity + _SETTLED_LAGS * self._lag_s))

    def _rounded(self, target: FloatArray) -> FloatArray:
        commanded = self._assumed.to_servos(target)
        step = np.where(self._step > 0, self._step, 1.0)
        return np.where(self._step > 0, np.round(commanded / step) * step, commanded)

    def _pull(self, target: FloatArray) -> FloatArray:
        """How far each motor wants to go."""
        commanded = self._rounded(target)
        wanted = self._true.to_joints(commanded)
        dead_band = np.abs(self._true.to_joints(commanded + self._dead_band) - wanted)
        error = wanted - self._motors
        pull: FloatArray = np.sign(error) * np.maximum(np.abs(error) - dead_band, 0.0)
        return pull


def _lag_s(joint: Joint) -> float:
    """As the file says; what hobby servos have where it says nothing."""
    known = joint.servo or joint.bus
    return SERVO_LAG_S if known is None or known.lag_s == 0 else known.lag_s


_KINDS: dict[Servos, Callable[[Arm, Arm], _Ideal | _Real]] = {
    Servos.IDEAL: _Ideal,
    Servos.REAL: _Real,
}
