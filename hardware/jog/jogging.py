"""Moving one joint of an arm at a time, slowly, and what is found by it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hardware.clock import Clock
from hardware.compensation.servo_values import Calibration, own_calibration
from hardware.drivers.driver import Driver
from hardware.jog import adjustments
from hardware.motion.slow_transfer import straight
from hardware.motion.stopping import lift
from hardware.motion.tip import tip_at
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import UsageError

_RATE_HZ = 50.0
_SLOWER = 2.0
"""Slower than on the way to a drawing: somebody's hand may be at the joint."""
_ROUNDING = 1e-6


class Jogging:
    """An arm at the end of a driver, and its description as it is known by now.

    The driver goes on speaking of positions as the file had them; `values` are what servos are really told, so that a
    changed direction or zero moves nothing by itself. Methods that move may raise HardwareError; those that are refused
    raise UsageError, and have moved and changed nothing. `watch` is called with every set point, and may raise what
    ends it all.
    """

    def __init__(
        self,
        arm: Arm,
        driver: Driver,
        calibration: Calibration,
        clock: Clock,
        watch: Callable[[], None] = lambda: None,
    ) -> None:
        """Errors: UsageError where a servo reaches no position within the limits of its joint."""
        self.arm = arm
        self._file, self._driver, self._clock, self._watch = arm, driver, clock, watch
        self._calibration = calibration
        self._at = start_of(arm, calibration)
        self._below: FloatArray | None = None
        self.joint = 0

    @property
    def values(self) -> FloatArray:
        """(n_joints,) us or counts."""
        return self._calibration.to_servos(self._at)

    @property
    def unit(self) -> str:
        """Of the values: us or counts."""
        return self._calibration.unit

    @property
    def pen_is_up(self) -> bool:
        """By `pen_up`, so that `pen_down` brings it back."""
        return self._below is not None

    @property
    def positions(self) -> FloatArray:
        """(n_joints,) rad or mm, as the arm is known by now."""
        return own_calibration(self.arm).to_joints(self.values)

    @property
    def tip_mm(self) -> FloatArray:
        """(3,) in the frame of the paper, as the arm is known by now."""
        return tip_at(self.arm, self.positions).position_mm

    def start(self) -> None:
        """Attach the servos at the park pose, or in the middle of their ranges."""
        self._driver.connect(self._at)

    def choose(self, name: str) -> None:
        """By name, or by number from 1 on."""
        names = [joint.name for joint in self.arm.joints]
        if name not in names and not (name.isdecimal() and 1 <= int(name) <= len(names)):
            raise UsageError(f"there is no joint '{name}'; there are {', '.join(names)}")
        self.joint = names.index(name) if name in names else int(name) - 1

    def move(self, by: float) -> None:
        """The chosen joint, by so many deg or mm."""
        self._go(float(self.positions[self.joint]) + by * self._per)

    def go_to(self, position: float) -> None:
        """The chosen joint, to so many deg or mm."""
        self._go(position * self._per)

    def pen_up(self) -> None:
        """Straight up by the lift height, from where `pen_down` brings it back to."""
        if self._below is not None:
            raise UsageError("the pen is up already")
        outside = (self.positions < self.arm.minimum - _ROUNDING) | (self.positions > self.arm.maximum + _ROUNDING)
        if outside.any():
            raise UsageError(f"joint {self.arm.joints[int(np.argmax(outside))].name} stands outside its limits")
        height_mm = float(self.tip_mm[2]) + self.arm.pen.lift_mm
        way = lift(self.arm, self.positions, _RATE_HZ * _SLOWER, height_mm)
        if not len(way):
            raise UsageError("the arm cannot rise straight up from here; move its joints one by one")
        below = self._at
        self._play(self._as_in_file(way))
        self._below = below

    def pen_down(self) -> None:
        """Back to where `pen_up` left from, the joints all together."""
        if self._below is None:
            raise UsageError("the pen is down; move joints one by one to bring it lower")
        self._play(straight(self._file, self._at, self._below, _RATE_HZ * _SLOWER))
        self._below = None

    def turn_round(self) -> None:
        """The chosen joint turned the wrong way; it stands where it is thought to."""
        self.arm = adjustments.turned_round(self.arm, self.joint, float(self.positions[self.joint]))

    def stands_at(self, position: float) -> None:
        """The chosen joint stands at so many deg or mm now."""
        here = float(self.positions[self.joint])
        self.arm = adjustments.standing_at(self.arm, self.joint, here, position * self._per)

    def limit(self, *, upper: bool) -> None:
        """The chosen joint goes no further than where it stands."""
        self.arm = adjustments.limited(self.arm, self.joint, float(self.positions[self.joint]), upper=upper)

    def park_here(self) -> None:
        """The arm is parked as it stands now."""
        self.arm = adjustments.parked(self.arm, self.positions)

    def on_card(self, card_mm: float) -> None:
        """The pen just holds a card of that thickness on the paper."""
        self.arm = adjustments.paper_under(self.arm, self.tip_mm, card_mm)

    def lines(self) -> list[str]:
        """Where every joint stands, the chosen one marked, and the pen."""
        unit, values, positions = self.unit, self.values, self.positions
        rows = []
        for k, joint in enumerate(self.arm.joints):
            low, at, high = np.array([joint.minimum, positions[k], joint.maximum]) / joint.per_file_unit
            rows.append(
                f"{'>' if k == self.joint else ' '} {joint.name}: {values[k]:.1f} {unit}, {at:.2f} {joint.file_unit} "
                f"({low:.1f} to {high:.1f})"
            )
        x, y, height = self.tip_mm
        return [*rows, f"  pen: {x:.1f}, {y:.1f} mm, {height:.1f} mm over the paper"]

    @property
    def _per(self) -> float:
        return self.arm.joints[self.joint].per_file_unit

    def _go(self, position: float) -> None:
        k, joint = self.joint, self.arm.joints[self.joint]
        here = float(self.positions[k])
        outwards = (position > max(joint.maximum, here)) or (position < min(joint.minimum, here))
        if outwards and not (joint.minimum - _ROUNDING <= position <= joint.maximum + _ROUNDING):
            low, at, high = np.array([joint.minimum, position, joint.maximum]) / joint.per_file_unit
            raise UsageError(
                f"joint {joint.name}: {at:.2f} {joint.file_unit} is outside its limits of {low:.2f} to {high:.2f}"
            )
        goal = self.positions
        goal[k] = position
        at = self._at.copy()
        at[k] = self._as_in_file(goal[None])[0, k]
        self._play(straight(self._file, self._at, at, _RATE_HZ * _SLOWER))
        self._below = None

    def _as_in_file(self, positions: FloatArray) -> FloatArray:
        """Positions (n, n_joints) of the arm as known by now, as the file had them. Errors: UsageError where a servo
        may not be told that."""
        values = np.empty_like(positions)
        for k, joint in enumerate(self.arm.joints):
            low, high = self._calibration.ranges[k]
            values[:, k] = [adjustments.told(self.arm, k, at) for at in positions[:, k].tolist()]
            beyond = (values[:, k] < low - _ROUNDING) | (values[:, k] > high + _ROUNDING)
            if beyond.any():
                raise UsageError(
                    f"joint {joint.name}: its servo would be at {values[np.argmax(beyond), k]:.1f}, outside its range "
                    f"of {low:.1f} to {high:.1f} {self._calibration.unit}"
                )
        return self._calibration.to_joints(np.clip(values, *self._calibration.ranges.T))

    def _play(self, way: FloatArray) -> None:
        start_s = self._clock.now_s()
        for k, positions in enumerate(way):
            self._clock.sleep_until(start_s + k / _RATE_HZ - self._driver.ahead_s)
            self._watch()
            self._driver.send(positions, 1 / _RATE_HZ)
            self._at = positions
        self._driver.flush()


def start_of(arm: Arm, calibration: Calibration) -> FloatArray:
    """(n_joints,) where jogging begins, rad or mm: the park pose, or the middle of where joints may and servos can go.
    Errors: UsageError where there is nothing of a joint's."""
    if arm.park is not None:
        return np.array(arm.park)
    low, high = np.maximum(arm.minimum, calibration.reach[:, 0]), np.minimum(arm.maximum, calibration.reach[:, 1])
    if (low > high).any():
        joint = arm.joints[int(np.argmax(low > high))]
        raise UsageError(f"joint {joint.name}: its servo reaches no position within its limits; correct the arm file")
    middle: FloatArray = (low + high) / 2
    return middle
