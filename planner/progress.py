"""How far something has come: what is told of it, the stages of a plan, and bars that show it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import TaskID

Report = Callable[[str, int, int], None]
"""report(stage, done, total): the stage, how much of it is done, and how much there is."""


def unreported(stage: str, done: int, total: int) -> None:
    """Nobody waits."""


STAGES = {
    "reading": 5,
    "placing": 3,
    "joining": 2,
    "ordering strokes": 10,
    "drawing motions": 50,
    "travels": 25,
    "report": 5,
}
"""The stages of a plan in their order, and roughly what share of the time each takes."""
_FINE = 100


def of_all_stages(stage: str, done: int, total: int) -> tuple[int, int]:
    """How much of all stages is done, and how much there is: one bar, and one clock for the time left."""
    names = list(STAGES)
    before = sum(STAGES[name] for name in names[: names.index(stage)])
    return round(_FINE * (before + STAGES[stage] * done / max(total, 1))), _FINE * sum(STAGES.values())


@contextmanager
def bars(*, single: bool = False) -> Iterator[Report]:
    """Bars on standard error, or in a notebook.

    A bar for each label, with the time that it may take by the pace so far; or with `single` one bar whose label
    changes, and which leaves it to the label to tell of time.
    """
    from rich.console import Console
    from rich.progress import BarColumn, Progress, ProgressColumn, TaskProgressColumn, TextColumn, TimeRemainingColumn

    columns: list[ProgressColumn] = [TextColumn("{task.description}", markup=False), BarColumn(), TaskProgressColumn()]
    if not single:
        columns += [TimeRemainingColumn(), TextColumn("left")]
    progress = Progress(*columns, console=Console(stderr=True), transient=True)
    tasks: dict[str, TaskID] = {}

    def show(label: str, done: int, total: int) -> None:
        key = "" if single else label
        if key not in tasks:
            tasks[key] = progress.add_task(label, total=total)
        progress.update(tasks[key], description=label, completed=done, total=total)

    progress.start()
    try:
        yield show
    finally:
        with suppress(OSError):  # the terminal may be gone
            progress.stop()
