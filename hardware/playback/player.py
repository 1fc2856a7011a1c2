"""Playing a program: every set point at its own time, and a pause, a stop or an e-stop whenever one is asked for."""

from __future__ import annotations

from array import array
from collections import deque
from collections.abc import Callable
from contextlib import suppress

import numpy as np

from hardware.clock import Clock
from hardware.drivers.driver import Driver
from hardware.motion.slow_transfer import slow_transfer
from hardware.motion.stopping import brake, lift, lower, set_off
from hardware.motion.tip import tip_at
from hardware.playback.program import Program
from hardware.playback.progress import End, Played, Progress, Request
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.errors import HardwareError, PlanError
from planner.trajectory import TRAVELLING

_STALL_S = 0.1
"""After a stall longer than this the rest is played that much later: catching up would be a leap."""
_THERE = 1e-6
"""So far from the park pose, in rad or mm, the arm is there."""


def play(
    program: Program,
    arm: Arm,
    driver: Driver,
    clock: Clock,
    *,
    request: Callable[[], Request] = lambda: Request.GO,
    report: Callable[[Progress], None] = lambda progress: None,
    connected: Callable[[], None] = lambda: None,
    sent: Callable[[int], None] = lambda stroke: None,
    finished: Callable[[int], None] = lambda stroke: None,
    onward: Callable[[int, FloatArray], None] = lambda first, samples: None,
    reached: Callable[[int, int], None] = lambda executed, sent: None,
) -> Played:
    """Play `program`: set point k at k / rate after the start, later only by pauses and stalls.

    `request()` is asked before every set point. On a pause the arm brakes along the path and the pen goes straight up;
    then it comes down where it was and goes on from there. On a stop it brakes, lifts and goes to the park pose. On an
    e-stop it holds where it is. If something fails that is not the arm, such as `report`, it is stopped before the
    error goes on its way. `report(progress)` is called after every set point and has to be quick;
    `connected()` once the arm is ready to play, `sent(stroke)` once all of a stroke has been sent, `finished(stroke)`
    once it is known to be drawn. `onward(first, samples)` says where in the trajectory set points from number `first`
    on (counted from 1) will be, before they are sent; `reached(executed, sent)` how many set points are known to have
    been reached, of how many. The driver is closed in any case.
    Errors: HardwareError.
    """
    playing = _Playing(program, arm, driver, clock, request, report, sent, finished, onward, reached)
    try:
        driver.connect(program.park)
        connected()
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
        return playing.outcome(end)
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
        report: Callable[[Progress], None],
        sent: Callable[[int], None],
        finished: Callable[[int], None],
        onward: Callable[[int, FloatArray], None],
        reached: Callable[[int, int], None],
    ) -> None:
        self._program, self._arm, self._driver, self._clock = program, arm, driver, clock
        self._request, self._report, self._stroke_sent, self._finished = request, report, sent, finished
        self._onward, self._tell_reached = onward, reached
        stroke = program.stroke
        self._last_of_stroke = np.flatnonzero((stroke != TRAVELLING) & (stroke != np.append(stroke[1:], TRAVELLING)))
        self._strokes_sent = 0
        self._unconfirmed: deque[tuple[int, int]] = deque()
        self._sent_at: deque[tuple[int, int]] = deque()
        self._next = self._sent = self._ticks = self._reached = 0
        self._position, self._off_path = program.park, False
        self._begin_s = self._start_s = 0.0
        self._late_s = array("d")
        self.stalls = 0

    def begin(self) -> None:
        self._begin_s = self._start_s = self._clock.now_s()
        self._onward(1, self._program.sample)

    def run(self) -> End:
        while self._next < len(self._program.positions):
            match self._request():
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
        self._report = lambda progress: None
        self._stroke_sent = self._finished = lambda stroke: None
        self._onward, self._tell_reached = (lambda first, samples: None), (lambda executed, sent: None)

    def stop(self) -> None:
        """Brake, lift, park; where no way to the park pose is found the arm holds with its pen up."""
        if self._parked():
            return
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
        while self._unconfirmed and self._unconfirmed[0][0] <= executed:
            self._finished(self._unconfirmed.popleft()[1])
        while self._sent_at and self._sent_at[0][0] <= executed:
            self._reached = self._sent_at.popleft()[1]
        self._tell_reached(executed, self._sent)

    def outcome(self, end: End) -> Played:
        late = np.percentile(self._late_s, (50, 99, 100)).tolist() if self._late_s else (0.0, 0.0, 0.0)
        return Played(
            end,
            self._next,
            len(self._program.positions),
            self._clock.now_s() - self._begin_s,
            (late[0], late[1], late[2]),
            self.stalls,
            float(tip_at(self._arm, self._position).position_mm[2]),
            self._parked() and end is not End.EMERGENCY_STOPPED,
            tuple(self._driver.statistics()),
        )

    def _parked(self) -> bool:
        return np.allclose(self._position, self._program.park, rtol=0.0, atol=_THERE)

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
            self._tell(paused=True)
        if request is not Request.GO:
            self._off_path = True
            return
        if not self._next:
            self._send_all(lowering)
            self._onward(self._sent + 1, self._program.sample)
            return
        ramp = set_off(self._arm, self._program.positions, at, rate_hz)
        ahead = np.concatenate(
            (np.full(len(lowering), float(at)), ramp.at, np.arange(ramp.end + 1.0, len(self._program.positions)))
        )
        self._onward(self._sent + 1, self._samples(ahead))
        self._send_all(lowering)
        self._send_all(ramp.points)
        self._come_to(ramp.end)

    def _come_to_rest(self) -> int:
        """Brake from the set point sent last; the one where the arm then rests."""
        if not self._next or self._off_path:
            self._onward(self._sent + 1, self._program.sample[max(self._next - 1, 0)][None])
            return max(self._next - 1, 0)
        ramp = brake(self._arm, self._program.positions, self._next - 1, self._program.rate_hz)
        self._onward(self._sent + 1, self._samples(ramp.at))
        self._send_all(ramp.points)
        self._come_to(ramp.end)
        self._rested()  # working out the lift now costs nothing but a moment's rest
        return ramp.end

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
            due_s = self._start_s + self._ticks * period_s
            self._clock.sleep_until(due_s)
            late_s = self._clock.now_s() - due_s
            self._late_s.append(late_s)
            if late_s > _STALL_S:
                self.stalls += 1
                self._start_s += late_s
        if self._request() is Request.EMERGENCY_STOP:
            raise _EmergencyStop
        self._driver.send(point, period_s)
        self._position = point
        self._ticks += 1
        self._sent += 1

    def _come_to(self, index: int) -> None:
        """The set point `index` of the program, or one that stands for it, has been sent."""
        self._next = index + 1
        while self._strokes_sent < len(self._last_of_stroke) and self._last_of_stroke[self._strokes_sent] <= index:
            stroke = int(self._program.stroke[self._last_of_stroke[self._strokes_sent]])
            self._unconfirmed.append((self._sent, stroke))
            self._strokes_sent += 1
            self._stroke_sent(stroke)
        self._sent_at.append((self._sent, index))
        self.note_finished()
        self._tell(paused=False)

    def _tell(self, *, paused: bool) -> None:
        program = self._program
        self._report(
            Progress(
                self._reached + 1,
                len(program.positions),
                int(program.stroke[self._reached]),
                (len(program.positions) - 1 - self._reached) / program.rate_hz,
                paused,
            )
        )

    def _rested(self) -> None:
        """The arm stands still: what is sent next is due as soon as it is known."""
        self._start_s = max(self._start_s, self._clock.now_s() - self._ticks / self._program.rate_hz)
