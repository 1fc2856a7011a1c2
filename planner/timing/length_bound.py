"""How long a plan may get: what would fill memory, or never end, is refused before it is begun."""

from __future__ import annotations

from planner.errors import UsageError

MOST_SAMPLES = 5_000_000
"""Samples of a whole trajectory: 14 hours at 100 Hz, and some hundreds of megabytes."""
MOST_SAMPLES_OF_A_TRAVEL_MOVE = 100_000
"""Samples of a single pen-up move, which is made at once."""
SLOW_ARM = "raise the limits of the arm's joints, or choose a lower --rate"


def require_bounded(seconds: float, rate_hz: float, what: str, advice: str, most_samples: int = MOST_SAMPLES) -> None:
    """Errors: UsageError where so many seconds are more samples than there may be, or no number."""
    if not seconds * rate_hz <= most_samples:
        raise UsageError(
            f"{what} would take {seconds:.3g} s at least, which is more than {most_samples} samples at"
            f" {rate_hz:g} Hz; {advice}"
        )
