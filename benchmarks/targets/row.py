"""What the page shows: rows of what was measured, what it should be and what it is; and tables of figures."""

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


@dataclass(frozen=True, slots=True)
class Table:
    """title: a heading; note: a sentence or two below it; lines: a cell for each of the columns."""

    title: str
    note: str
    columns: tuple[str, ...]
    lines: Sequence[tuple[str, ...]]

    def markdown(self) -> str:
        cells = [self.columns, ("---", *("---:" for _ in self.columns[1:])), *self.lines]
        return "\n".join([f"## {self.title}", "", self.note, "", *(f"| {' | '.join(line)} |" for line in cells)])


def missing(package: str, what: str, target: str) -> Row | None:
    """The row that says that a rival is not installed, or None where it is."""
    if find_spec(package) is not None:
        return None
    return Row(what, target, f"`{package}` is not installed (extra `benchmark`)")


def markdown(measured: Sequence[Row | Table]) -> str:
    """All rows in one, and the other tables after it."""
    rows = [one.markdown() for one in measured if isinstance(one, Row)]
    head = ["| what | target | measured | |", "|---|---|---|---|"] if rows else []
    tables = [one.markdown() for one in measured if isinstance(one, Table)]
    return "\n\n".join([*(["\n".join(head + rows)] if rows else []), *tables])
