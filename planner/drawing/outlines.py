"""What a pen draws of a scene: the lines of its shapes, less what clips, later paint and the page leave unseen."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Sequence

import numpy as np

from planner.affine import scale_of
from planner.drawing.cut.area import have_area
from planner.drawing.drawing import Outline
from planner.drawing.options import ReadingOptions
from planner.drawing.page import cut_to_the_page, n_backgrounds
from planner.drawing.scene.shape import Scene, Shape
from planner.drawing.subpath import Subpath

REPEAT_LIMIT = 10
"""How often the same line is drawn over itself: a few times make it darker, more wear the paper through, and are a
slip of the program that wrote the file."""
BEYOND_THE_PAGE = "ink beyond the page"
_REPEATS = f"repeats of a line that is there {REPEAT_LIMIT} times"
_HIDING = 1e-6
"""What the edges of covers may miss their curves by, against the extent of the page."""


def outlines(scene: Scene, options: ReadingOptions) -> tuple[tuple[Outline, ...], Counter[str]]:
    """The outlines in the order of painting, and how many things of each kind were left out of them."""
    n_behind = n_backgrounds(scene)
    shapes = scene.shapes[n_behind:]
    lines = _clipped(shapes, _with_area(shapes))
    if options.occlude:
        lines = _seen(shapes, lines, scene)
    n_beyond = 0
    if options.crop == "page":
        lines, n_beyond = cut_to_the_page(lines, scene)
    drawn, n_repeats = _without_repeats(shapes, lines)
    # A Counter keeps no zeros that are added to it.
    return drawn, +Counter({"background": n_behind, BEYOND_THE_PAGE: n_beyond, _REPEATS: n_repeats})


def _with_area(shapes: Sequence[Shape]) -> list[list[Subpath]]:
    """The lines of each shape; where they are the edge of a fill alone, those that have an area, as the others show
    nothing."""
    is_edge = [shape.fill is not None and shape.stroke is None for shape in shapes]
    edges = [path for shape, edge in zip(shapes, is_edge, strict=True) if edge for path in shape.lines]
    is_shown = iter(have_area(edges))
    return [
        [path for path in shape.lines if next(is_shown)] if edge else list(shape.lines)
        for shape, edge in zip(shapes, is_edge, strict=True)
    ]


def _clipped(shapes: Sequence[Shape], lines: list[list[Subpath]]) -> list[list[Subpath]]:
    """The parts of each shape's lines that all of its clips leave to be seen. Shapes that share a clip are cut by it
    together."""
    depth = max((len(shape.clips) for shape in shapes), default=0)
    for level in range(depth):
        sharing: dict[int, list[int]] = {}
        for index, shape in enumerate(shapes):
            if len(shape.clips) > level:
                sharing.setdefault(id(shape.clips[level]), []).append(index)
        for of_clip in sharing.values():
            from planner.drawing.cut.cut import Cutter

            cutter = Cutter(shapes[of_clip[0]].clips[level])
            parts = iter(cutter.inside([path for index in of_clip for path in lines[index]]))
            for index in of_clip:
                lines[index] = [part for _ in lines[index] for part in next(parts)]
    return lines


def _seen(shapes: Sequence[Shape], lines: list[list[Subpath]], scene: Scene) -> list[list[Subpath]]:
    """The lines less what opaque fills that are painted later hide."""
    import shapely

    from planner.drawing.cut.occlude import occluded
    from planner.drawing.cut.region import region

    tolerance = _HIDING * max(scene.page_mm) / scale_of(scene.user_to_page)
    covers = [
        shapely.intersection_all([region(shape.outline, shape.is_even_odd, tolerance), *shape.clips])
        if shape.fill is not None and shape.fill.is_opaque
        else None
        for shape in shapes
    ]
    return occluded(lines, covers, tolerance)


def _without_repeats(shapes: Sequence[Shape], lines: Sequence[Sequence[Subpath]]) -> tuple[tuple[Outline, ...], int]:
    """The lines as outlines, and how many there would be more if the same line could be drawn any number of times."""
    kept = []
    times: Counter[bytes] = Counter()
    for shape, of_one in zip(shapes, lines, strict=True):
        for path in of_one:
            mark = hashlib.blake2b(np.ascontiguousarray(path.beziers).data, digest_size=16).digest()
            times[mark] += 1
            if times[mark] <= REPEAT_LIMIT:
                kept.append(_outline(shape, path))
    return tuple(kept), times.total() - len(kept)


def _outline(shape: Shape, path: Subpath) -> Outline:
    if shape.stroke is None:
        return Outline(path.beziers, shape.layer, shape.colour, shape.width, path.gap)
    stroke = shape.stroke
    return Outline(path.beziers, shape.layer, shape.colour, shape.width, path.gap, stroke.cap, stroke.join)
