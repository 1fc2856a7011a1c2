"""A row of the table: what was measured, what it should be, what it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec


@dataclass(frozen=True, slots=True)
class Row:
    """met: None where there is no target, or where it could not be measured."""

    what: str
    target: str
    measured: str
    met: bool | None = None

    def markdown(self) -> str:
        word = {True: "met", False: "**not met**", None: "–"}[self.met]
        return f"| {self.what} | {self.target} | {self.measured} | {word} |"


def missing(package: str, what: str, target: str) -> Row | None:
    """The row that says that a rival is not installed, or None where it is."""
    if find_spec(package) is not None:
        return None
    return Row(what, target, f"`{package}` is not installed (extra `benchmark`)")


def markdown(rows: Sequence[Row]) -> str:
    return "\n".join(["| what | target | measured | |", "|---|---|---|---|", *(row.markdown() for row in rows)])
