"""Films to files: GIF, MP4, or one HTML file with a player in it, whole or not at all."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import chain
from pathlib import Path
from typing import IO, cast

import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

from planner.arrays import FloatArray
from planner.errors import OutputError, UsageError
from planner.files import is_standard_output, written_aside
from planner.plots.film import Film, Frame
from planner.plots.look import USUAL, Colours, Look
from planner.plots.motion import Motion
from planner.plots.player import player_page
from planner.progress import Report, unreported

FORMATS = ("html", "gif", "mp4")
_MOST_GIF_FRAMES = 6000  # all of a GIF's frames are in memory before it is written
_PALETTE = 256
_SHADES = 9  # from a ground to a colour on it, for the edges of lines


def film_format(target: Path) -> str:
    """ "html", "gif" or "mp4", from the suffix in either case; "gif" for standard output.

    Errors: UsageError naming those that work, or where there is no ffmpeg to make an MP4.
    """
    if not target.suffix and is_standard_output(target):
        return "gif"
    suffix = target.suffix.lower().removeprefix(".")
    if suffix not in FORMATS:
        given = f"'{target.suffix}'" if target.suffix else "no suffix"
        raise UsageError(
            f"{target}: a film file ends in one of {', '.join(f'.{name}' for name in FORMATS)}; this one has {given}"
        )
    if suffix == "mp4":
        _ffmpeg()
    return suffix


def save_film(
    motion: Motion,
    target: Path,
    canvas_corners_mm: FloatArray | None = None,
    reach_mm: tuple[float, float] | None = None,
    look: Look = USUAL,
    report: Report = unreported,
) -> None:
    """Write the film in the format that the suffix names; nothing is left behind where that fails.

    canvas_corners_mm (4, 2), reach_mm: drawn on the paper, where known.
    Errors: UsageError (unknown suffix, no ffmpeg, too long for a GIF), OutputError.
    """
    kind = film_format(target)
    if kind == "html":
        page = player_page(motion, canvas_corners_mm, reach_mm, look)
        with written_aside(target) as file:
            cast("IO[str]", file).write(page)
        return
    film = Film(motion, canvas_corners_mm, reach_mm, look)
    if kind == "gif" and film.n_frames > _MOST_GIF_FRAMES:
        raise UsageError(
            f"a GIF of {film.n_frames} pictures is too large; choose a greater --speed-factor or a part "
            "(--from, --to), or write an .mp4 or .html"
        )
    with look.style(), written_aside(target, binary=True) as file:
        frames = _shown(film, report)
        if kind == "gif":
            _write_gif(frames, motion.fps, _palette(look.colours, film.ink_colours), cast("IO[bytes]", file))
        else:
            _write_mp4(frames, motion.fps, cast("IO[bytes]", file), target)


def _shown(film: Film, report: Report) -> Iterator[Frame]:
    for done, frame in enumerate(film.frames()):
        report("filming", done, film.n_frames)
        yield frame


def _palette(colours: Colours, inks: Sequence[str]) -> Image.Image:
    """Every colour of a film on every ground, and the shades between: as many as a palette holds."""
    drawn_with = (colours.ink, colours.quiet, colours.edge, colours.ring_edge, colours.limit, colours.link, *inks)
    grounds, lines = (
        np.array([to_rgb(colour) for colour in chosen])
        for chosen in ((colours.surface, colours.ring, colours.paper), drawn_with)
    )
    n_shades = min(max(_PALETTE // (len(grounds) * len(lines)), 2), _SHADES)
    lines = lines[: _PALETTE // (len(grounds) * n_shades)]
    share = np.linspace(0, 1, n_shades)[:, np.newaxis]
    shades = [(1 - share) * ground + share * line for ground in grounds for line in lines]
    palette = Image.new("P", (1, 1))
    palette.putpalette(np.rint(255 * np.concatenate(shades)).astype(np.uint8).tobytes())
    return palette


def _write_gif(frames: Iterator[Frame], fps: float, palette: Image.Image, file: IO[bytes]) -> None:
    """GIF counts hundredths of a second: frames end at the nearest, so that the whole lasts as long as it should."""
    pictures = (Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    ends = np.rint(100 / fps * np.arange(_MOST_GIF_FRAMES + 2))
    opening = next(pictures)
    opening.save(
        file,
        format="gif",
        save_all=True,
        append_images=pictures,
        loop=0,
        disposal=1,
        optimize=False,
        duration=(10 * np.diff(ends).astype(int)).tolist(),
    )


def _write_mp4(frames: Iterator[Frame], fps: float, file: IO[bytes], target: Path) -> None:
    first = next(frames)
    height, width = first.shape[:2]
    with tempfile.TemporaryDirectory(prefix="plan-film-") as folder:
        film = Path(folder) / "film.mp4"
        command = [
            _ffmpeg(),
            "-loglevel",
            "error",
            "-f",
            "rawvideo",
            "-pix_fmt",
            "rgb24",
            "-s",
            f"{width}x{height}",
            "-r",
            f"{fps:g}",
            "-i",
            "-",
            "-c:v",
            "libx264",
            "-pix_fmt",
            "yuv420p",
            "-crf",
            "18",
            "-movflags",
            "+faststart",
            str(film),
        ]
        with (
            (Path(folder) / "log").open("w+b") as log,
            subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=log) as encoder,
        ):
            try:
                with suppress(BrokenPipeError), cast("IO[bytes]", encoder.stdin) as pipe:  # it says why when it ends
                    for frame in chain([first], frames):
                        pipe.write(frame.tobytes())
            except BaseException:
                encoder.kill()
                raise
            if encoder.wait():
                log.seek(0)
                said = log.read().decode(errors="replace").strip().splitlines()
                raise OutputError(str(target), f"ffmpeg failed: {said[-1] if said else 'it does not say why'}")
        with film.open("rb") as made:
            shutil.copyfileobj(made, file)


def _ffmpeg() -> str:
    """The program that encodes. Errors: UsageError naming the extra that brings it."""
    found = shutil.which("ffmpeg")
    if found:
        return found
    try:
        import imageio_ffmpeg
    except ImportError:
        raise UsageError(
            "an .mp4 film needs ffmpeg: install it, or pip install 'drawing-arm-planner[film]'; "
            ".gif and .html need nothing"
        ) from None
    return str(imageio_ffmpeg.get_ffmpeg_exe())
