"""The driver of our own firmware: a queue on the controller that no stall of the host starves."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from hardware.clock import Clock
from hardware.codecs import native
from hardware.codecs.native import Channel, Order, State
from hardware.drivers.driver import Tally
from hardware.drivers.native.queue import AHEAD_S, Queue
from hardware.drivers.native.session import Session, Transport
from planner.arrays import FloatArray
from planner.counted import counted
from planner.errors import HardwareError

_RETURN_HZ = 50.0
"""Of the set points from where an earlier run left the arm to where this one sets out."""
_CLOSING_ATTEMPTS = 10
_MIDDLE = 1500 * native.UNITS_PER_US


class NativeDriver:
    """An arm on the firmware of hardware/firmware. See hardware/drivers/driver.py for what the methods promise.

    open_line: opens the line at native.BAUD. pulses_us: positions (n_joints,) to pulses (n_joints,), in chain order;
    positions: the other way round. way: way(held, pose, rate_hz), positions (n, n_joints) at that rate from where the
    arm is held (n_joints,) to `pose`. channels: the channel of every joint. ranges_us: (n_joints, 2), the shortest and
    longest pulse of every joint, which the controller enforces as well.
    """

    ahead_s = AHEAD_S

    def __init__(
        self,
        open_line: Callable[[], Transport],
        pulses_us: Callable[[FloatArray], FloatArray],
        positions: Callable[[FloatArray], FloatArray],
        way: Callable[[FloatArray, FloatArray, float], FloatArray],
        channels: Sequence[int],
        ranges_us: FloatArray,
        clock: Clock,
    ) -> None:
        self._pulses_us, self._positions, self._way = pulses_us, positions, way
        self._channels, self._ranges_us = tuple(channels), ranges_us
        self._queue = Queue()
        self._session = Session(open_line, self._queue, clock)

    def open(self) -> None:
        self._session.open()

    def recall(self, earlier: Tally | None) -> int | None:
        self.open()
        record = self._session.recall()
        if earlier is None or record.session != earlier.run:
            return None
        return (record.reached - earlier.first) % native.COUNTED * earlier.each

    def tally(self, period_s: float) -> Tally:
        each = math.ceil(self._queue.shortest_key_s / period_s)
        return Tally(self._session.number, self._queue.keys_reached, each)

    def connect(self, pose: FloatArray) -> None:
        self.open()
        session, pulses = self._session, self._on_channels(pose)
        session.begin(len(pulses))
        session.configure(self._ranges(pulses))
        if session.status.state is State.OFF:
            session.arm(pulses)
            self._restart()
        else:
            self._come_from_before(pose)

    def send(self, positions: FloatArray, duration_s: float) -> None:
        if self._queue.add(self._on_channels(positions), duration_s):
            self._push()

    def executed(self) -> int:
        return self._queue.executed

    def flush(self) -> None:
        if self._queue.is_merging:
            self._push()
        if self._queue.is_empty:
            return
        self._queue.push_end()
        while not self._is_at_rest():
            self._play()
            self._session.exchange()

    def halt(self) -> FloatArray:
        self._session.halt()
        self._queue.cut_short(self._session.status.free, self._session.status.reached)
        return self._held()

    def emergency_stop(self) -> None:
        if self._session.is_open and not self._session.is_stopped:
            self._queue.drop()
            self._session.stop()

    def close(self) -> None:
        """What was sent is still played: its last set point is the one held."""
        try:
            if self._session.is_open and not self._queue.is_empty and not self._session.is_stopped:
                self._queue.push_end()
                for _ in range(_CLOSING_ATTEMPTS):
                    self._session.exchange()
                    if self._queue.has_arrived:
                        break
        except HardwareError:
            pass  # the line is let go of because it failed, and the controller holds by itself
        finally:
            self._session.close()

    def statistics(self) -> list[str]:
        counts = self._queue.counts
        return [
            f"link: {counted(counts.frames, 'key frame')} sent, {counts.again} of them again (gone back "
            f"{counted(counts.gone_back, 'time')}); {counted(self._session.damaged, 'damaged frame')} received",
            f"under-runs: {self._queue.underruns}",
        ]

    def _is_at_rest(self) -> bool:
        """Whether all that was pushed is known to have been played."""
        return self._queue.is_empty and self._queue.has_arrived and self._session.status.state is State.READY

    def _push(self) -> None:
        """Hand a key frame over as soon as there is room for it, and see to it that the arm plays."""
        while self._queue.is_full:
            self._play()
            self._session.exchange()
        self._queue.push()
        self._session.transmit()

    def _play(self) -> None:
        """Set the arm going, again after an under-run, once all that was pushed has arrived."""
        ready = self._session.status.state in (State.READY, State.UNDERRUN)
        if ready and self._queue.has_arrived and not self._queue.is_empty:
            self._session.attempt(Order.START)  # refused where the queue was played meanwhile

    def _restart(self) -> None:
        """The servos are attached and at rest: set points may come."""
        self._queue.restart(self._session.status.free, self._session.status.reached)

    def _come_from_before(self, pose: FloatArray) -> None:
        """From where an earlier run left the arm, perhaps with its pen on the paper, to where this one sets out."""
        while self._session.status.state is State.ARMING:
            self._session.exchange()
        self._session.introduce()  # once more: now it tells the pulses of all servos, which are at rest
        held = self._held()
        self._restart()
        for positions in self._way(held, pose, _RETURN_HZ):
            self.send(positions, 1 / _RETURN_HZ)
        self.flush()
        self._queue.count_from_here()

    def _held(self) -> FloatArray:
        """(n_joints,) where the controller holds the arm."""
        pulses = self._session.info.pulses
        if len(pulses) <= max(self._channels):
            raise HardwareError(
                "the controller does not tell the pulses of its servos: flash the firmware that belongs to this program"
            )
        return self._positions(np.array([pulses[channel] for channel in self._channels]) / native.UNITS_PER_US)

    def _on_channels(self, positions: FloatArray) -> tuple[int, ...]:
        """Pulses in 1/16 us by channel; a channel without a joint gets the middle."""
        pulses = [_MIDDLE] * (max(self._channels) + 1)
        for channel, pulse in zip(self._channels, _units(self._pulses_us(positions)), strict=True):
            pulses[channel] = int(pulse)
        return tuple(pulses)

    def _ranges(self, park: tuple[int, ...]) -> list[Channel]:
        """Of every channel, with the pulse to park at; a channel without a joint never moves."""
        channels = [Channel(pulse, pulse, pulse) for pulse in park]
        for channel, (shortest, longest) in zip(self._channels, _units(self._ranges_us), strict=True):
            channels[channel] = Channel(int(shortest), int(longest), park[channel])
        return channels


def _units(pulses_us: FloatArray) -> FloatArray:
    rounded: FloatArray = np.rint(pulses_us * native.UNITS_PER_US)
    return rounded
