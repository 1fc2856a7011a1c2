"""Counts, durations and lengths in words that people read."""

from __future__ import annotations


def counted(count: int, what: str) -> str:
    """ "1 stroke", "2 strokes": for things whose plural is an s."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def clock(seconds: float) -> str:
    """A duration: seconds to a tenth, or minutes and seconds, or hours and minutes."""
    return f"{seconds:.1f} s" if seconds < 59.95 else whole_clock(seconds)


def whole_clock(seconds: float) -> str:
    """The same in whole seconds."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    minutes = round(whole / 60)
    return f"{minutes // 60} h {minutes % 60} min"


def metres(length_mm: float) -> str:
    """A length of line."""
    return f"{length_mm / 1000:.2f} m"
