"""What a drawing is to the planner: visible outlines as chains of cubic curves, in the SVG's own units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from planner.arrays import FloatArray
from planner.drawing.options import AS_A_BROWSER, ReadingOptions

if TYPE_CHECKING:
    from planner.drawing.scene.shape import Scene


@dataclass(frozen=True, eq=False, slots=True)
class Outline:
    """One subpath: consecutive cubic Bezier curves, a straight line being a cubic whose
    control points lie on it.

    beziers: (n_curves, 4, 2), user units; curve k ends exactly where curve k + 1 begins. A subpath of
    zero length is one curve with four equal points: a pen tap. A closed subpath ends where it began.
    layer: the name of the layer that it is on, or "". colour: sRGB. width: of its stroke in user units, 0 where it is
    the edge of a fill. gap: (n, 4, 2), of a dash, the curves to where the next dash of its line begins; else None.
    cap, join: of its stroke, as SVG calls them.
    """

    beziers: FloatArray
    layer: str = ""
    colour: tuple[int, int, int] = (0, 0, 0)
    width: float = 0.0
    gap: FloatArray | None = None
    cap: str = "butt"
    join: str = "miter"


@dataclass(frozen=True, eq=False, slots=True)
class Drawing:
    """All visible outlines of an SVG in document order.

    outlines: in user units, the coordinate system that the children of the outermost `svg`
        element draw in (viewBox coordinates where it has one), transforms applied.
    user_to_page: (2, 3) affine [[a, c, e], [b, d, f]] from user units to millimetres on the page,
        x to the right and y down from the top left corner (viewBox and preserveAspectRatio applied).
    page_mm: width and height of the page. has_page: whether the file says so, rather than leaving it to who shows it.
    skipped: how many things of each kind could not be drawn, e.g. {"text": 2, "image": 1}.
    scene, reading: what the outlines were made from, and how; without a scene they were made by hand.
    """

    source: str
    outlines: tuple[Outline, ...]
    user_to_page: FloatArray
    page_mm: tuple[float, float]
    skipped: Mapping[str, int] = field(default_factory=dict)
    scene: Scene | None = None
    reading: ReadingOptions = AS_A_BROWSER
    has_page: bool = True

    def notes(self) -> list[str]:
        """What is to be said of it."""
        counts = ", ".join(f"{count} {kind}" for kind, count in sorted(self.skipped.items()))
        return [f"not drawn as in the SVG: {counts}"] if counts else []
