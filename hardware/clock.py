"""Time as an argument: whoever plays a trajectory is handed the clock to play it by."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """A clock that never goes backwards, in seconds from a start of its own."""

    def now_s(self) -> float: ...

    def sleep_until(self, deadline_s: float) -> None:
        """Return at `deadline_s` or as soon after it as can be; at once where it has passed."""


class WallClock:
    """Real time, unmoved when somebody sets the computer's clock."""

    def now_s(self) -> float:
        return time.monotonic()

    def sleep_until(self, deadline_s: float) -> None:
        remaining_s = deadline_s - time.monotonic()
        if remaining_s > 0:
            time.sleep(remaining_s)


class InstantClock:
    """Time that passes only by sleeping, and then at once: a trajectory plays as fast as it can be computed."""

    def __init__(self) -> None:
        self._now_s = 0.0

    def now_s(self) -> float:
        return self._now_s

    def sleep_until(self, deadline_s: float) -> None:
        self._now_s = max(self._now_s, deadline_s)
