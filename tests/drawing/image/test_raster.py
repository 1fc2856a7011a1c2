"""Pictures of all kinds as darkness, and what is no picture."""

from __future__ import annotations

import struct
import zlib
from contextlib import suppress

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from planner.drawing.raster import RasterError, is_raster, read_raster
from tests.drawing.image.pictures import file_of

GREYS = np.array([[0, 64, 128], [192, 255, 32]], dtype=np.uint8)
DARKNESS = 1.0 - GREYS / 255.0


@pytest.mark.parametrize("kind", ["PNG", "GIF", "TIFF", "BMP", "PPM", "WEBP"])
def test_a_grey_is_as_dark_in_every_format(kind: str) -> None:
    data = file_of(GREYS, kind, **({"lossless": True} if kind == "WEBP" else {}))
    assert is_raster(data)
    assert read_raster(data).darkness == pytest.approx(DARKNESS, abs=0.005)


def test_deep_palette_and_colour_pictures_are_as_dark_as_they_look() -> None:
    deep = Image.fromarray(GREYS.astype(np.uint16) * 257)
    assert read_raster(file_of(deep)).darkness == pytest.approx(DARKNESS, abs=1e-4)
    grey = Image.fromarray(GREYS)
    for mode in ("RGB", "P", "RGBA", "LA"):
        assert read_raster(file_of(grey.convert(mode))).darkness == pytest.approx(DARKNESS, abs=0.005)
    inks = Image.merge("CMYK", [Image.new("L", (3, 2), 0)] * 3 + [Image.fromarray(255 - GREYS)])
    assert read_raster(file_of(inks, "TIFF")).darkness == pytest.approx(DARKNESS, abs=0.01)
    assert read_raster(file_of(Image.new("1", (2, 2), 0))).darkness == pytest.approx(1.0)


def test_what_is_transparent_is_paper() -> None:
    black = np.zeros((2, 3, 4), dtype=np.uint8)
    black[..., 3] = GREYS
    assert read_raster(file_of(black)).darkness == pytest.approx(GREYS / 255.0, abs=0.005)
    palette = Image.fromarray(np.array([[0, 1]], dtype=np.uint8)).convert("P")
    palette.putpalette([0, 0, 0, 0, 0, 0])
    assert read_raster(file_of(palette, transparency=0)).darkness == pytest.approx(np.array([[0.0, 1.0]]))


def test_a_camera_says_which_way_up() -> None:
    picture = Image.fromarray(np.full((20, 40), 255, dtype=np.uint8))
    picture.paste(0, (0, 0, 10, 10))
    exif = Image.Exif()
    exif[0x0112] = 6  # the top of the picture is its right side
    raster = read_raster(file_of(picture, exif=exif, dpi=(100, 200)))
    assert raster.size_px == (20, 40)
    assert raster.darkness[:8, 12:].min() > 0.9 and raster.darkness[12:].max() < 0.1
    assert raster.dpi == pytest.approx((200, 100), rel=1e-3)


def test_a_resolution_that_means_nothing_is_none() -> None:
    assert read_raster(file_of(GREYS, dpi=(300, 300))).dpi == pytest.approx((300, 300), rel=1e-3)
    for told in ({"dpi": (1, 1)}, {"dpi": (50_000, 50_000)}, {}):
        assert read_raster(file_of(GREYS, **told)).dpi is None


def test_large_pictures_are_shrunk_by_means() -> None:
    checks = np.kron(np.indices((300, 4500)).sum(axis=0) % 2, np.ones((1, 1))) * 255
    raster = read_raster(file_of(checks.astype(np.uint8)))
    assert raster.size_px == (4500, 300) and raster.darkness.shape == (150, 2250)
    assert raster.darkness == pytest.approx(0.5, abs=0.01)


def bomb(width: int, height: int) -> bytes:
    """A small PNG that says that it is large."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(bytes(1000))) + chunk(b"IEND", b"")


@pytest.mark.parametrize("size", [(9000, 9000), (60_000, 60_000), (2**31 - 1, 2**31 - 1)])
def test_decompression_bombs_are_refused_before_they_go_off(size: tuple[int, int]) -> None:
    with pytest.raises(RasterError, match="50 million are the most"):
        read_raster(bomb(*size))


@settings(deadline=None, max_examples=60)
@given(st.sampled_from(["PNG", "JPEG", "GIF", "TIFF", "BMP", "WEBP"]), st.data())
def test_damaged_files_are_read_or_refused(kind: str, data: st.DataObject) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (40, 50, 3)).astype(np.uint8)
    whole = bytearray(file_of(noise, kind))
    for _ in range(data.draw(st.integers(0, 4))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    del whole[data.draw(st.integers(0, len(whole))) :]
    with suppress(RasterError):
        darkness = read_raster(bytes(whole)).darkness
        assert np.all((darkness >= 0.0) & (darkness <= 1.0))
