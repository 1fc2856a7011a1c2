"""Pololu Maestro, compact protocol: a command byte with the top bit set, then data bytes of seven bits.

Source: Pololu Maestro Servo Controller User's Guide, sections 5.b to 5.e.
"""

from __future__ import annotations

STEP_US = 0.25
"""Pulses and positions are counted in these."""
GET_ERRORS = b"\xa1"
"""Asks for the error bits, two bytes, and clears them."""
REPLY_SIZE = 2

_SET_TARGET, _SET_SPEED, _SET_ACCELERATION, _GET_POSITION = 0x84, 0x87, 0x89, 0x90
_CRC7 = 0x91
"""x^7 + x^3 + 1, for bits that come lowest first."""
_ERRORS = (
    "a framing error of the serial line",
    "a serial overrun",
    "a full serial buffer",
    "a wrong CRC",
    "a command that it does not know",
    "a serial time-out",
    "a stack error of its script",
    "a call stack error of its script",
    "an error of its script's counter",
)


def set_target(channel: int, pulse_us: float) -> bytes:
    """The pulse of a servo, rounded to STEP_US; 0 ends its pulses. Below 4096 us."""
    return bytes((_SET_TARGET, channel, *_fourteen_bits(round(pulse_us / STEP_US))))


def unlimited(channel: int) -> tuple[bytes, bytes]:
    """No limit of the board's own on speed or acceleration."""
    return bytes((_SET_SPEED, channel, 0, 0)), bytes((_SET_ACCELERATION, channel, 0, 0))


def get_position(channel: int) -> bytes:
    """Asks for the pulse being sent to a servo: two bytes."""
    return bytes((_GET_POSITION, channel))


def position_us(reply: bytes | bytearray) -> float:
    """The pulse that a reply to `get_position` tells; 0 where the servo has no pulses."""
    return int.from_bytes(reply, "little") * STEP_US


def errors(reply: bytes | bytearray) -> list[str]:
    """In words, what the reply to GET_ERRORS tells since it was last asked."""
    bits = int.from_bytes(reply, "little")
    return [words for bit, words in enumerate(_ERRORS) if bits >> bit & 1]


def with_crc(command: bytes) -> bytes:
    """The command as a board with "Enable CRC" expects it: a CRC-7 behind it."""
    crc = 0
    for byte in command:
        crc ^= byte
        for _ in range(8):
            crc = (crc ^ _CRC7 if crc & 1 else crc) >> 1
    return command + bytes((crc,))


def _fourteen_bits(value: int) -> tuple[int, int]:
    if not 0 <= value < 1 << 14:
        raise ValueError(f"{value} does not fit into fourteen bits")
    return value & 0x7F, value >> 7
