"""Lynxmotion SSC-32 and its kin: lines of ASCII that end with a carriage return. There is no checksum.

Source: SSC-32U User Guide, sections on servo moves, queries and miscellaneous commands.
"""

from __future__ import annotations

from collections.abc import Iterable

VERSION = b"VER\r"
"""Asks for a line that names board and firmware."""
IS_MOVING = b"Q\r"
"""Asks whether the last move is still under way: MOVING or RESTING, one byte."""
MOVING, RESTING = b"+", b"."

_LONGEST_MS = 65535


def move(targets: Iterable[tuple[int, float]], duration_s: float) -> bytes:
    """One move of all (channel, pulse in us), together in `duration_s`: us and ms are whole, 1 ms is the least."""
    pulses = "".join(f"#{channel}P{round(pulse_us)}" for channel, pulse_us in targets)
    duration_ms = min(max(round(duration_s * 1000), 1), _LONGEST_MS)
    return f"{pulses}T{duration_ms}\r".encode("ascii")


def stop(channels: Iterable[int]) -> bytes:
    """Each of them stops where it is, in the middle of a move."""
    return "".join(f"STOP{channel}\r" for channel in channels).encode("ascii")
