"""Counts in words that people read."""

from __future__ import annotations


def counted(count: int, what: str) -> str:
    """ "1 stroke", "2 strokes": for things whose plural is an s."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"
