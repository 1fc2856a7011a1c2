"""The person at the terminal, whom only keys can speak for."""

from __future__ import annotations

import asyncio
import os
import sys
from contextlib import suppress
from pathlib import Path
from threading import Event

_PATIENCE_S = 120.0
_LOOK_S = 0.2
_LONGEST_ANSWER = 1000


async def agrees(question: str) -> bool:
    """Whether somebody at the terminal of this process types y in answer. Nobody does where there is none: that is the
    one that controls it, or else the one that its standard error goes to, for agents start it in a session of its own.
    """
    given_up = Event()
    try:
        return await asyncio.wait_for(
            asyncio.to_thread(_asked, f"{question}: type y and Enter to let it\n", given_up), _PATIENCE_S
        )
    except TimeoutError:
        return False
    finally:
        given_up.set()


if sys.platform == "win32":

    def _asked(question: str, given_up: Event) -> bool:
        import msvcrt

        answer = ""
        with suppress(OSError), Path("CONOUT$").open("w", encoding="utf-8") as says:
            while msvcrt.kbhit():  # what was typed before it was asked is no answer
                msvcrt.getwch()
            print(question, end="", file=says, flush=True)
            while not given_up.wait(_LOOK_S) and not answer.endswith("\r"):
                while msvcrt.kbhit():
                    answer += msvcrt.getwche()
        return answer.strip().lower() == "y"

else:

    def _asked(question: str, given_up: Event) -> bool:
        import select
        import termios

        try:
            terminal = _terminal()
        except OSError:
            return False
        try:
            termios.tcflush(terminal, termios.TCIFLUSH)  # what was typed before it was asked is no answer
            os.write(terminal, question.encode())
            while not given_up.is_set():
                if select.select([terminal], [], [], _LOOK_S)[0]:
                    return os.read(terminal, _LONGEST_ANSWER).strip().lower() == b"y"
        except (OSError, termios.error):
            pass
        finally:
            os.close(terminal)
        return False

    def _terminal() -> int:
        """Errors: OSError where there is none."""
        with suppress(OSError):
            return os.open("/dev/tty", os.O_RDWR)
        return os.open(os.ttyname(2), os.O_RDWR | os.O_NOCTTY)
