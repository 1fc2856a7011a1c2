"""The argument parser of every command: errors are typed, abbreviations are not guessed."""

from __future__ import annotations

import argparse
from typing import Any, NoReturn

from planner.cli.files import STANDARD_INPUT
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

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> tuple[Any, list[str]]:
        """As of argparse; two files that are both standard input are refused, as it can be read only once."""
        options, unknown = super().parse_known_args(args, namespace)
        if list(vars(options).values()).count(STANDARD_INPUT) > 1:
            self.error("two files are '-', and standard input can be read only once")
        return options, unknown
