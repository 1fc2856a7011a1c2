"""The person at the terminal, whom only keys can speak for."""

from __future__ import annotations

import asyncio
import sys
from pathlib import Path

_PATIENCE_S = 120.0
_SAYS, _HEARS = ("CONOUT$", "CONIN$") if sys.platform == "win32" else ("/dev/tty", "/dev/tty")


async def agrees(question: str) -> bool:
    """Whether somebody at the terminal of this process types y in answer. Nobody does where there is none."""
    try:
        return await asyncio.wait_for(asyncio.to_thread(_asked, question), _PATIENCE_S)
    except TimeoutError:
        return False


def _asked(question: str) -> bool:
    try:
        with Path(_SAYS).open("w", encoding="utf-8") as says, Path(_HEARS).open(encoding="utf-8") as hears:
            print(f"{question}: type y and Enter to let it", file=says, flush=True)
            return hears.readline().strip().lower() == "y"
    except OSError:
        return False
