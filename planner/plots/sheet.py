"""A figure laid out in em: panels in a body, under a heading, a remark and a legend."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from planner.plots.look import Look

_WIDEST = 1.55  # em of the widest letter in a heading
_EDGE, _REMARK, _LEGEND, _BODY = 1.6, 3.7, 5.5, 7.2
_LINE = 1.9
_HANDLE, _GAP, _PER_CHARACTER = 2.6, 1.6, 0.6


class Sheet:
    """Panels are placed while the height of the whole is open; `finish` adds what stands above them.

    Places are in em from the bottom left corner.
    """

    def __init__(self, look: Look) -> None:
        self.look = look
        self.figure = Figure(figsize=(look.width_in, look.width_in))
        self._placed: list[tuple[Axes, tuple[float, float, float, float]]] = []

    @property
    def width(self) -> float:
        return self.look.width_in / self.look.em_in

    def panel(self, left: float, bottom: float, width: float, height: float, *, share_x: Axes | None = None) -> Axes:
        # distinct until their place is known
        axes = self.figure.add_axes((0.0, 0.0, 1.0, 1.0), sharex=share_x, label=f"panel {len(self._placed)}")
        self._placed.append((axes, (left, bottom, width, height)))
        return axes

    def beside(self, axes: Axes, gap: float, width: float) -> Axes:
        """A panel to the right of another, as high as that."""
        left, bottom, wide, high = dict(self._placed)[axes]
        return self.panel(left + wide + gap, bottom, width, high)

    def width_of(self, axes: Axes) -> float:
        """Of a panel, in em."""
        return dict(self._placed)[axes][2]

    def finish(self, heading: str, remark: str, legend: Sequence[Artist] = (), room: float = 0.0) -> Figure:
        """The figure, with a line in bold, a remark, and the labels of the legend's artists in as many rows as they
        need. room: em left free above the highest panel."""
        body = max(bottom + height for _, (_, bottom, _, height) in self._placed) + room
        n_columns = self._columns([str(artist.get_label()) for artist in legend])
        n_rows = -(-len(legend) // n_columns)
        height = body + (_BODY + (n_rows - 1) * _LINE if legend else _LEGEND)
        self.figure.set_size_inches(self.look.width_in, height * self.look.em_in)
        for axes, (left, bottom, wide, high) in self._placed:
            axes.set_position((left / self.width, bottom / height, wide / self.width, high / height))
        heading = _printable(heading)
        longest = int((self.width - 2 * _EDGE) / _WIDEST)
        if len(heading) > longest:
            heading = heading[: longest - 1] + "…"
        left, letter = _EDGE / self.width, self.look.letter_pt
        # a file name may hold dollar signs, which would be taken for a formula
        self.figure.text(
            left, 1 - _EDGE / height, heading, va="top", size=1.35 * letter, weight="bold", parse_math=False
        )
        self.figure.text(
            left, 1 - _REMARK / height, _printable(remark), va="top", color=self.look.colours.quiet, parse_math=False
        )
        if legend:
            self.figure.legend(
                handles=list(legend),
                loc="upper left",
                ncols=n_columns,
                borderaxespad=0,
                borderpad=0,
                handlelength=1.8,
                handletextpad=0.6,
                columnspacing=1.6,
                labelspacing=0.5,
                bbox_to_anchor=(left, 1 - _LEGEND / height),
            )
        return self.figure

    def _columns(self, labels: Sequence[str]) -> int:
        """As many as surely fit: columns are as wide as their widest label."""
        for n_columns in range(len(labels), 1, -1):
            widths = [max(map(len, labels[first::n_columns])) for first in range(n_columns)]
            if sum(_HANDLE + _GAP + _PER_CHARACTER * width for width in widths) < self.width - 2 * _EDGE:
                return n_columns
        return 1


def _printable(text: str) -> str:
    """`text` without characters that no font has and no XML file may hold."""
    return "".join(character if character.isprintable() else "\N{REPLACEMENT CHARACTER}" for character in text)
