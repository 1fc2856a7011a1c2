"""Feetech STS and SMS bus servos: FF FF, id, length, instruction, parameters, inverted sum.

Source: Feetech, Magnetic Encoding Servo Communication Protocol; registers of its STS3215.
"""

from __future__ import annotations

from collections.abc import Mapping

from hardware.codecs.status import Status

_HEADER = b"\xff\xff"
_BROADCAST = 0xFE
_PING, _READ, _SYNC_WRITE = 0x01, 0x02, 0x83
STATUS_SIZE = 6
"""Bytes of an answer, without what was asked for."""
_LONGEST = 64
"""An answer that says that it is longer is noise."""
_SIGN = 1 << 15
_FAULTS = ("wrong voltage", "a wrong angle from its sensor", "overheated", "too much current", "", "overloaded")


def ping(servo: int) -> bytes:
    return _packet(servo, _PING, b"")


def read(servo: int, register: int, size: int) -> bytes:
    """Asks for `size` bytes from `register` on."""
    return _packet(servo, _READ, bytes((register, size)))


def sync_write(register: int, data: Mapping[int, bytes]) -> bytes:
    """Writes the bytes of each servo, all as many, from `register` on. Nobody answers."""
    size = len(next(iter(data.values())))
    parameters = b"".join(bytes((servo, *content)) for servo, content in data.items())
    return _packet(_BROADCAST, _SYNC_WRITE, bytes((register, size)) + parameters)


def word(count: int) -> bytes:
    """A position: low byte first, the sign in the top bit."""
    if abs(count) >= _SIGN:
        raise ValueError(f"{count} is beyond what a servo counts to")
    return (abs(count) | (_SIGN if count < 0 else 0)).to_bytes(2, "little")


def count(data: bytes) -> int:
    """The position that `word` would write so."""
    value = int.from_bytes(data, "little")
    return -(value & ~_SIGN) if value & _SIGN else value


def take_status(received: bytearray) -> Status | None:
    """The first whole answer in `received`, taken from it with all before it; None where there is none yet."""
    while (start := received.find(_HEADER)) >= 0:
        del received[:start]
        if len(received) < 4:
            return None
        size = received[3] + 4
        plausible = received[2] < _BROADCAST and STATUS_SIZE <= size <= _LONGEST
        if plausible and len(received) < size:
            return None
        if plausible and received[size - 1] == _checksum(received[2 : size - 1]):
            packet = bytes(received[:size])
            del received[:size]
            return Status(packet[2], _in_words(packet[4]), packet[5:-1])
        del received[:1]  # noise that looked like a header
    return None


def _packet(servo: int, instruction: int, parameters: bytes) -> bytes:
    body = bytes((servo, len(parameters) + 2, instruction)) + parameters
    return _HEADER + body + bytes((_checksum(body),))


def _checksum(body: bytes | bytearray) -> int:
    return ~sum(body) & 0xFF


def _in_words(bits: int) -> tuple[str, ...]:
    return tuple(words for bit, words in enumerate(_FAULTS) if words and bits >> bit & 1)
