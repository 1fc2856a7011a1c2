"""The picture of the single-line faces, as a pen would write them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from planner.drawing.text.faces import Face
from planner.drawing.text.specimen import Line, written
from planner.plots.look import USUAL, Look
from planner.plots.sheet import Sheet

_EDGE, _LABEL = 1.6, 1.4  # em
_CAPITAL, _PITCH, _ABOVE = 1.5, 3.6, 1.2
"""Height of capitals, from one line to the next, and above the first, in em."""
_PEN = 0.9  # points


def plot_faces(faces: Mapping[str, Face], texts: Sequence[str], look: Look = USUAL) -> Figure:
    """A block for each face, by the kind of font that it stands for, with each text in a line of its own; lines that
    are too long for the sheet make all of them smaller."""
    with look.style():
        sheet = Sheet(look)
        width = sheet.width - 2 * _EDGE
        lines = {kind: [written(text, face) for text in texts] for kind, face in faces.items()}
        widest = max((line.width for block in lines.values() for line in block), default=1.0)
        capital = min(_CAPITAL, width / max(widest, 1e-9))
        pitch = _PITCH * capital / _CAPITAL
        height = _LABEL + pitch * len(texts) + _ABOVE
        for place, (kind, face) in enumerate(reversed(list(faces.items()))):
            axes = sheet.panel(_EDGE, _EDGE + place * height, width, height)
            _draw(axes, lines[kind], (width, height), capital, pitch, look)
            axes.text(0.0, height - _LABEL, f"{kind}: {face.name}", color=look.colours.quiet, parse_math=False)
        return sheet.finish("Single-line faces", "each stands for the fonts of its kind")


def _draw(
    axes: Axes, lines: Sequence[Line], size: tuple[float, float], capital: float, pitch: float, look: Look
) -> None:
    axes.set_xlim(0.0, size[0])
    axes.set_ylim(0.0, size[1])
    axes.set_axis_off()
    for place, line in enumerate(lines):
        baseline = size[1] - _LABEL - pitch * (place + 1) + (pitch - capital) / 2.0
        if line.subpaths:
            axes.add_patch(
                PathPatch(
                    _path(line, capital, baseline),
                    fill=False,
                    edgecolor=look.colours.drawn,
                    linewidth=_PEN,
                    clip_on=False,
                )
            )


def _path(line: Line, capital: float, baseline: float) -> Path:
    vertices, codes = [], []
    for subpath in line.subpaths:
        beziers = subpath.beziers * capital + np.array([0.0, baseline])
        vertices.append(np.concatenate((beziers[:1, 0], beziers[:, 1:].reshape(-1, 2))))
        codes.append(np.array([Path.MOVETO, *[Path.CURVE4] * (3 * len(beziers))], dtype=np.uint8))
    return Path(np.concatenate(vertices), np.concatenate(codes))
