"""How far something has come: what long work tells whoever waits for it."""

from __future__ import annotations

from collections.abc import Callable

Report = Callable[[str, int, int], None]
"""report(stage, done, total): the stage, how much of it is done, and how much there is."""


def unreported(stage: str, done: int, total: int) -> None:
    """Nobody waits."""
