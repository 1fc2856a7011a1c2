"""The driver of our own firmware: a queue on the controller that no stall of the host starves."""

from __future__ import annotations

import math
import os
from collections import deque
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from hardware.clock import Clock
from hardware.codecs import native
from hardware.codecs.native import End, Fault, Info, Key, Order, Record, Result, State, Status
from hardware.drivers.driver import Tally
from hardware.drivers.native.link import Link
from planner.arrays import FloatArray
from planner.counted import counted
from planner.errors import HardwareError

_AHEAD_S = 0.65
"""No more motion than this is on the controller: it outlasts a stall of 0.4 s, and a pause waits no longer for it."""
_POLL_S = 0.005
_POLL_BYTES = 16
"""A status. Port settings are written anew whenever the time to wait for bytes changes, so it never does."""
_ASK_S = 0.1
"""Without other traffic the controller is asked how it is doing so often; an order is repeated as often."""
_URGENT_S = 0.02
_UNANSWERED = 20
"""Questions without an answer after which nobody is there. Counted, since a host that was paused cannot trust time."""
_BOOT_ATTEMPTS = 50
"""Opening the line resets an Arduino, whose boot loader listens for up to two seconds before the firmware does."""
_RETURN_HZ = 50.0
"""Of the set points from where an earlier run left the arm to where this one sets out."""
_CLOSING_ATTEMPTS = 10

_FAULTS = {
    Fault.STOPPED: "the emergency stop was pressed; the arm holds its pose",
    Fault.SILENCE: "the controller heard nothing for so long that it gave up, and holds its pose",
    Fault.BAD_KEY: "the controller refused a set point outside the ranges of its servos, and holds its pose",
}


class Transport(Protocol):
    """What the driver needs of a port."""

    def read(self, size: int, timeout_s: float, /) -> bytes: ...
    def write(self, message: bytes, /) -> None: ...
    def close(self) -> None: ...


class NativeDriver:
    """An arm on the firmware of hardware/firmware. See hardware/drivers/driver.py for what the methods promise.

    open_line: opens the line at native.BAUD. pulses_us: positions (n_joints,) to pulses (n_joints,), in chain order.
    way: way(held_us, pose, rate_hz), positions (n, n_joints) at that rate from where pulses (n_joints,) hold the arm to
    `pose`. channels: the channel of every joint. ranges_us: (n_joints, 2), the shortest and longest pulse of every
    joint, which the controller enforces as well.
    """

    ahead_s = _AHEAD_S

    def __init__(
        self,
        open_line: Callable[[], Transport],
        pulses_us: Callable[[FloatArray], FloatArray],
        way: Callable[[FloatArray, FloatArray, float], FloatArray],
        channels: Sequence[int],
        ranges_us: FloatArray,
        clock: Clock,
    ) -> None:
        self._open_line, self._pulses_us, self._way, self._clock = open_line, pulses_us, way, clock
        self._channels, self._ranges_us = tuple(channels), ranges_us
        self._line: Transport | None = None
        self._link = Link()
        self._reader = native.Reader()
        self._status: Status | None = None
        self._info: Info | None = None
        self._records: list[Record] = []
        self._session = 0
        self._order = 0
        self._asked_s = 0.0
        self._unanswered = 0
        self._stopped = False
        self._underruns = 0
        self._depth = 0
        self._shortest_key_s = 0.0
        self._sent = 0  # set points handed over, those that wait to be merged included
        self._done = 0  # set points reached
        self._keys_reached = 0
        self._ahead: deque[tuple[int, float]] = deque()  # for each key not reached: set points by its end, duration
        self._merging: tuple[tuple[int, ...], float] | None = None

    def open(self) -> None:
        if self._line is None:
            self._line = self._open_line()

    def recall(self, earlier: Tally | None) -> int | None:
        self.open()
        self._records.clear()
        self._ask(
            lambda: native.order(Order.RECALL, self._order),
            lambda: bool(self._records) and self._records[-1].state is not State.RUN,
        )
        record = self._records[-1]
        if earlier is None or record.session != earlier.run:
            return None
        return (record.reached - earlier.first) % native.COUNTED * earlier.each

    def tally(self, period_s: float) -> Tally:
        return Tally(self._session, self._keys_reached, math.ceil(self._shortest_key_s / period_s))

    def connect(self, pose: FloatArray) -> None:
        self.open()
        self._session = int.from_bytes(os.urandom(2), "little") % 0xFFFF + 1
        self._introduce()
        self._understand()
        pulses = self._on_channels(pose)
        if self._now().state is State.FAULT:
            self._command(Order.CLEAR)
        self._configure(pulses)
        if self._now().state is State.OFF:
            self._command(Order.ARM, lambda order: native.arm(order, pulses))
            while self._now().state is not State.READY:
                self._exchange()
            self._prepare()
        else:
            self._come_from_before(pose)

    def send(self, positions: FloatArray, duration_s: float) -> None:
        """Set points closer than the queue can hold for long enough are merged: the last of them stands for all."""
        pulses = self._on_channels(positions)
        self._sent += 1
        if self._merging is not None:
            duration_s += self._merging[1]
        self._merging = pulses, duration_s
        if duration_s >= self._shortest_key_s:
            self._send_merged()

    def executed(self) -> int:
        return self._done

    def flush(self) -> None:
        self._send_merged()
        if not self._ahead:
            return
        self._link.push(End())
        while self._ahead or not self._link.acknowledged or self._now().state is not State.READY:
            self._play(filled=self._link.acknowledged)
            self._exchange()

    def emergency_stop(self) -> None:
        if self._line is None or self._stopped:
            return
        self._stopped = True
        self._link.restart(0)
        self._command(Order.STOP, every_s=_URGENT_S)

    def close(self) -> None:
        """What was sent is still played: its last set point is the one held."""
        if self._line is None:
            return
        try:
            if self._ahead and not self._stopped:
                self._link.push(End())
                for _ in range(_CLOSING_ATTEMPTS):
                    self._exchange()
                    if self._link.acknowledged:
                        break
        except HardwareError:
            pass  # the line is let go of because it failed, and the controller holds by itself
        finally:
            self._line.close()
            self._line = None

    def statistics(self) -> list[str]:
        counts = self._link.counts
        return [
            f"link: {counted(counts.frames, 'key frame')} sent, {counts.again} of them again (gone back "
            f"{counted(counts.gone_back, 'time')}); {counted(self._reader.damaged, 'damaged frame')} received",
            f"under-runs: {self._underruns}",
        ]

    def _introduce(self) -> None:
        self._status = self._info = None
        self._order = self._session % 256
        self._ask(
            lambda: native.hello(self._order, self._session),
            lambda: self._info is not None and self._status is not None,
        )

    def _ask(self, encode: Callable[[], bytes], answered: Callable[[], bool]) -> None:
        """Ask a controller that may be starting, or be in the midst of anything, until it has answered."""
        for attempt in range(_BOOT_ATTEMPTS):
            # A delimiter first: whatever is stuck in the controller's buffer ends here.
            self._write((b"\0" if attempt == 0 else b"") + encode())
            if self._listen(_ASK_S, answered):
                return
        raise HardwareError(
            "the controller does not answer: is it powered, is this its port, and has it the"
            " project's firmware (hardware/firmware/README.md)?"
        )

    def _understand(self) -> None:
        if self._info is None:
            raise HardwareError("the controller is not connected")
        if self._info.protocol != native.PROTOCOL_VERSION:
            raise HardwareError(
                f"the controller speaks version {self._info.protocol} of the protocol, this program"
                f" version {native.PROTOCOL_VERSION}: flash the firmware that belongs to it"
            )
        if max(self._channels) >= self._info.channels:
            raise HardwareError(
                f"the arm uses channel {max(self._channels)}; the controller has channels 0 to"
                f" {self._info.channels - 1}"
            )

    def _come_from_before(self, pose: FloatArray) -> None:
        """From where an earlier run left the arm, perhaps with its pen on the paper, to where this one sets out."""
        while self._now().state is State.ARMING:
            self._exchange()
        self._introduce()  # once more: now it tells the pulses of all servos, which stand
        held_us = np.array([self._standing()[channel] for channel in self._channels]) / native.UNITS_PER_US
        self._prepare()
        for positions in self._way(held_us, pose, _RETURN_HZ):
            self.send(positions, 1 / _RETURN_HZ)
        self.flush()
        self._sent = self._done = 0

    def _standing(self) -> tuple[int, ...]:
        """Pulses by channel when the controller introduced itself."""
        if self._info is None or len(self._info.pulses) <= max(self._channels):
            raise HardwareError(
                "the controller does not tell where its servos stand: flash the firmware that belongs to this program"
            )
        return self._info.pulses

    def _configure(self, pulses: tuple[int, ...]) -> None:
        ranges = [(pulse, pulse) for pulse in pulses]  # what no joint is on stands still
        for channel, (shortest, longest) in zip(self._channels, _units(self._ranges_us), strict=True):
            ranges[channel] = int(shortest), int(longest)
        channels = [native.Channel(*bounds, pulse) for bounds, pulse in zip(ranges, pulses, strict=True)]

        def encode(order: int) -> bytes:
            return native.config(order, channels)

        if self._now().state is not State.OFF:
            if self._try(Order.CONFIG, encode) is Result.DONE:
                return
            self._command(Order.OFF)  # armed with other ranges, by a run with another arm or calibration
        self._command(Order.CONFIG, encode)

    def _prepare(self) -> None:
        self._depth = self._now().free
        self._shortest_key_s = 0.9 * _AHEAD_S / self._depth
        self._link.restart(self._depth)
        self._sent = self._done = 0
        self._keys_reached = self._now().reached
        self._ahead.clear()
        self._merging = None
        self._stopped = False

    def _on_channels(self, positions: FloatArray) -> tuple[int, ...]:
        """Pulses in 1/16 us by channel; one that no joint is on stands in the middle."""
        pulses = [1500 * native.UNITS_PER_US] * (max(self._channels) + 1)
        for channel, pulse in zip(self._channels, _units(self._pulses_us(positions)), strict=True):
            pulses[channel] = int(pulse)
        return tuple(pulses)

    def _send_merged(self) -> None:
        if self._merging is not None:
            (pulses, duration_s), self._merging = self._merging, None
            self._push(pulses, duration_s, self._sent)

    def _push(self, pulses: tuple[int, ...], duration_s: float, sent: int) -> None:
        """Hand a key frame over as soon as there is room, and see to it that the arm plays."""
        while self._is_full():
            self._play(filled=True)
            self._exchange()
        duration = max(round(duration_s * native.UNITS_PER_S), 1)
        if duration > 0xFFFF:
            raise HardwareError(
                f"a set point {duration_s:g} s after the one before it is beyond the"
                f" {native.LONGEST_KEY_S:g} s of a key frame"
            )
        self._link.push(Key(duration, pulses))
        self._ahead.append((sent, duration_s))
        self._transmit()

    def _is_full(self) -> bool:
        return self._link.room <= 0 or sum(duration_s for _, duration_s in self._ahead) >= _AHEAD_S

    def _play(self, filled: bool) -> None:
        """Set the arm going, again after an under-run, once its queue is `filled` and all on it has arrived."""
        if filled and self._link.acknowledged and self._ahead and self._now().state in (State.READY, State.UNDERRUN):
            self._try(Order.START)  # refused where the queue was played meanwhile

    def _transmit(self) -> bool:
        """Send the key frames that are due; whether there were any."""
        due = self._link.outgoing(self._clock.now_s())
        if due:
            self._write(due)
        return bool(due)

    def _exchange(self) -> None:
        """Send what is due, and take in what comes within a moment. Errors: HardwareError."""
        now_s = self._clock.now_s()
        if not self._transmit() and now_s - self._asked_s > _ASK_S:
            self._order = (self._order + 1) % 256
            self._write(native.order(Order.PING, self._order))
            self._asked_s = now_s
            self._unanswered += 1
            if self._unanswered > _UNANSWERED:
                raise HardwareError("the controller stopped answering: check its cable and its power")
        self._read()

    def _command(self, kind: Order, encode: Callable[[int], bytes] | None = None, every_s: float = _ASK_S) -> None:
        result = self._try(kind, encode, every_s)
        if result is not Result.DONE:
            reason = result.name.removeprefix("REFUSED_").lower()
            raise HardwareError(
                f"the controller refused {kind.name} because of its {reason} in state {self._now().state.name}"
            )

    def _try(self, kind: Order, encode: Callable[[int], bytes] | None = None, every_s: float = _ASK_S) -> Result:
        """Give an order, again until it is answered: the controller obeys it once."""
        order = self._order = (self._order + 1) % 256
        message = native.order(kind, order) if encode is None else encode(order)
        for _ in range(_UNANSWERED):
            self._write(message)
            if self._listen(every_s, lambda: self._now().order == order):
                return self._now().result
        raise HardwareError(f"the controller does not answer {kind.name}: check its cable and its power")

    def _listen(self, for_s: float, until: Callable[[], bool]) -> bool:
        deadline_s = self._clock.now_s() + for_s
        while not until():
            if self._clock.now_s() >= deadline_s:
                return False
            self._transmit()  # key frames are not held up by an answer that got lost
            self._read()
        return True

    def _read(self) -> None:
        for message in self._reader.feed(self._connected().read(_POLL_BYTES, _POLL_S)):
            if isinstance(message, Record):
                self._records.append(message)
            elif self._session and message.session == self._session:
                if isinstance(message, Info):
                    self._info = message
                else:
                    self._take(message)
            elif self._status is not None:  # and so not left over from before this connection
                raise HardwareError(
                    "the controller was reset in the middle of the run (its power?) and its servos are"
                    " loose: lift the pen, put the arm to where it parks, and go on with --resume"
                )

    def _take(self, status: Status) -> None:
        before = self._status
        self._status = status
        self._unanswered = 0
        self._link.received(status, self._clock.now_s())
        for _ in range(min((status.reached - self._keys_reached) % native.COUNTED, len(self._ahead))):
            self._done, _ = self._ahead.popleft()
            self._keys_reached = (self._keys_reached + 1) % native.COUNTED
        if status.state is State.UNDERRUN and before is not None and before.state is not State.UNDERRUN:
            self._underruns += 1
        if status.state is State.FAULT and before is not None and before.state is not State.FAULT and not self._stopped:
            raise HardwareError(_FAULTS[status.fault])

    def _now(self) -> Status:
        if self._status is None:
            raise HardwareError("the controller is not connected")
        return self._status

    def _write(self, message: bytes) -> None:
        self._connected().write(message)

    def _connected(self) -> Transport:
        if self._line is None:
            raise HardwareError("the controller is not connected")
        return self._line


def _units(pulses_us: FloatArray) -> FloatArray:
    rounded: FloatArray = np.rint(pulses_us * native.UNITS_PER_US)
    return rounded
