"""Photos and scans of drawn sheets, made without a camera; it shares nothing with what reads them.

A page is rasterised from its PDF and ink is laid on it; a pinhole camera with a lens looks at it on a table, in uneven
light, with blur, noise and JPEG. Reflectances and light are linear until the picture is encoded.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import pypdfium2
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Pixels = NDArray[np.uint8]

BLACK_INK = (0.03, 0.03, 0.04)
BLUE_INK = (0.05, 0.10, 0.45)
RED_INK = (0.55, 0.05, 0.06)
_PAPER = 0.86
_TABLE = (0.28, 0.19, 0.11)
_ROWS_AT_ONCE = 16
"""Of a picture, so that what is worked out for them stays in the cache of the processor."""


@dataclass(frozen=True, eq=False)
class Ink:
    """What a round nib leaves along a polyline (n, 2) in the sheet's frame, mm; one point is a dot.

    width_mm: of the line, or (n,) at its points. colour: reflectance of red, green and blue. density: 1 covers the
    paper."""

    points_mm: Floats
    width_mm: float | Floats
    colour: tuple[float, float, float] = BLACK_INK
    density: float = 1.0


@dataclass(frozen=True, eq=False)
class Sheet:
    """Reflectances (rows, columns, 3) of a sheet of paper, from its upper left corner."""

    reflectance: Singles
    px_per_mm: float


@dataclass(frozen=True)
class Camera:
    """Where a phone is held, and what its lens and its electronics do.

    tilt: from straight above. azimuth: the side that it is held at, 0 for behind the base. roll: about its own axis.
    fill: how much of the picture the sheet takes. radial, tangential: of Brown's model, taken from picture to scene.
    centre_off: of the optical axis, as a share of the picture. vignette: loss of light in the corners. shadows: how
    many soft edged ones lie on the sheet, and how dark they are. noise: of a white pixel, as a share of it.
    """

    width: int = 2048
    height: int = 1536
    tilt_deg: float = 30.0
    azimuth_deg: float = 0.0
    roll_deg: float = 0.0
    fill: float = 0.9
    focal_per_diagonal: float = 0.62
    radial: tuple[float, float] = (0.03, -0.02)
    tangential: tuple[float, float] = (0.001, -0.0008)
    centre_off: tuple[float, float] = (0.005, -0.004)
    vignette: float = 0.35
    gradient: float = 0.3
    shadows: int = 0
    shadow_depth: float = 0.4
    blur_px: float = 0.8
    noise: float = 0.015
    quality: int = 88


def drawn_sheet(
    pdf: Path,
    origin_page_mm: tuple[float, float],
    ink: Sequence[Ink],
    *,
    px_per_mm: float = 12.0,
    printed_at: float = 1.0,
) -> Sheet:
    """A printed sheet with ink on it. origin_page_mm: where the sheet's frame is, from the page's lower left corner.
    printed_at: the printer's scale, about the page's middle; ink lies where it is told by the frame as printed."""
    with pypdfium2.PdfDocument(pdf) as document:
        scale = px_per_mm * 25.4 / 72 * (1 - 1e-5)  # a page is stretched to whole pixels, the next more of them
        page = np.ascontiguousarray(document[0].render(scale=scale).to_numpy()[..., :3])
    printed = (0.03 + (_PAPER - 0.03) * np.arange(256) / 255).astype(np.float32)
    reflectance: Singles = np.asarray(cv2.LUT(page, printed), dtype=np.float32)
    rows, columns = reflectance.shape[:2]
    if printed_at != 1.0:
        about = cv2.getRotationMatrix2D((columns / 2, rows / 2), 0, printed_at)
        reflectance = np.asarray(
            cv2.warpAffine(reflectance, about, (columns, rows), flags=cv2.INTER_AREA, borderValue=(_PAPER,) * 3),
            dtype=np.float32,
        )
    middle = np.array([columns, rows]) / 2
    origin = np.array([origin_page_mm[0] * px_per_mm, rows - origin_page_mm[1] * px_per_mm])
    origin = middle + printed_at * (origin - middle)
    for line in ink:
        points = origin + px_per_mm * np.stack((-line.points_mm[:, 1], -line.points_mm[:, 0]), axis=-1)
        widths = np.broadcast_to(np.asarray(line.width_mm, dtype=np.float64), len(points)) * px_per_mm
        _lay(reflectance, points, widths, line)
    return Sheet(reflectance, px_per_mm)


def _lay(reflectance: Singles, points: Floats, widths: Floats, line: Ink) -> None:
    """Ink on the pixels near a polyline, covered by how far their middles are within it."""
    reach = widths.max() / 2 + 2
    low = np.maximum(np.floor(points.min(axis=0) - reach).astype(int), 0)
    high = np.minimum(np.ceil(points.max(axis=0) + reach).astype(int), reflectance.shape[1::-1])
    if np.any(high <= low):
        return
    within = np.full(tuple((high - low)[::-1]), -np.inf)
    for start, end, first, last in zip(
        points, [*points[1:], points[-1]], widths, [*widths[1:], widths[-1]], strict=True
    ):
        near_low = np.clip(np.floor(np.minimum(start, end) - reach).astype(int), low, high)
        near_high = np.clip(np.ceil(np.maximum(start, end) + reach).astype(int), low, high)
        grid = np.stack(
            np.meshgrid(np.arange(near_low[0], near_high[0]) + 0.5, np.arange(near_low[1], near_high[1]) + 0.5), axis=-1
        )
        along = end - start
        share = np.clip(((grid - start) @ along) / max(along @ along, 1e-12), 0.0, 1.0)
        distance = np.linalg.norm(grid - start - share[..., None] * along, axis=-1)
        part = within[near_low[1] - low[1] : near_high[1] - low[1], near_low[0] - low[0] : near_high[0] - low[0]]
        np.maximum(part, (first + share * (last - first)) / 2 - distance, out=part)
    cover = (line.density * np.clip(within + 0.5, 0.0, 1.0))[..., None].astype(np.float32)
    part = reflectance[low[1] : high[1], low[0] : high[0]]
    part *= 1 - cover * (1 - np.array(line.colour, dtype=np.float32))


def photograph(sheet: Sheet, camera: Camera, seed: int = 0) -> Pixels:
    """(height, width, 3) blue, green, red, as JPEG left them: a photo of the sheet on a table."""
    rng = np.random.default_rng(seed)
    page = sheet.reflectance.shape[1] / sheet.px_per_mm, sheet.reflectance.shape[0] / sheet.px_per_mm
    to_page = np.linalg.inv(_scene_to_picture(page, camera))
    paper = cv2.GaussianBlur(sheet.reflectance, (0, 0), 0.5)
    finer = 2
    u, v, _ = _seen(camera, to_page, finer)
    scene = cv2.remap(
        paper,
        u * np.float32(sheet.px_per_mm) - np.float32(0.5),
        v * np.float32(sheet.px_per_mm) - np.float32(0.5),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_CONSTANT,
        borderValue=_TABLE,
    )
    scene = cv2.resize(scene, (camera.width, camera.height), interpolation=cv2.INTER_AREA)
    u, v, radius2 = _seen(camera, to_page, 0.25)  # light and grain are coarse
    light = _light(u / page[0], v / page[1], camera, rng) * (1 - camera.vignette * radius2)
    off_paper = (u < 0) | (u > page[0]) | (v < 0) | (v > page[1])
    light *= np.where(off_paper, _grain(u, v, rng), 1)
    scene *= cv2.resize(light.astype(np.float32), (camera.width, camera.height))[..., None]
    return _developed(cv2.GaussianBlur(scene, (0, 0), camera.blur_px), camera.noise, camera.quality, rng)


def scan(sheet: Sheet, *, dpi: float = 300.0, turned_deg: float = 1.5, seed: int = 0, noise: float = 0.006) -> Pixels:
    """(rows, columns, 3): a flat-bed scan, lid white, the sheet a little askew."""
    rng = np.random.default_rng(seed)
    rows, columns = sheet.reflectance.shape[:2]
    scale = dpi / 25.4 / sheet.px_per_mm
    turn = cv2.getRotationMatrix2D((columns / 2, rows / 2), turned_deg, scale)
    size = (round(columns * scale * 1.06), round(rows * scale * 1.06))
    turn[:, 2] += np.array(size) / 2 - np.array([columns, rows]) / 2
    smooth = cv2.GaussianBlur(sheet.reflectance, (0, 0), max(0.4 / scale, 0.4))
    scene = cv2.warpAffine(smooth, turn, size, flags=cv2.INTER_LINEAR, borderValue=(0.9, 0.9, 0.9))
    return _developed(np.asarray(scene, dtype=np.float32) * 1.05, noise, 92, rng)


def _seen(camera: Camera, to_page: Floats, finer: float) -> tuple[Singles, Singles, Singles]:
    """What each of `finer` pixels to a pixel sees, the lens undone: u and v on the page, mm from its upper left corner;
    and its squared distance from the optical axis, in half diagonals."""
    height, width = round(camera.height * finer), round(camera.width * finer)
    half = np.hypot(width, height) / 2
    x = ((np.arange(width) + 0.5 - width * (0.5 + camera.centre_off[0])) / half).astype(np.float32)[None, :]
    y = ((np.arange(height) + 0.5 - height * (0.5 + camera.centre_off[1])) / half).astype(np.float32)[:, None]
    (k1, k2), (p1, p2) = camera.radial, camera.tangential
    focal = 2 * camera.focal_per_diagonal
    m = to_page.astype(np.float32)
    seen: tuple[Singles, Singles, Singles] = (*(np.empty((height, width), dtype=np.float32) for _ in range(3)),)
    for begin in range(0, height, _ROWS_AT_ONCE):
        rows = slice(begin, begin + _ROWS_AT_ONCE)
        down = y[rows]
        r2 = x * x + down * down
        grown = 1 + r2 * (k1 + k2 * r2)
        ray_x = (x * (grown + 2 * p1 * down) + p2 * (r2 + 2 * x * x)) / focal
        ray_y = (down * (grown + 2 * p2 * x) + p1 * (r2 + 2 * down * down)) / focal
        depth = m[2, 0] * ray_x + m[2, 1] * ray_y + m[2, 2]
        seen[0][rows] = (m[0, 0] * ray_x + m[0, 1] * ray_y + m[0, 2]) / depth
        seen[1][rows] = (m[1, 0] * ray_x + m[1, 1] * ray_y + m[1, 2]) / depth
        seen[2][rows] = r2
    return seen


def _scene_to_picture(page_mm: tuple[float, float], camera: Camera) -> Floats:
    """(3, 3): the homography from the page, mm from its upper left corner and v down, to rays at depth 1."""
    size = np.array(page_mm)
    tilt, azimuth, roll = np.deg2rad([camera.tilt_deg, camera.azimuth_deg, camera.roll_deg])
    turned = _about_z(roll) @ _about_x(tilt) @ _about_z(azimuth)
    corners = np.array([[-0.5, -0.5, 0], [0.5, -0.5, 0], [0.5, 0.5, 0], [-0.5, 0.5, 0]]) * [*size, 0] @ turned.T
    diagonal = np.hypot(camera.width, camera.height)
    room = camera.fill * np.array([camera.width, camera.height]) / (2 * camera.focal_per_diagonal * diagonal)
    distance = 1.0
    for _ in range(60):  # as near as the sheet still fits the picture
        seen = np.abs(corners[:, :2] / (corners[:, 2:] + distance))
        distance *= max((seen / room).max(), 0.5)
        distance = max(distance, 1.05 * -corners[:, 2].min())
    return np.column_stack((turned[:, 0], turned[:, 1], turned @ [-size[0] / 2, -size[1] / 2, 0] + [0, 0, distance]))


def _about_x(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def _about_z(angle: float) -> Floats:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def _grain(u: Singles, v: Singles, rng: np.random.Generator) -> Singles:
    """Of wood, along u: shares of its light."""
    coarse = cv2.GaussianBlur(rng.normal(size=(256, 256)).astype(np.float32), (0, 0), sigmaX=12, sigmaY=0.9)
    coarse = np.clip(1 + 0.18 * coarse / coarse.std(), 0.3, 2).astype(np.float32)
    return cv2.remap(
        coarse, np.mod(u, 250).astype(np.float32), np.mod(v * 1.5, 250).astype(np.float32), cv2.INTER_LINEAR
    )


def _light(across: Singles, along: Singles, camera: Camera, rng: np.random.Generator) -> Singles:
    """Light on each pixel, from shares of the sheet's extent: a gradient, and shadows of round things."""
    angle = rng.uniform(0, 2 * np.pi)
    light = 1 + camera.gradient * ((across - 0.5) * np.cos(angle) + (along - 0.5) * np.sin(angle))
    for _ in range(camera.shadows):
        middle, radius = rng.uniform(0.1, 0.9, 2), rng.uniform(0.15, 0.4)
        softness = rng.uniform(0.01, 0.06)
        away = np.hypot(across - middle[0], along - middle[1]) - radius
        light *= 1 - camera.shadow_depth / (1 + np.exp(np.clip(away / softness * 4, -30, 30)))
    return np.clip(light, 0.05, None).astype(np.float32)


def _developed(scene: Singles, noise: float, quality: int, rng: np.random.Generator) -> Pixels:
    """Shot noise, the curve of sRGB, and JPEG; red, green, blue to blue, green, red."""
    curve = np.linspace(0, 1, 4096)
    curve = np.where(curve <= 0.0031308, 12.92 * curve, 1.055 * curve ** (1 / 2.4) - 0.055)
    shades = np.rint(255 * curve).astype(np.uint8)
    picture = np.empty(scene.shape, dtype=np.uint8)
    for begin in range(0, len(scene), _ROWS_AT_ONCE):
        rows = scene[begin : begin + _ROWS_AT_ONCE]
        rows += np.float32(noise) * np.sqrt(np.clip(rows, 0.02, 1)) * rng.standard_normal(rows.shape, dtype=np.float32)
        steps = np.rint(np.clip(rows[..., ::-1], 0, 1) * np.float32(4095)).astype(np.uint16)
        picture[begin : begin + _ROWS_AT_ONCE] = shades[steps]
    good, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, quality])
    assert good
    decoded = cv2.imdecode(data, cv2.IMREAD_COLOR)
    assert decoded is not None
    return np.asarray(decoded, dtype=np.uint8)
