"""What a servo on a bus answers, whichever language the bus speaks."""

from __future__ import annotations

from typing import NamedTuple


class Status(NamedTuple):
    """Who answers, what ails it in words, and the bytes that were asked for."""

    servo: int
    faults: tuple[str, ...]
    data: bytes
