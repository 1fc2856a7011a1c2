"""A picture of pixels from its bytes: how dark it is on white paper."""

from __future__ import annotations

import io
import struct
import warnings
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from PIL import Image

MOST_PIXELS = 50_000_000
"""More would take long, and no arm draws them."""
FAINTEST = 0.0135
"""Darkness that is as good as none: 97 % of the light comes back."""
LARGEST_SIDE_PX = 4096
"""A larger picture is shrunk to that: finer than a pen draws on any paper that an arm reaches."""
_FORMATS = ("PNG", "JPEG", "GIF", "WEBP", "TIFF", "BMP", "PPM", "ICO")
"""Those that Pillow reads by itself, without calling other programs."""
_STARTS = (b"\x89PNG", b"\xff\xd8\xff", b"GIF8", b"RIFF", b"II*\0", b"MM\0*", b"BM", b"\0\0\1\0")
_NETPBM = tuple(b"P%d" % number for number in range(1, 7))
_SIXTEEN_BITS = 65535.0
_SANE_DPI = (50.0, 2400.0)

Darkness = NDArray[np.float32]
"""(rows, columns): 0 where the paper shows, 1 where it is black, as even to the eye as the values of the picture."""


class RasterError(Exception):
    """A picture that cannot be used: what it is, and what to do about it."""


@dataclass(frozen=True, eq=False, slots=True)
class Raster:
    """size_px: columns and rows as the file has them, the way up that a camera says; `darkness` may have fewer.
    dpi: across and down, None where the file says nothing, or nothing to be believed."""

    darkness: Darkness
    size_px: tuple[int, int]
    dpi: tuple[float, float] | None

    @property
    def is_blank(self) -> bool:
        """Whether there is nothing on it."""
        return float(self.darkness.max(initial=0.0)) < FAINTEST


def is_raster(data: bytes) -> bool:
    """Whether a file begins as a picture of pixels does."""
    return data.startswith(_STARTS) or (data.startswith(_NETPBM) and data[2:3].isspace())


def read_raster(data: bytes) -> Raster:
    """The picture in a file's bytes, on white paper. Errors: RasterError."""
    from PIL import Image, ImageOps

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of its size, and of damage that does no harm
            with Image.open(io.BytesIO(data), formats=_FORMATS) as opened:
                if opened.width * opened.height > MOST_PIXELS:
                    raise _too_large(f"{opened.width} x {opened.height} pixels")
                dpi = _dpi(opened.info.get("dpi"))
                upright = ImageOps.exif_transpose(opened)
                if dpi is not None and opened.getexif().get(0x0112, 1) >= 5:  # turned by a quarter
                    dpi = dpi[::-1]
                darkness = _darkness(upright)
    except Image.DecompressionBombError:
        raise _too_large("far too many pixels") from None
    except (OSError, SyntaxError, ValueError, EOFError, IndexError, KeyError, TypeError, struct.error, zlib.error):
        raise RasterError("it is no whole picture that can be read (save it anew, as a PNG)") from None
    rows, columns = darkness.shape
    return Raster(_shrunk(darkness), (columns, rows), dpi)


def _too_large(what: str) -> RasterError:
    return RasterError(f"it has {what}, and {MOST_PIXELS // 1_000_000} million are the most (save it smaller)")


def _darkness(picture: Image.Image) -> Darkness:
    if picture.mode.startswith("I") or picture.mode == "F":
        values = np.asarray(picture, dtype=np.float32)
        whole = 1.0 if picture.mode == "F" and values.max(initial=0.0) <= 1.0 else _SIXTEEN_BITS
        return np.asarray(1.0 - np.clip(np.nan_to_num(values) / np.float32(whole), 0.0, 1.0), dtype=np.float32)
    if picture.mode in ("RGBa", "La"):
        picture = picture.convert("RGBA")
    has_alpha = picture.mode in ("LA", "PA", "RGBA") or "transparency" in picture.info
    if not has_alpha:
        return 1.0 - _grey(picture)
    picture = picture.convert("RGBA")
    alpha = np.asarray(picture.getchannel("A"), dtype=np.float32) / np.float32(255.0)
    return (1.0 - _grey(picture)) * alpha


def _grey(picture: Image.Image) -> Darkness:
    """By how bright the colours are to the eye: a grey stays as it is."""
    if picture.mode not in ("1", "L", "LA"):
        picture = picture.convert("RGB")
    return np.asarray(picture.convert("L"), dtype=np.float32) / np.float32(255.0)


def _shrunk(darkness: Darkness) -> Darkness:
    """Means of blocks, where there are more pixels than any pen draws."""
    factor = -(-max(darkness.shape) // LARGEST_SIDE_PX)
    if factor == 1 or min(darkness.shape) < factor:
        return darkness
    return block_means(darkness, factor)


def block_means(values: Darkness, factor: int) -> Darkness:
    """Means of squares of so many pixels; what is left over at the ends is spread over squares that are not whole."""
    rows, columns = (np.arange(0, length, factor) for length in values.shape)
    sums = np.add.reduceat(np.add.reduceat(values, rows, axis=0), columns, axis=1)
    heights, widths = (
        np.diff(np.append(starts, length)) for starts, length in zip((rows, columns), values.shape, strict=True)
    )
    return np.asarray(sums / (heights[:, None] * widths), dtype=np.float32)


def _dpi(told: object) -> tuple[float, float] | None:
    """What programs write that know no better is no size."""
    try:
        across, down = (float(value) for value in told)  # type: ignore[attr-defined]
    except (TypeError, ValueError, ZeroDivisionError):
        return None
    least, most = _SANE_DPI
    return (across, down) if least <= across <= most and least <= down <= most else None
