"""How the pictures look: one style, whatever the user's own matplotlib settings say.

Colours are from the palette of Okabe and Ito, "Color Universal Design" (2008), which people with any
of the common colour vision deficiencies can tell apart; the pen is told from the limits by lightness too. What runs
from little to much is told by viridis, which grows in lightness alike for all of them.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass
from enum import StrEnum

import matplotlib as mpl
import matplotlib.style
import numpy as np
from matplotlib.colors import Colormap, ListedColormap

LIMIT_DASHES = (0, (5, 2))
"""Line style of every limit."""


class Theme(StrEnum):
    LIGHT = "light"
    DARK = "dark"


class Size(StrEnum):
    PAPER = "paper"
    """As wide as the text of a page: 180 mm, letters of 7 points."""
    SCREEN = "screen"
    """1920 pixels wide."""


@dataclass(frozen=True, slots=True)
class Colours:
    """What has which colour. surface: the ground of it all. ink, quiet: letters, and what is said in passing.
    paper: what is drawn on, which is light in any theme.
    scale: the part of viridis that stands out from the ground."""

    surface: str
    ink: str
    quiet: str
    edge: str
    ring: str
    ring_edge: str
    paper: str
    paper_edge: str
    drawn: str
    limit: str
    wanted: str
    travel: str
    lifting: str
    lowering: str
    resting: str
    link: str
    scale: tuple[float, float]

    def colour_map(self, n_levels: int) -> Colormap:
        return ListedColormap(mpl.colormaps["viridis"](np.linspace(*self.scale, n_levels)))


_COLOURS = {
    Theme.LIGHT: Colours(
        surface="#FFFFFF",
        ink="#222222",
        quiet="#555555",
        edge="#777777",
        ring="#F1F1EE",
        ring_edge="#B5B5AE",
        paper="#FFFEFA",
        paper_edge="#B9B4A6",
        drawn="#0072B2",
        limit="#D55E00",
        wanted="#F2C66D",
        travel="#8C8C8C",
        lifting="#009E73",
        lowering="#D55E00",
        resting="#CC79A7",
        link="#3C4246",
        scale=(0.0, 0.88),
    ),
    Theme.DARK: Colours(
        surface="#15181B",
        ink="#E8E8E4",
        quiet="#ABB0B3",
        edge="#83898D",
        ring="#20262A",
        ring_edge="#4B5358",
        paper="#FFFEFA",
        paper_edge="#B9B4A6",
        drawn="#56B4E9",
        limit="#F08A3C",
        wanted="#5E4A16",
        travel="#8C9296",
        lifting="#2BC79A",
        lowering="#F08A3C",
        resting="#D998BC",
        link="#C9CDCF",
        scale=(0.2, 1.0),
    ),
}
_SIZES = {Size.PAPER: (180 / 25.4, 7.0, 300.0), Size.SCREEN: (12.8, 9.5, 150.0)}


@dataclass(frozen=True, slots=True)
class Look:
    """Colours and measures of a picture. Lengths that go with the letters are told in em, the size of a letter."""

    colours: Colours
    width_in: float
    letter_pt: float
    dpi: float

    @staticmethod
    def of(theme: Theme = Theme.LIGHT, size: Size = Size.SCREEN, dpi: float | None = None) -> Look:
        """dpi: pixels per inch of a PNG or a film; None for 300 on paper and 150 on a screen."""
        width_in, letter_pt, usual_dpi = _SIZES[size]
        return Look(_COLOURS[theme], width_in, letter_pt, dpi or usual_dpi)

    @property
    def em_in(self) -> float:
        """Inches in an em."""
        return self.letter_pt / 72

    def style(self) -> AbstractContextManager[None]:
        """The style as a context: needed both where a figure is made and where it is saved."""
        colours, letter = self.colours, self.letter_pt
        line = letter / 13  # 0.6 points beside letters of 8
        return matplotlib.style.context(
            {
                "font.family": "DejaVu Sans",  # comes with matplotlib, so a picture is the same everywhere
                "font.size": letter,
                "text.color": colours.ink,
                "figure.facecolor": colours.surface,
                "savefig.facecolor": colours.surface,
                "axes.facecolor": colours.surface,
                "axes.labelcolor": colours.ink,
                "axes.edgecolor": colours.edge,
                "axes.linewidth": line,
                "axes.labelsize": letter,
                "axes.titlecolor": colours.ink,
                "axes.spines.top": False,
                "axes.spines.right": False,
                "xtick.labelsize": 0.88 * letter,
                "ytick.labelsize": 0.88 * letter,
                "xtick.color": colours.edge,
                "ytick.color": colours.edge,
                "xtick.labelcolor": colours.ink,
                "ytick.labelcolor": colours.ink,
                "xtick.major.width": line,
                "ytick.major.width": line,
                "xtick.major.size": 0.3 * letter,
                "ytick.major.size": 0.3 * letter,
                "legend.frameon": False,
                "legend.fontsize": letter,
                "lines.solid_joinstyle": "round",
                "lines.solid_capstyle": "round",
                "savefig.dpi": self.dpi,
                "figure.dpi": self.dpi,
                "pdf.fonttype": 42,
                "svg.hashsalt": "plan",  # the same trajectory gives the same file, byte for byte
                "agg.path.chunksize": 20_000,
            },
            after_reset=True,
        )


USUAL = Look.of()
"""The look where none is asked for: light, for a screen."""
