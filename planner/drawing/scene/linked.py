"""The bytes that a picture refers to: in the drawing itself, or in a file beside it. Never from the network."""

from __future__ import annotations

import base64
import binascii
from pathlib import Path
from urllib.parse import unquote, unquote_to_bytes, urlsplit

from planner.drawing.raster import RasterError
from planner.drawing.source import SIZE_LIMIT_BYTES


def is_embedded(reference: str) -> bool:
    """Whether a reference holds what it refers to."""
    return reference[:5].lower() == "data:"


def embedded(reference: str) -> tuple[str, bytes] | None:
    """The kind and the bytes that a `data:` reference holds; None for one that is damaged."""
    head, comma, body = reference[5:].partition(",")
    kind, *parameters = (part.strip().lower() for part in head.split(";"))
    if not comma:
        return None
    try:
        data = unquote_to_bytes(body)
        return kind, base64.b64decode(b"".join(data.split()) + b"==") if "base64" in parameters else data
    except (binascii.Error, ValueError):
        return None


def linked(reference: str, folder: Path | None) -> bytes:
    """The bytes of a file in the drawing's folder or below it. Errors: RasterError, in words that can be counted."""
    parts = urlsplit(reference)
    if parts.scheme.lower() not in ("", "file") or parts.netloc not in ("", "localhost"):
        raise RasterError("image on a network")
    if folder is None:
        raise RasterError("image in a file, of a drawing that is in none")
    try:
        home = folder.resolve()
        path = (home / unquote(parts.path)).resolve()
        if not path.is_relative_to(home):
            raise RasterError("image outside of the drawing's folder")
        # A pipe or a device might never end.
        if not path.is_file():
            raise RasterError("image that is not there")
        with path.open("rb") as file:
            data = file.read(SIZE_LIMIT_BYTES + 1)
    except (OSError, ValueError):
        raise RasterError("image that cannot be read") from None
    if len(data) > SIZE_LIMIT_BYTES:
        raise RasterError(f"image of more than {SIZE_LIMIT_BYTES >> 20} MB")
    return data


def folder_of(path: Path) -> Path | None:
    """Where the files are that a drawing may refer to; None where it came through a pipe."""
    return path.parent if path.is_file() and path != Path("/dev/stdin") else None
