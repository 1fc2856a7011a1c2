"""The argument parser of every command: errors are typed, abbreviations are not guessed."""

from __future__ import annotations

import argparse
from typing import NoReturn

from planner.errors import UsageError


class Parser(argparse.ArgumentParser):
    """An argument parser that raises UsageError instead of ending the process."""

    def __init__(self, program: str, description: str, epilog: str) -> None:
        super().__init__(
            program,
            description=description,
            epilog=epilog,
            allow_abbrev=False,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )

    def error(self, message: str) -> NoReturn:
        raise UsageError(f"{message} (see {self.prog} --help)")
