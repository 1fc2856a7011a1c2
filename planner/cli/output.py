"""Whether a result can be written where it is wanted, asked before the work starts."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from planner.errors import OutputError
from planner.files import STANDARD, is_standard_output


def check_target(target: Path, *sources: Path) -> None:
    """Errors: OutputError where `target` cannot become a file, or would replace one of the `sources`."""
    if is_standard_output(target):
        return
    try:
        _check_file(target, sources)
    except OSError as error:  # a name that is too long, a circle of links
        raise OutputError(str(target), error.strerror or str(error)) from error


def _check_file(target: Path, sources: Sequence[Path]) -> None:
    final = Path(os.path.realpath(target))  # a symbolic link stays, and what it points to is replaced
    if final.is_dir():
        raise OutputError(str(target), "it is a folder")
    if not final.parent.is_dir():
        raise OutputError(str(target), f"there is no folder {final.parent}")
    if final.exists() and not os.access(final, os.W_OK):
        raise OutputError(str(target), "it is write-protected")
    device = final.exists() and not final.is_file()
    if not device and not os.access(final.parent, os.W_OK | os.X_OK):
        raise OutputError(str(target), f"the folder {final.parent} is not writable")
    for source in sources:
        if final.exists() and source.exists() and final.samefile(source):
            raise OutputError(str(target), "it is what is being read")


def check_folder_target(folder: Path, file: str, *sources: Path) -> None:
    """Errors: OutputError where `file` cannot be written into `folder`, which is made later if it is missing."""
    if str(folder) == STANDARD:
        raise OutputError(STANDARD, "a folder cannot go to standard output")
    try:
        _check_folder(folder, file, sources)
    except OSError as error:
        raise OutputError(str(folder), error.strerror or str(error)) from error


def _check_folder(folder: Path, file: str, sources: Sequence[Path]) -> None:
    if folder.is_dir():
        check_target(folder / file, *sources)
        return
    nearest = Path(os.path.realpath(folder))
    while not nearest.exists():
        nearest = nearest.parent
    if not nearest.is_dir():
        raise OutputError(str(folder), f"{nearest} is no folder")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise OutputError(str(folder), f"the folder {nearest} is not writable")
