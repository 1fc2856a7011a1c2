"""`--tile`: a plan for each sheet of a drawing that is larger than the canvas."""

from __future__ import annotations

from pathlib import Path

from planner.errors import UsageError
from planner.files import STANDARD
from planner.settings import Anchor, PlaceKind, PlanSettings


def check_tile(settings: PlanSettings, target: Path) -> None:
    """Errors: UsageError where other choices contradict `--tile`."""
    if target == Path(STANDARD):
        raise UsageError("--tile writes a file for each sheet: name one with -o")
    if settings.place is PlaceKind.BEST:
        raise UsageError(
            "--tile and --place best contradict each other: every sheet is as full as the drawing has it; turn it with"
            " --rotate"
        )
    if settings.paper is not None:
        return
    without_paper = [
        ("--fit", settings.fit is True, "fills"),
        ("--at", settings.at_mm is not None, "lies on"),
        ("--align", settings.align is not Anchor.CENTRE, "lies on"),
        ("--copies", settings.copies != (1, 1), "lie on"),
    ]
    for option, is_there, does in without_paper:
        if is_there:
            raise UsageError(
                f"--tile cuts the page itself, at its true size or by --scale, and leaves nothing for {option}: leave"
                f" that out, or name the --paper that the drawing {does}, which is then cut"
            )
