"""The film in a report: the player's page in a frame of its own, of a bounded size."""

from __future__ import annotations

import base64
import hashlib
import re

from planner.arrays import FloatArray
from planner.plots.look import Look, Theme
from planner.plots.motion import Motion
from planner.plots.player import player_page
from planner.report.markup import Markup, element, joined

_MOST_POSES = 8_000


def film(motion: Motion, canvas_mm: FloatArray, reach_mm: tuple[float, float] | None) -> tuple[Markup, str]:
    """The frame, and the hash of the one script in it as a content security policy writes it: the page around has to
    let it run, and nothing else."""
    looks = (Look.of(theme) for theme in Theme)
    page = player_page(motion, canvas_mm, reach_mm, next(looks), dark=next(looks), most=_MOST_POSES, plays=False)
    (script,) = re.findall(r"<script>(.*?)</script>", page, flags=re.DOTALL)
    digest = base64.b64encode(hashlib.sha256(script.encode("utf-8")).digest()).decode("ascii")
    frame = element("iframe", srcdoc=page, sandbox="allow-scripts", title="the arm as it draws", loading="lazy")
    told = element("p", "The arm as it draws, from above and square to it; lengths in mm. Press Play.")
    return joined((told, frame)), f"'sha256-{digest}'"
