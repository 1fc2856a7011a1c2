"""Cyclic redundancy checks of 16 bits, most significant bit first."""

from __future__ import annotations

CCITT_FALSE = (0x1021, 0xFFFF)
"""Polynomial and initial value of CRC-16/CCITT-FALSE."""


def crc16(message: bytes, polynomial: int = CCITT_FALSE[0], initial: int = CCITT_FALSE[1]) -> int:
    """Remainder of `message` by x^16 + `polynomial`, neither reflected nor inverted."""
    remainder = initial
    for byte in message:
        remainder ^= byte << 8
        for _ in range(8):
            remainder = (remainder << 1) ^ (polynomial if remainder & 0x8000 else 0)
            remainder &= 0xFFFF
    return remainder
