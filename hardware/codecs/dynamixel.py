"""Dynamixel, protocol 2.0: FF FF FD 00, id, length, instruction, parameters with stuffing, CRC-16.

Source: ROBOTIS e-Manual, DYNAMIXEL Protocol 2.0; registers of the X series.
"""

from __future__ import annotations

from collections.abc import Mapping

from hardware.codecs.crc import UMTS, crc16
from hardware.codecs.status import Status

_HEADER = b"\xff\xff\xfd\x00"
_BROADCAST = 0xFE
_PING, _READ, _STATUS, _SYNC_WRITE = 0x01, 0x02, 0x55, 0x83
_STUFFED, _STUFFING = b"\xff\xff\xfd", b"\xff\xff\xfd\xfd"
STATUS_SIZE = 11
"""Bytes of an answer, without what was asked for."""
_LONGEST = 128
"""An answer that says that it is longer is noise."""
_FAULTS = {
    1: "could not carry out a command",
    2: "an instruction that it does not know",
    3: "a wrong CRC",
    4: "a value out of its range",
    5: "data of the wrong length",
    6: "a value beyond its limits",
    7: "a register that is closed to it now",
}
_ALERT = 0x80


def ping(servo: int) -> bytes:
    return _packet(servo, _PING, b"")


def read(servo: int, register: int, size: int) -> bytes:
    """Asks for `size` bytes from `register` on."""
    return _packet(servo, _READ, register.to_bytes(2, "little") + size.to_bytes(2, "little"))


def sync_write(register: int, data: Mapping[int, bytes]) -> bytes:
    """Writes the bytes of each servo, all as many, from `register` on. Nobody answers."""
    size = len(next(iter(data.values())))
    parameters = b"".join(bytes((servo, *content)) for servo, content in data.items())
    return _packet(_BROADCAST, _SYNC_WRITE, register.to_bytes(2, "little") + size.to_bytes(2, "little") + parameters)


def word(count: int) -> bytes:
    """A position: four bytes, the lowest first, two's complement."""
    return count.to_bytes(4, "little", signed=True)


def count(data: bytes) -> int:
    """The position that `word` would write so."""
    return int.from_bytes(data, "little", signed=True)


def take_status(received: bytearray) -> Status | None:
    """The first whole answer in `received`, taken from it with all before it; None where there is none yet."""
    while (start := received.find(_HEADER)) >= 0:
        del received[:start]
        if len(received) < 8:
            return None
        size = int.from_bytes(received[5:7], "little") + 7
        plausible = received[7] == _STATUS and STATUS_SIZE <= size <= _LONGEST
        if plausible and len(received) < size:
            return None
        packet = bytes(received[:size])
        if plausible and int.from_bytes(packet[-2:], "little") == crc16(packet[:-2], *UMTS):
            del received[:size]
            error, *data = packet[8:-2].replace(_STUFFING, _STUFFED)
            return Status(packet[4], _in_words(error), bytes(data))
        del received[:1]  # noise that looked like a header
    return None


def _packet(servo: int, instruction: int, parameters: bytes) -> bytes:
    """Stuffing keeps a header from appearing inside; the CRC is over what is sent."""
    stuffed = (bytes((instruction,)) + parameters).replace(_STUFFED, _STUFFING)
    packet = _HEADER + bytes((servo,)) + (len(stuffed) + 2).to_bytes(2, "little") + stuffed
    return packet + crc16(packet, *UMTS).to_bytes(2, "little")


def _in_words(error: int) -> tuple[str, ...]:
    faults = (_FAULTS.get(error & ~_ALERT, f"error {error & ~_ALERT}"),) if error & ~_ALERT else ()
    return (*faults, "a hardware fault: too hot, overloaded or wrong voltage") if error & _ALERT else faults
