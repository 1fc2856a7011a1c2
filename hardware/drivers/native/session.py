"""A session with the firmware: the introduction, what the controller recalls, its configuration, and orders to it.

Key frames go along with the orders: whatever is due on the queue is sent before anything is waited for.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Protocol

from hardware.clock import Clock
from hardware.codecs import native
from hardware.codecs.native import Channel, Fault, Info, Order, Record, Result, State, Status
from hardware.drivers.native.queue import Queue
from planner.errors import HardwareError

_POLL_S = 0.005
_POLL_BYTES = 16
"""A status. Port settings are written anew whenever the time to wait for bytes changes, so it never does."""
_ASK_S = 0.1
"""Without other traffic the controller is asked for its status so often; an order is repeated as often."""
_URGENT_S = 0.02
_BRAKES_S = 0.25
"""The time scale ramps down in 0.2 s; then all servos are told, and the controller counts what they were told."""
_UNANSWERED = 20
"""Questions without an answer after which nobody is there. Counted, since a host that was paused cannot trust time."""
_BOOT_ATTEMPTS = 50
"""Opening the line resets an Arduino, whose boot loader listens for up to two seconds before the firmware does."""

_FAULTS = {
    Fault.STOPPED: "the emergency stop was pressed; the arm holds its pose",
    Fault.SILENCE: "the controller heard nothing for too long and stopped; the arm holds its pose",
    Fault.BAD_KEY: "the controller refused a set point outside the ranges of its servos; the arm holds its pose",
}


class Transport(Protocol):
    """What a session needs of a port."""

    def read(self, size: int, timeout_s: float, /) -> bytes: ...
    def write(self, message: bytes, /) -> None: ...
    def close(self) -> None: ...


class Session:
    """Every method that waits for the controller may raise HardwareError.

    open_line: opens the line at native.BAUD. number: of the session, 1 to 65535, which tells a reset controller from
    one that is in the middle of it; 0 before the introduction. damaged: frames that came damaged.
    """

    def __init__(self, open_line: Callable[[], Transport], queue: Queue, clock: Clock) -> None:
        self._open_line, self._queue, self._clock = open_line, queue, clock
        self._line: Transport | None = None
        self._reader = native.Reader()
        self._status: Status | None = None
        self._info: Info | None = None
        self._records: list[Record] = []
        self.number = 0
        self._order = 0  # sequence number of the last order
        self._asked_s = 0.0
        self._unanswered = 0
        self.is_stopped = False

    @property
    def is_open(self) -> bool:
        return self._line is not None

    @property
    def damaged(self) -> int:
        return self._reader.damaged

    @property
    def status(self) -> Status:
        """The last one heard."""
        if self._status is None:
            raise HardwareError("the controller is not connected")
        return self._status

    @property
    def info(self) -> Info:
        """What the controller said at the last introduction."""
        if self._info is None:
            raise HardwareError("the controller is not connected")
        return self._info

    def open(self) -> None:
        if self._line is None:
            self._line = self._open_line()

    def close(self) -> None:
        if self._line is not None:
            self._line.close()
            self._line = None

    def recall(self) -> Record:
        """What the controller remembers of an earlier session, once it no longer plays. Before `begin`."""
        self._records.clear()
        self._ask(
            lambda: native.order(Order.RECALL, self._order),
            lambda: bool(self._records) and self._records[-1].state is not State.RUN,
        )
        return self._records[-1]

    def begin(self, channels: int) -> None:
        """Begin another session, with a controller that has to have so many `channels`. Clears a fault."""
        self.is_stopped = False
        self.number = int.from_bytes(os.urandom(2), "little") % 0xFFFF + 1
        self.introduce()
        if self.info.protocol != native.PROTOCOL_VERSION:
            raise HardwareError(
                f"the controller speaks version {self.info.protocol} of the protocol, this program"
                f" version {native.PROTOCOL_VERSION}: flash the firmware that belongs to it"
            )
        if channels > self.info.channels:
            raise HardwareError(
                f"the arm uses channel {channels - 1}; the controller has channels 0 to {self.info.channels - 1}"
            )
        if self.status.state is State.FAULT:
            self.command(Order.CLEAR)

    def introduce(self) -> None:
        """Say hello, again too in the same session, for the pulses of all servos as they are now."""
        self._status = self._info = None
        self._order = self.number % 256
        self._ask(
            lambda: native.hello(self._order, self.number),
            lambda: self._info is not None and self._status is not None,
        )

    def configure(self, channels: Sequence[Channel]) -> None:
        """Give the controller ranges and park pose of its channels; servos armed with others are let go of first."""

        def encode(order: int) -> bytes:
            return native.config(order, channels)

        if self.status.state is not State.OFF:
            if self.attempt(Order.CONFIG, encode) is Result.DONE:
                return
            self.command(Order.OFF)  # armed with other ranges, by a run with another arm or calibration
        self.command(Order.CONFIG, encode)

    def arm(self, pulses: Sequence[int]) -> None:
        """Attach the servos at `pulses` by channel, in 1/16 us, and wait until all are."""
        self.command(Order.ARM, lambda order: native.arm(order, pulses))
        while self.status.state is not State.READY:
            self.exchange()

    def stop(self) -> None:
        """Stop at once. The fault that this leaves the controller in is no error."""
        self.is_stopped = True
        self.command(Order.STOP, every_s=_URGENT_S)

    def halt(self) -> None:
        """Brake along the path, and forget what is queued. Returns once the arm stands and the controller has said how
        far it came, and with which pulses it holds."""
        if self.attempt(Order.HOLD, every_s=_URGENT_S) is Result.DONE:  # else it stands already
            end_s = self._clock.now_s() + _BRAKES_S
            while self._clock.now_s() < end_s:
                self.exchange()
        self.command(Order.CLEAR)
        self.introduce()

    def command(self, kind: Order, encode: Callable[[int], bytes] | None = None, every_s: float = _ASK_S) -> None:
        """Give an order that has to be obeyed."""
        result = self.attempt(kind, encode, every_s)
        if result is not Result.DONE:
            reason = result.name.removeprefix("REFUSED_").lower()
            raise HardwareError(
                f"the controller refused {kind.name} because of its {reason} in state {self.status.state.name}"
            )

    def attempt(self, kind: Order, encode: Callable[[int], bytes] | None = None, every_s: float = _ASK_S) -> Result:
        """Give an order, again until it is answered: the controller obeys it once. What became of it."""
        order = self._order = (self._order + 1) % 256
        message = native.order(kind, order) if encode is None else encode(order)
        for _ in range(_UNANSWERED):
            self._write(message)
            if self._listen(every_s, lambda: self.status.order == order):
                return self.status.result
        raise HardwareError(f"the controller does not answer {kind.name}: check its cable and its power")

    def transmit(self) -> bool:
        """Send the key frames that are due; whether there were any."""
        due = self._queue.outgoing(self._clock.now_s())
        if due:
            self._write(due)
        return bool(due)

    def exchange(self) -> None:
        """Send what is due, and take in what comes within a moment."""
        now_s = self._clock.now_s()
        if not self.transmit() and now_s - self._asked_s > _ASK_S:
            self._order = (self._order + 1) % 256
            self._write(native.order(Order.PING, self._order))
            self._asked_s = now_s
            self._unanswered += 1
            if self._unanswered > _UNANSWERED:
                raise HardwareError("the controller stopped answering: check its cable and its power")
        self._read()

    def _ask(self, encode: Callable[[], bytes], answered: Callable[[], bool]) -> None:
        """Ask a controller that may be starting, or be in the middle of anything, until it has answered."""
        for attempt in range(_BOOT_ATTEMPTS):
            # A delimiter first: whatever is stuck in the controller's buffer ends here.
            self._write((b"\0" if attempt == 0 else b"") + encode())
            if self._listen(_ASK_S, answered):
                return
        raise HardwareError(
            "the controller does not answer: is it powered, is this its port, and does it run the"
            " project's firmware (hardware/firmware/README.md)?"
        )

    def _listen(self, for_s: float, until: Callable[[], bool]) -> bool:
        deadline_s = self._clock.now_s() + for_s
        while not until():
            if self._clock.now_s() >= deadline_s:
                return False
            self.transmit()  # key frames are not held up by an answer that got lost
            self._read()
        return True

    def _read(self) -> None:
        for message in self._reader.feed(self._connected().read(_POLL_BYTES, _POLL_S)):
            if isinstance(message, Record):
                self._records.append(message)
            elif self.number and message.session == self.number:
                if isinstance(message, Info):
                    self._info = message
                else:
                    self._take(message)
            elif self._status is not None:  # and so not left over from before this connection
                raise HardwareError(
                    "the controller was reset in the middle of the run (check its power) and its servos are"
                    " loose: lift the pen, put the arm into its park pose, and go on with --resume"
                )

    def _take(self, status: Status) -> None:
        before = None if self._status is None else self._status.state
        self._status = status
        self._unanswered = 0
        self._queue.received(status, before, self._clock.now_s())
        if status.state is State.FAULT and before not in (None, State.FAULT) and not self.is_stopped:
            raise HardwareError(_FAULTS[status.fault])

    def _write(self, message: bytes) -> None:
        self._connected().write(message)

    def _connected(self) -> Transport:
        if self._line is None:
            raise HardwareError("the controller is not connected")
        return self._line
