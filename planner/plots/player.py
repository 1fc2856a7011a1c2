"""A film as one HTML file: the motion as numbers, and a small player that draws them. It needs nothing else, and its
content security policy lets it load nothing else.
"""

from __future__ import annotations

import html
import json
from importlib.resources import files

from planner.arrays import FloatArray
from planner.plots.film_values import MOST_POSES, film_of
from planner.plots.look import USUAL, Look
from planner.plots.motion import Motion


def player_page(
    motion: Motion,
    canvas_corners_mm: FloatArray | None = None,
    reach_mm: tuple[float, float] | None = None,
    look: Look = USUAL,
    *,
    dark: Look | None = None,
    most: int = MOST_POSES,
    plays: bool = True,
) -> str:
    """The page of one film. dark: the look where the reader's system is dark; None for the same. most: as of `film_of`.
    plays: whether it begins by itself, or shows what is drawn and waits."""
    film = film_of(motion, canvas_corners_mm, reach_mm, most=most) | {
        "plays": plays,
        "colours": [_colours_of(one) for one in (look, dark or look)],
    }
    folder = files("planner.plots")
    template = folder.joinpath("player.html").read_text(encoding="utf-8")
    reader = folder.joinpath("film_reader.js").read_text(encoding="utf-8")
    # a name must not end the script that it stands in
    return (
        template.replace("$TITLE", html.escape(f"{film['name']} on {motion.arm.name}"))
        .replace("$READER", reader.replace("export function", "function"))
        .replace("$FILM", json.dumps(film).replace("<", "\\u003c"))
    )


def _colours_of(look: Look) -> dict[str, str]:
    keys = ("surface", "ink", "quiet", "edge", "ring", "ring_edge", "paper", "paper_edge", "drawn", "limit", "link")
    return {key: getattr(look.colours, key) for key in keys}
