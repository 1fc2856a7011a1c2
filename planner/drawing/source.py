"""The bytes of a drawing: read, unzipped, and known to be an SVG or a picture that can be drawn."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from pathlib import Path

from planner.errors import DrawingError

SIZE_LIMIT_BYTES = 32 * 1024 * 1024
_PICTURE = "export it as a PNG first"
_DOCUMENT = "export it as an SVG first"
_OTHER_FORMATS = {
    b"8BPS": ("a picture (Photoshop)", _PICTURE),
    b"%PDF": ("a PDF", _DOCUMENT),
    b"%!PS": ("PostScript", _DOCUMENT),
    b"PK\3\4": ("a ZIP archive", "unpack it, and name the SVG in it"),
    b"AC10": ("a drawing of AutoCAD (DWG)", _DOCUMENT),
}
"""What files of other kinds begin with, and what to do about them: none of this begins an XML document."""


@dataclass(frozen=True, slots=True)
class SvgInMemory:
    """An SVG, gzipped or not, that is no file on disk. name: what messages and trajectories call it."""

    name: str
    content: bytes


DrawingSource = Path | SvgInMemory


def read_source(drawing: DrawingSource) -> bytes:
    """The bytes of a drawing, unzipped; DrawingError if there are none or too many, or of a kind that is none."""
    source = drawing.name or str(drawing)
    data = drawing.content if isinstance(drawing, SvgInMemory) else _read_file(drawing)
    if data.startswith(b"\x1f\x8b") and len(data) <= SIZE_LIMIT_BYTES:
        data = _unzipped(data, source)
    if len(data) > SIZE_LIMIT_BYTES:
        raise DrawingError(source, f"larger than the limit of {SIZE_LIMIT_BYTES} bytes ({SIZE_LIMIT_BYTES >> 20} MB)")
    if not data.strip():
        raise DrawingError(source, "the file is empty")
    other = next((known for start, known in _OTHER_FORMATS.items() if data.startswith(start)), None)
    if other:
        kind, advice = other
        raise DrawingError(source, f"this is {kind}, not an SVG: {advice}")
    return data


def _read_file(path: Path) -> bytes:
    try:
        if path.is_dir():
            raise DrawingError(path.name or str(path), "is a folder, not an SVG file")
        with path.open("rb") as file:
            return file.read(SIZE_LIMIT_BYTES + 1)
    except FileNotFoundError:
        raise DrawingError(str(path), "no such file") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise DrawingError(str(path), f"cannot be read: {reason}") from None


def _unzipped(data: bytes, source: str) -> bytes:
    inflater = zlib.decompressobj(wbits=31)
    try:
        plain = inflater.decompress(data, SIZE_LIMIT_BYTES + 1)
    except zlib.error:
        raise DrawingError(source, "a damaged gzip file") from None
    if not inflater.eof and len(plain) <= SIZE_LIMIT_BYTES:
        raise DrawingError(source, "a truncated gzip file")
    return plain
