"""How far something has come: what is told of it, the stages of a plan, and bars that show it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from planner.counted import whole_clock

Report = Callable[[str, int, int], None]
"""report(stage, done, total): the stage, how much of it is done, and how much there is."""


def unreported(stage: str, done: int, total: int) -> None:
    """Nobody waits."""


STAGES = {
    "reading": 8,
    "placing": 3,
    "joining": 2,
    "ordering strokes": 7,
    "drawing motions": 45,
    "travels": 35,
    "writing": 2,
    "report": 25,
}
"""The stages of a plan in their order, and roughly how long each takes beside the others."""
PLANNED = "travels"
"""The last of them before anything is written."""
_FINE = 100
_KNOWN_FROM = 0.03
"""The share that has to be done before a pace is known."""


def of_all_stages(stage: str, done: int, total: int, last: str = PLANNED) -> tuple[int, int]:
    """How much of all stages up to `last` is done, and how much there is: one bar, and one clock for the time left."""
    names = list(STAGES)
    before = sum(STAGES[name] for name in names[: names.index(stage)])
    whole = sum(STAGES[name] for name in names[: names.index(last) + 1])
    return round(_FINE * (before + STAGES[stage] * done / max(total, 1))), _FINE * whole


def left(seconds: float) -> str:
    """The time left in words, the same ones wherever it is told."""
    return f"{whole_clock(seconds)} left"


def pace(elapsed_s: float, done: float, total: float) -> str:
    """How long it has taken, and how long it may still take as it went so far, once there is a pace."""
    share = done / total if total else 0.0
    if not _KNOWN_FROM <= share < 1.0:
        return whole_clock(elapsed_s)
    return f"{whole_clock(elapsed_s)}, about {left(elapsed_s * (1.0 - share) / share)}"


@contextmanager
def bars(*, paced: bool = True) -> Iterator[Report]:
    """A bar on standard error, or in a notebook, whose label changes, with the one clock that there is: how long it has
    taken and may still take, which goes on while nothing is reported; or none, where the label tells of time."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, ProgressColumn, Task, TaskProgressColumn, TextColumn
    from rich.text import Text

    class Pace(ProgressColumn):
        def render(self, task: Task) -> Text:
            return Text(pace(task.elapsed or 0.0, task.completed, task.total or 0.0))

    columns = [TextColumn("{task.description}", markup=False), BarColumn(), TaskProgressColumn()]
    progress = Progress(*columns, *([Pace()] if paced else []), console=Console(stderr=True), transient=True)
    task = progress.add_task("", total=None)

    def show(label: str, done: int, total: int) -> None:
        progress.update(task, description=label, completed=done, total=total)

    progress.start()
    try:
        yield show
    finally:
        with suppress(OSError):  # the terminal may be gone
            progress.stop()
