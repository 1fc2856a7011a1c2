"""Figures to files: PNG, SVG or PDF by the suffix, whole or not at all."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import IO, cast

from matplotlib.figure import Figure

from planner.errors import UsageError
from planner.files import is_standard_output, written_aside
from planner.plots.look import USUAL, Look

# What each format would say of the time of writing is left out: equal figures make equal files.
_UNDATED: dict[str, dict[str, None]] = {"png": {}, "svg": {"Date": None}, "pdf": {"CreationDate": None}}


def picture_format(target: Path) -> str:
    """ "png", "svg" or "pdf", from the suffix in either case; "png" for standard output. Errors: UsageError naming
    those that work."""
    if not target.suffix and is_standard_output(target):
        return "png"
    suffix = target.suffix.lower().removeprefix(".")
    if suffix not in _UNDATED:
        given = f"'{target.suffix}'" if target.suffix else "no suffix"
        known = ", ".join(f".{name}" for name in _UNDATED)
        raise UsageError(f"{target}: a picture file ends in one of {known}; this one has {given}")
    return suffix


def save_figure(figure: Figure, target: Path, look: Look = USUAL) -> None:
    """Write the figure in the format that the suffix names; nothing is left behind where that fails.

    Errors: UsageError (unknown suffix), OutputError.
    """
    kind = picture_format(target)
    with written_aside(target, binary=True) as file:
        write_figure(figure, cast("IO[bytes]", file), kind, look)


def write_figure(figure: Figure, file: IO[bytes], kind: str, look: Look = USUAL) -> None:
    """Write the figure into an open file; kind is one that `picture_format` answers."""
    with look.style(), warnings.catch_warnings():
        # A drawing's name in a script that the font lacks shows as boxes; that is no matter for a warning.
        warnings.filterwarnings("ignore", message=r"Glyph .* missing from")
        figure.savefig(file, format=kind, metadata=_UNDATED[kind])
