"""Frames to and from the firmware: hardware/firmware/PROTOCOL.md in Python."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

from hardware.codecs import cobs
from hardware.codecs.crc import crc16

PROTOCOL_VERSION = 2
BAUD = 250_000
UNITS_PER_US = 16
"""Pulses on the line are in sixteenths of a microsecond."""
UNITS_PER_S = 10_000
"""Durations on the line are in tenths of a millisecond."""
LONGEST_KEY_S = 0xFFFF / UNITS_PER_S
COUNTED = 1 << 32
"""Key frames are counted modulo this."""


class Order(IntEnum):
    """Frames that by-pass the queue."""

    HELLO = 0x01
    CONFIG = 0x02
    ARM = 0x03
    START = 0x04
    HOLD = 0x05
    STOP = 0x06
    CLEAR = 0x07
    PING = 0x08
    OFF = 0x09
    RECALL = 0x0A


class State(IntEnum):
    OFF = 0
    ARMING = 1
    READY = 2
    RUN = 3
    HOLD = 4
    UNDERRUN = 5
    FAULT = 6


class Fault(IntEnum):
    NONE = 0
    STOPPED = 1
    SILENCE = 2
    BAD_KEY = 3


class Result(IntEnum):
    """What became of an order."""

    DONE = 0
    REFUSED_STATE = 1
    REFUSED_LENGTH = 2
    REFUSED_RANGE = 3
    REFUSED_EMPTY = 4
    REFUSED_TYPE = 5


@dataclass(frozen=True, slots=True)
class Key:
    """The channels are to be at `pulses` (1/16 us) `duration` (0.1 ms, 1 to 65535) after they were at those before."""

    duration: int
    pulses: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class End:
    """What was sent is the end of the motion: running out of it is no under-run."""


@dataclass(frozen=True, slots=True)
class Channel:
    """Pulses that a channel may have, and that it has when parked, in 1/16 us."""

    shortest: int
    longest: int
    park: int


@dataclass(frozen=True, slots=True)
class Info:
    """The controller's answer to HELLO. shortest, longest: pulses that it makes at all, in 1/16 us; pulses: those that
    it makes now, of the channels attached."""

    order: int
    session: int
    protocol: int
    firmware: tuple[int, int]
    channels: int
    shortest: int
    longest: int
    pulses: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Status:
    """The controller's answer to everything, and what it says of itself when its state changes.

    order, result: sequence number of the last order and what became of it. session: of the last HELLO, 0 since a
    reset. expected: sequence number of the key frame to come, so all before it have arrived. free: key frames that
    there is room for. gap: since the last Status a frame was damaged or missing. reached: key frames played of those
    that the controller remembers, modulo COUNTED.
    """

    order: int
    session: int
    state: State
    fault: Fault
    result: Result
    expected: int
    free: int
    gap: bool
    reached: int


@dataclass(frozen=True, slots=True)
class Record:
    """What the controller remembers of a run, asked before a HELLO begins another. session: 0 if it remembers none.
    reached: key frames played in it, modulo COUNTED; state: what the controller is at now, so that more may come."""

    order: int
    session: int
    reached: int
    state: State


Message = Info | Status | Record

_KEY, _END, _INFO, _STATUS, _RECORD = 0x10, 0x11, 0x81, 0x82, 0x83
_INFO_PAYLOAD = struct.Struct("<HBBBBHH")
_STATUS_PAYLOAD = struct.Struct("<HBBBBBBI")
_RECORD_PAYLOAD = struct.Struct("<HIB")
_GAP = 0x01


def frame(kind: int, sequence: int, payload: bytes = b"") -> bytes:
    """The bytes on the line, delimiter included."""
    body = bytes((kind, sequence)) + payload
    return cobs.stuff(body + struct.pack("<H", crc16(body))) + b"\0"


def hello(sequence: int, session: int) -> bytes:
    """`session`: 1 to 65535, another for every connection."""
    return frame(Order.HELLO, sequence, struct.pack("<H", session))


def config(sequence: int, channels: Sequence[Channel]) -> bytes:
    payload = b"".join(struct.pack("<HHH", one.shortest, one.longest, one.park) for one in channels)
    return frame(Order.CONFIG, sequence, payload)


def arm(sequence: int, pulses: Sequence[int]) -> bytes:
    """`pulses` in 1/16 us; none for the park pose."""
    return frame(Order.ARM, sequence, struct.pack(f"<{len(pulses)}H", *pulses))


def order(kind: Order, sequence: int) -> bytes:
    """An order that has no payload."""
    return frame(kind, sequence)


def sequenced(what: Key | End, sequence: int) -> bytes:
    """A key frame, or the end of them."""
    if isinstance(what, End):
        return frame(_END, sequence)
    return frame(_KEY, sequence, struct.pack(f"<{1 + len(what.pulses)}H", what.duration, *what.pulses))


class Reader:
    """Bytes as they arrive, to messages. What is no frame is counted in `damaged` and passed over."""

    def __init__(self) -> None:
        self.damaged = 0
        self._rest = b""

    def feed(self, received: bytes) -> list[Message]:
        """The messages that `received` completes."""
        *frames, self._rest = (self._rest + received).split(b"\0")
        self._rest = self._rest[-256:]  # without a delimiter in so many bytes it is noise
        messages = []
        for stuffed in filter(None, frames):
            message = _decode(stuffed)
            if message is None:
                self.damaged += 1
            else:
                messages.append(message)
        return messages


def _decode(stuffed: bytes) -> Message | None:
    try:
        body = cobs.unstuff(stuffed)
    except cobs.NotStuffed:
        return None
    if len(body) < 4 or crc16(body[:-2]) != int.from_bytes(body[-2:], "little"):
        return None
    kind, sequence, payload = body[0], body[1], body[2:-2]
    try:
        if kind == _INFO:
            session, protocol, major, minor, channels, shortest, longest = _INFO_PAYLOAD.unpack_from(payload)
            pulses = struct.unpack(f"<{(len(payload) - _INFO_PAYLOAD.size) // 2}H", payload[_INFO_PAYLOAD.size :])
            return Info(sequence, session, protocol, (major, minor), channels, shortest, longest, pulses)
        if kind == _STATUS:
            session, state, fault, result, expected, free, flags, reached = _STATUS_PAYLOAD.unpack(payload)
            return Status(
                sequence,
                session,
                State(state),
                Fault(fault),
                Result(result),
                expected,
                free,
                bool(flags & _GAP),
                reached,
            )
        if kind == _RECORD:
            session, reached, state = _RECORD_PAYLOAD.unpack(payload)
            return Record(sequence, session, reached, State(state))
    except (struct.error, ValueError):
        return None  # of another version of the protocol, or noise with a CRC that fits
    return None
