"""Cyclic redundancy checks of 16 bits, most significant bit first."""

from __future__ import annotations

from functools import cache

CCITT_FALSE = (0x1021, 0xFFFF)
"""Polynomial and initial value of CRC-16/CCITT-FALSE."""
UMTS = (0x8005, 0x0000)
"""Those of CRC-16/UMTS, also called CRC-16/BUYPASS."""


def crc16(message: bytes, polynomial: int = CCITT_FALSE[0], initial: int = CCITT_FALSE[1]) -> int:
    """Remainder of `message` by x^16 + `polynomial`, neither reflected nor inverted."""
    table, remainder = _table(polynomial), initial
    for byte in message:
        remainder = (remainder << 8 & 0xFFFF) ^ table[remainder >> 8 ^ byte]
    return remainder


@cache
def _table(polynomial: int) -> tuple[int, ...]:
    """The remainders of all bytes."""
    return tuple(_of_byte(byte, polynomial) for byte in range(256))


def _of_byte(byte: int, polynomial: int) -> int:
    remainder = byte << 8
    for _ in range(8):
        remainder = (remainder << 1 ^ (polynomial if remainder & 0x8000 else 0)) & 0xFFFF
    return remainder
