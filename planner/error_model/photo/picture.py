"""A picture from its file."""

from __future__ import annotations

import io
import struct
import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageOps, UnidentifiedImageError

from planner.error_model.photo.errors import PhotoError

Picture = NDArray[np.uint8]
"""(rows, columns, 3): blue, green, red."""

LINEAR_LIGHT = (np.arange(256) / 255) ** 2.2
"""How much light the 256 values of a picture stand for, about."""

_LEAST_PX = 400
_NO_PICTURE = (
    "it is no whole picture that can be read; wanted JPEG, PNG or TIFF (a phone's HEIC has to be saved as "
    "one of them first)"
)


def read_picture(source: Path) -> Picture:
    """The picture in a file, the way up that its camera says. Errors: PhotoError."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of its size, and of damage that does no harm
            with Image.open(io.BytesIO(source.read_bytes())) as opened:
                upright = ImageOps.exif_transpose(opened).convert("RGB")
    except Image.DecompressionBombError as error:
        raise PhotoError(str(source), "it has too many pixels; save it smaller, 12 megapixels are plenty") from error
    except (UnidentifiedImageError, SyntaxError, ValueError, EOFError, struct.error) as error:
        raise PhotoError(str(source), _NO_PICTURE) from error
    except OSError as error:
        reason = _NO_PICTURE if error.errno is None else f"cannot be read: {error.strerror or error}"
        raise PhotoError(str(source), reason) from error
    if min(upright.size) < _LEAST_PX:
        raise PhotoError(
            str(source),
            f"{upright.width} x {upright.height} pixels are too few for a whole sheet; send the photo at its full size",
        )
    return np.ascontiguousarray(np.asarray(upright, dtype=np.uint8)[..., ::-1])
