"""Ctrl-C, remembered: a solver that it meets stops early and swallows it."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType


@contextmanager
def interrupts_remembered() -> Iterator[Callable[[], None]]:
    """Yields a function that raises KeyboardInterrupt if there has been a Ctrl-C."""
    if threading.current_thread() is not threading.main_thread():
        yield lambda: None
        return
    met: list[int] = []

    def remember(number: int, frame: FrameType | None) -> None:
        met.append(number)
        raise KeyboardInterrupt

    def raise_if_met() -> None:
        if met:
            raise KeyboardInterrupt

    before = signal.signal(signal.SIGINT, remember)
    try:
        yield raise_if_met
    finally:
        signal.signal(signal.SIGINT, before)
