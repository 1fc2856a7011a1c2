"""How the pictures look: one style, whatever the user's own matplotlib settings say.

Colours are from the palette of Okabe and Ito, "Color Universal Design" (2008), which people with any
of the common colour vision deficiencies can tell apart; the pen is told from the limits by lightness too.
"""

from __future__ import annotations

from contextlib import AbstractContextManager

import matplotlib.style
from matplotlib.figure import Figure

BLUE = "#0072B2"
VERMILION = "#D55E00"
PALE_ORANGE = "#F2C66D"  # the orange E69F00, lighter, to lie under thin lines
GREY = "#8C8C8C"
INK = "#222222"

_LONGEST_HEADING = 44  # characters, however wide, that leave room for a legend beside them

_STYLE = {
    "font.family": "DejaVu Sans",  # comes with matplotlib, so a picture is the same everywhere
    "font.size": 8.0,
    "text.color": INK,
    "axes.labelcolor": INK,
    "axes.edgecolor": "#777777",
    "axes.linewidth": 0.6,
    "axes.labelsize": 8.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "xtick.color": "#555555",
    "ytick.color": "#555555",
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "lines.solid_joinstyle": "round",
    "lines.solid_capstyle": "round",
    "savefig.dpi": 240.0,
    "pdf.fonttype": 42,
    "svg.hashsalt": "plan",  # the same trajectory gives the same file, byte for byte
    "agg.path.chunksize": 20_000,
}


def planner_style() -> AbstractContextManager[None]:
    """The style as a context: needed both where a figure is made and where it is saved."""
    return matplotlib.style.context(_STYLE, after_reset=True)


def set_title(figure: Figure, heading: str, remark: str, left_in: float) -> None:
    """Two lines at the top left, `left_in` inches from the edge: what is shown in bold, and a remark."""
    width_in, height_in = (float(side) for side in figure.get_size_inches())
    heading = _printable(heading)
    if len(heading) > _LONGEST_HEADING:
        heading = heading[:_LONGEST_HEADING - 1] + "…"
    # a file name may hold dollar signs, which would be taken for a formula
    figure.text(left_in / width_in, 1 - 0.14 / height_in, heading, va="top", size=11, weight="bold", parse_math=False)
    figure.text(left_in / width_in, 1 - 0.37 / height_in, _printable(remark), va="top", size=8.5, color="#555555",
                parse_math=False)


def _printable(text: str) -> str:
    """`text` without characters that no font has and no XML file may hold."""
    return "".join(character if character.isprintable() else "\N{REPLACEMENT CHARACTER}" for character in text)
