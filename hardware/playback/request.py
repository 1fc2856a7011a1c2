"""What a player is asked for while it plays."""

from __future__ import annotations

from enum import Enum, auto


class Request(Enum):
    """What the people at the arm want of it now."""

    GO = auto()
    PAUSE = auto()
    STOP = auto()
    EMERGENCY_STOP = auto()
