"""Playing a program: every set point at its own time, and a pause, a stop or an emergency stop on request."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
from contextlib import suppress

import numpy as np

from hardware.clock import Clock
from hardware.drivers.driver import Driver, Halting
from hardware.motion.slow_transfer import slow_transfer
from hardware.motion.stopping import brake, lift, lower, set_off
from hardware.motion.tip import tip_at
from hardware.playback.confirmation import Confirmation
from hardware.playback.observer import Observer, Progress
from hardware.playback.program import Program
from hardware.playback.request import Request
from hardware.playback.result import End, PlaybackResult
from hardware.playback.sample_map import Piece, piece, sample_after
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import HardwareError, PlanError

_STALL_S = 0.1
"""After a stall longer than this the rest is played that much later: to catch up would be a jump."""
_PARKED_WITHIN = 1e-6
"""The arm is parked when it is this close to the park pose, in rad or mm."""


def play(
    program: Program,
    arm: Arm,
    driver: Driver,
    clock: Clock,
    *,
    request: Callable[[], Request] = lambda: Request.GO,
    observers: Sequence[Observer] = (),
    halts: Sequence[float] = (),
    waiting: Callable[[int], bool] = lambda halt: False,
) -> PlaybackResult:
    """Play `program`: set point k at k / rate after the start, later only by pauses and stalls.

    `request()` is asked before every set point. On a pause the arm brakes along the path and lifts the pen straight up;
    then it lowers the pen where it was and goes on from there. On a stop it brakes, where the driver can before it has
    played its queue, lifts and goes to the park pose. On an emergency stop it holds where it is. `halts` are samples of
    the trajectory, at rest away from the paper: the arm holds there for as long as `waiting(index of the halt)` is
    true, which is asked for every set point.

    If something other than the arm fails, such as an observer, the arm stops before the error is raised. The driver is
    closed in any case. Errors: HardwareError, and those of observers.
    """
    playing = _Playing(program, arm, driver, clock, request, observers)
    playing.hold_at(halts, waiting)
    try:
        driver.connect(program.park)
        playing.begin()
        try:
            end = playing.run()
            driver.flush()
        except _EmergencyStop:
            driver.emergency_stop()
            end = End.EMERGENCY_STOPPED
        except HardwareError:
            with suppress(HardwareError):
                playing.note_finished()
            raise
        except Exception:
            playing.tell_nobody()
            playing.stop()
            driver.flush()
            raise
        playing.note_finished()
        return playing.result(end)
    except KeyboardInterrupt:
        driver.emergency_stop()
        raise
    finally:
        driver.close()


class _EmergencyStop(Exception):
    """Someone asked for it."""


class _Playing:
    """Where playing is: `_next` is the index of the set point of the program to be sent next."""

    def __init__(
        self,
        program: Program,
        arm: Arm,
        driver: Driver,
        clock: Clock,
        request: Callable[[], Request],
        observers: Sequence[Observer],
    ) -> None:
        self._program, self._arm, self._driver, self._clock = program, arm, driver, clock
        self._request, self._observers = request, observers
        self._confirmation = Confirmation(program.stroke)
        self._next = self._sent = 0
        self._position, self._off_path = program.park, False
        self._begin_s = self._start_s = 0.0
        self._late_s = array("d")
        self._stalls = 0
        self._course: list[Piece] = []
        self._halts: dict[int, int] = {}
        self._waiting: Callable[[int], bool] = lambda halt: False

    def hold_at(self, halts: Sequence[float], waiting: Callable[[int], bool]) -> None:
        """Those of the halts that the program comes to; each is held at once."""
        sample, self._waiting = self._program.sample, waiting
        for halt, at in enumerate(halts):
            index = int(np.searchsorted(sample, at))
            if sample[0] <= at and index < len(sample) - self._program.retreat:
                self._halts[index] = halt

    def begin(self) -> None:
        """The driver is connected."""
        for observer in self._observers:
            observer.connected()
        self._begin_s = self._start_s = self._clock.now_s()
        self._plan(self._program.sample)

    def run(self) -> End:
        while self._next < len(self._program.positions):
            match self._request():
                case Request.GO if self._next in self._halts:
                    self._hold(self._halts.pop(self._next))
                case Request.GO:
                    self._send(self._program.positions[self._next])
                    self._come_to(self._next)
                case Request.PAUSE:
                    self._pause()
                case _:
                    self.stop()
                    return End.STOPPED
        return End.PLAYED

    def tell_nobody(self) -> None:
        self._observers = ()

    def stop(self) -> None:
        """Brake, lift, park; where no way to the park pose is found the arm holds with its pen up."""
        if isinstance(self._driver, Halting):
            self._halt(self._driver)
        elif self._parked():
            return
        else:
            self._come_to_rest()
        self._send_all(lift(self._arm, self._position, self._program.rate_hz))
        try:
            way = slow_transfer(self._arm, self._position, self._program.park, self._program.rate_hz)
        except PlanError:
            return
        self._rested()
        self._send_all(way)

    def note_finished(self) -> None:
        """Tell of the strokes that have been drawn, as far as the driver knows."""
        executed = self._driver.executed()
        for stroke in self._confirmation.confirm(executed):
            for observer in self._observers:
                observer.finished(stroke)
        for observer in self._observers:
            observer.reached(executed, self._sent)

    def result(self, end: End) -> PlaybackResult:
        late = np.percentile(self._late_s, (50, 99, 100)).tolist() if self._late_s else (0.0, 0.0, 0.0)
        return PlaybackResult(
            end,
            self._next,
            len(self._program.positions),
            self._clock.now_s() - self._begin_s,
            (late[0], late[1], late[2]),
            self._stalls,
            float(tip_at(self._arm, self._position).position_mm[2]),
            self._parked() and end is not End.EMERGENCY_STOPPED,
            tuple(self._driver.statistics()),
        )

    def _parked(self) -> bool:
        return np.allclose(self._position, self._program.park, rtol=0.0, atol=_PARKED_WITHIN)

    def _hold(self, halt: int) -> None:
        """Rest until nobody is awaited any more, or somebody wants something else."""
        self._rested()
        while self._request() is Request.GO and self._waiting(halt):
            self._send(self._position)
            self.note_finished()
            self._tell_progress(paused=True)
        self._plan(self._program.sample[self._next :])

    def _pause(self) -> None:
        """Rest with the pen up until the request changes; if it is to go on, be back at full pace."""
        at = self._come_to_rest()
        resting, rate_hz = self._position, self._program.rate_hz
        self._send_all(lift(self._arm, resting, rate_hz))
        lowering = lower(self._arm, resting, rate_hz)[1:]
        self._rested()
        while (request := self._request()) is Request.PAUSE:
            self._send(self._position)  # a controller that hears nothing would take the host for dead
            self.note_finished()
            self._tell_progress(paused=True)
        if request is not Request.GO:
            self._off_path = True
            return
        if not self._next:
            self._send_all(lowering)
            self._plan(self._program.sample)
            return
        ramp = set_off(self._arm, self._program.positions, at, rate_hz)
        ahead = np.concatenate(
            (np.full(len(lowering), float(at)), ramp.at, np.arange(ramp.end + 1.0, len(self._program.positions)))
        )
        self._plan(self._samples(ahead))
        self._send_all(lowering)
        self._send_all(ramp.points)
        self._come_to(ramp.end)

    def _come_to_rest(self) -> int:
        """Brake from the set point sent last; the one where the arm then rests."""
        if not self._next or self._off_path:
            self._plan(self._program.sample[max(self._next - 1, 0)][None])
            return max(self._next - 1, 0)
        ramp = brake(self._arm, self._program.positions, self._next - 1, self._program.rate_hz)
        self._plan(self._samples(ramp.at))
        self._send_all(ramp.points)
        self._come_to(ramp.end)
        self._rested()  # working out the lift now costs nothing but a moment's rest
        return ramp.end

    def _halt(self, driver: Halting) -> None:
        """Rest before the set points are reached that the driver has been sent."""
        self._position = driver.halt()
        self.note_finished()
        self._sent = driver.executed()
        self._confirmation.cut_short(self._sent)
        self._next = self._confirmation.index + 1
        here = sample_after(self._course, self._sent)
        self._plan(np.array([self._program.sample[0] if here is None else here]))

    def _plan(self, samples: FloatArray) -> None:
        """The set points to be sent next are at these samples (n,) of the trajectory."""
        self._course.append(piece(self._sent + 1, samples))
        for observer in self._observers:
            observer.planned(self._sent + 1, samples)

    def _samples(self, at: FloatArray) -> FloatArray:
        """Samples of the trajectory at fractional indices `at` (n,) of the program."""
        samples: FloatArray = np.interp(at, np.arange(len(self._program.sample)), self._program.sample)
        return samples

    def _send_all(self, points: FloatArray) -> None:
        for point in points:
            self._send(point)

    def _send(self, point: FloatArray) -> None:
        """The next set point, whether of the program or not, at its time."""
        period_s = 1 / self._program.rate_hz
        if not self._driver.ahead_s:
            due_s = self._start_s + self._sent * period_s
            self._clock.sleep_until(due_s)
            late_s = self._clock.now_s() - due_s
            self._late_s.append(late_s)
            if late_s > _STALL_S:
                self._stalls += 1
                self._start_s += late_s
        if self._request() is Request.EMERGENCY_STOP:
            raise _EmergencyStop
        self._driver.send(point, period_s)
        self._position = point
        self._sent += 1

    def _come_to(self, index: int) -> None:
        """The set point `index` of the program, or one in its place, has been sent."""
        self._next = index + 1
        for stroke in self._confirmation.add(self._sent, index):
            for observer in self._observers:
                observer.sent(stroke)
        self.note_finished()
        self._tell_progress(paused=False)

    def _tell_progress(self, *, paused: bool) -> None:
        index, last = self._confirmation.index, len(self._program.positions) - 1
        stroke, left_s = int(self._program.stroke[index]), (last - index) / self._program.rate_hz
        progress = Progress(index + 1, last + 1, stroke, left_s, paused)
        for observer in self._observers:
            observer.progressed(progress)

    def _rested(self) -> None:
        """The arm is at rest: the next set point is due as soon as it is known."""
        self._start_s = max(self._start_s, self._clock.now_s() - self._sent / self._program.rate_hz)
