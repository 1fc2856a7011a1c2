"""What callers of the public functions give: drawings, arms, progress."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING

from planner.drawing.source import DrawingSource, SvgInMemory
from planner.errors import DrawingError, UsageError
from planner.progress import Report, bars, of_all_stages

if TYPE_CHECKING:
    from planner.arms.arm import Arm

DrawingInput = str | bytes | os.PathLike[str] | IO[str] | IO[bytes]
"""A path, the text of an SVG (it begins with `<`), its bytes, or a file object, text or binary."""
Progress = bool | Report

_NAMELESS = "drawing"
_XML_DECLARATION = re.compile(r"\A\s*<\?xml\s.*?\?>", re.DOTALL)


def drawing_source(drawing: DrawingInput) -> DrawingSource:
    """Where to read the drawing. Errors: DrawingError, UsageError for what is no drawing."""
    if isinstance(drawing, str):
        text = drawing.removeprefix("\ufeff")
        if not text.strip():
            raise DrawingError(_NAMELESS, "the name or the text of the drawing is empty")
        return SvgInMemory(_NAMELESS, _encoded(text)) if text.lstrip().startswith("<") else Path(drawing)
    if isinstance(drawing, bytes | bytearray | memoryview):
        return SvgInMemory(_NAMELESS, bytes(drawing))
    if isinstance(drawing, os.PathLike):
        return Path(drawing)
    if hasattr(drawing, "read"):
        return _read(drawing)
    raise UsageError(
        f"a drawing is a path, the text of an SVG or an open file, not a value of type {type(drawing).__name__}"
    )


def arm_of(arm: Arm | str | os.PathLike[str], *, cache: bool = True) -> Arm:
    """The arm itself, the one of that name, or the one of that `.toml` file. cache: as for `planner.arms.arm_file`.

    Errors: UnknownArm, ArmFileError (which lists every fault in the file), UsageError.
    """
    from planner.arms.arm import Arm
    from planner.arms.arm_file import load_arm

    if isinstance(arm, Arm):
        return arm
    return load_arm(arm_name(arm), cache=cache)


def arm_name(arm: Arm | str | os.PathLike[str]) -> str:
    """What a trajectory calls the arm. Errors: UsageError for what is no arm."""
    from planner.arms.arm import Arm

    if isinstance(arm, Arm):
        return arm.name
    if not isinstance(arm, str | os.PathLike):
        raise UsageError(f"an arm is a name, a path or a loaded arm, not a value of type {type(arm).__name__}")
    return os.fspath(arm)


@contextmanager
def shown(progress: Progress, *, stages_of_a_plan: bool = False) -> Iterator[Report]:
    """What is told of progress goes to the caller's function, to a bar, or nowhere. Errors: UsageError."""
    if callable(progress):
        yield progress
    elif progress is True:
        with bars() as show:
            if stages_of_a_plan:
                yield lambda stage, done, total: show(stage, *of_all_stages(stage, done, total))
            else:
                yield show
    elif progress is False:
        yield lambda label, done, total: None
    else:
        raise UsageError(f"progress is True, False or a function of (stage, done, total), not {progress!r:.40}")


def _read(file: IO[str] | IO[bytes]) -> SvgInMemory:
    given = getattr(file, "name", None)
    name = (Path(given).name if isinstance(given, str) else "") or _NAMELESS
    try:
        content = file.read()
    except (OSError, ValueError) as error:  # closed, opened for writing, of another encoding
        raise DrawingError(name, f"cannot be read: {error}") from error
    if isinstance(content, str):
        return SvgInMemory(name, _encoded(content.removeprefix("\ufeff")))
    if isinstance(content, bytes):
        return SvgInMemory(name, content)
    raise UsageError(f"a drawing's file gives text or bytes, not a value of type {type(content).__name__}")


def _encoded(text: str) -> bytes:
    """UTF-8; the declaration goes, as the encoding that it may name is no longer true."""
    return _XML_DECLARATION.sub("", text, count=1).encode(errors="replace")
