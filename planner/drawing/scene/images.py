"""Pictures: an SVG in a picture is drawn as the part of the drawing that it is, pixels as lines where that is asked
for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from planner.affine import compose
from planner.arrays import FloatArray
from planner.drawing.raster import MOST_PIXELS, Raster, RasterError, read_raster
from planner.drawing.scene.linked import embedded, is_embedded, linked
from planner.drawing.scene.page import FALLBACK, OwnSize, own_size
from planner.drawing.scene.place import NESTING_LIMIT, Clipped, Leaf, Place, Window
from planner.drawing.scene.references import href
from planner.drawing.scene.shape import Pixels
from planner.drawing.scene.viewport import fitted
from planner.drawing.scene.walk import Tree, entered, hides_overflow, leaves
from planner.drawing.source import SIZE_LIMIT_BYTES
from planner.drawing.style.style import Styles
from planner.drawing.transforms import Box, translation
from planner.drawing.xml_tree import Document, read_tree
from planner.errors import DrawingError

MOST_PICTURES = 200
_UNKNOWN = (300.0, 150.0)
"""The size of a picture that does not say how large it is (CSS Images 3, section 5)."""


@dataclass(frozen=True, eq=False, slots=True)
class Picture:
    """kind: what it is, as it is counted where it is not drawn. box: where it is, None where that is not known.
    tree, found: of an SVG, what is shown of it. pixels: those of another, in the box. clips: what cuts these."""

    kind: str
    box: Box | None
    tree: Tree | None = None
    found: Iterator[Leaf] | None = None
    pixels: Pixels | None = None
    clips: tuple[Window | Clipped, ...] = ()


def embedded_svg(reference: str, source: str) -> Document | None:
    """The SVG in a `data:` reference; None where it holds something else, or none that can be read."""
    kind, data = embedded(reference) or ("", b"")
    if kind != "image/svg+xml" or len(data) > SIZE_LIMIT_BYTES:
        return None
    try:
        return read_tree(data, source)
    except (ValueError, DrawingError):
        return None


def picture_of(tree: Tree, leaf: Leaf) -> Picture | None:
    """What an `image` shows; None where that is nothing: without a reference, or of no size."""
    reference, style, place = href(leaf.element), leaf.style, leaf.place
    width, height = style.length("width", "x"), style.length("height", "y")
    if not reference or width == 0.0 or height == 0.0:
        return None
    x, y = style.length("x", "x") or 0.0, style.length("y", "y") or 0.0
    document = embedded_svg(reference, tree.document.source) if is_embedded(reference) else None
    if document is None:
        return _of_pixels(tree, leaf, reference, (x, y), (width, height))
    if place.nesting >= NESTING_LIMIT:
        return Picture("references nested too deeply", None)
    tree.work.skipped.update(document.skipped)
    styles = Styles(document)
    root = document.root
    size = own_size(root, styles.of(root, styles.root(FALLBACK), FALLBACK), has_percentages=False)
    box_size = _box_size(width, height, size)
    view_box = size.view_box or (0.0, 0.0, size.width or box_size[0], size.height or box_size[1])
    if min(*box_size, *view_box[2:]) <= 0.0:
        return None
    clips = place.clips
    if hides_overflow(style):
        clips = (*clips, Window((x, y, *box_size), place.to_user))
    around = Place(
        compose(place.to_user, translation(x, y)),
        styles.root(box_size),
        box_size,
        opacity=place.opacity,
        clips=clips,
        layer=place.layer,
        has_layer=True,
        nesting=place.nesting + 1,
    )
    # Browsers lay out the picture in all of the box: its own aspect ratio counts, and of the one of the image only
    # whether it is `none`.
    is_stretched = size.view_box is None or leaf.element.attributes.get("preserveAspectRatio", "").strip() == "none"
    aspect = "none" if is_stretched else root.attributes.get("preserveAspectRatio")
    inner = replace(tree, document=document, styles=styles, root=around, document_styles={})
    return Picture("image", (x, y, *box_size), inner, _shown(inner, view_box, fitted(view_box, box_size, aspect)))


def _of_pixels(
    tree: Tree, leaf: Leaf, reference: str, corner: tuple[float, float], size: tuple[float | None, float | None]
) -> Picture:
    """A picture of pixels, or what it is counted as where it is not to be drawn, or cannot be."""
    width, height = size
    box = (*corner, width, height) if width is not None and height is not None else None
    if not tree.options.image.is_on:
        return Picture("image", box)
    try:
        raster = _raster(tree, reference)
    except RasterError as error:
        return Picture(str(error), box)
    if raster.is_blank:
        return Picture("image without ink", box)
    own_size = (float(raster.size_px[0]), float(raster.size_px[1]))
    box_size = _box_size(width, height, OwnSize(*own_size, (0.0, 0.0, *own_size)))
    place, clips = leaf.place, leaf.place.clips
    to_user = compose(place.to_user, translation(*corner))
    if hides_overflow(leaf.style):
        clips = (*clips, Window((0.0, 0.0, *box_size), to_user))
    rows, columns = raster.darkness.shape
    aspect = leaf.element.attributes.get("preserveAspectRatio")
    fit = compose(fitted((0.0, 0.0, *own_size), box_size, aspect), _scaling(own_size[0] / columns, own_size[1] / rows))
    pixels = Pixels(raster.darkness, compose(to_user, fit), place.opacity)
    return Picture("image", (*corner, *box_size), pixels=pixels, clips=clips)


def _raster(tree: Tree, reference: str) -> Raster:
    """Read once, however often it is shown. Errors: RasterError, in words that can be counted."""
    work = tree.work
    found = work.rasters.get(reference)
    if found is None:
        try:
            if is_embedded(reference):
                _, data = embedded(reference) or ("", b"")
            else:
                data = linked(reference, work.folder)
            try:
                found = read_raster(data)
            except RasterError as error:
                raise RasterError(f"image that cannot be used: {error}") from None
            if sum(known.darkness.size for known in work.rasters.values() if isinstance(known, Raster)) > MOST_PIXELS:
                raise RasterError(f"image beyond {MOST_PIXELS // 1_000_000} million pixels of others")
        except RasterError as error:
            found = error
        work.rasters[reference] = found
    if isinstance(found, RasterError):
        raise found
    work.n_pictures += 1
    if work.n_pictures > MOST_PICTURES:
        raise RasterError(f"image beyond the first {MOST_PICTURES}")
    return found


def _scaling(across: float, down: float) -> FloatArray:
    return np.array([[across, 0.0, 0.0], [0.0, down, 0.0]])


def _shown(tree: Tree, view_box: Box, fit: FloatArray) -> Iterator[Leaf]:
    """What the outermost `svg` of a picture shows in its view box."""
    root, around = tree.document.root, tree.root
    style = tree.styles.of(root, around.style, around.viewport)
    if style["display"] != "none":
        inner = entered(tree, root, style, around)
        inner = replace(inner, to_user=compose(inner.to_user, fit), viewport=view_box[2:])
        yield from leaves(tree, root.children, inner)


def _box_size(width: float | None, height: float | None, size: OwnSize) -> tuple[float, float]:
    """What is not said of the size of an `image` follows from its picture."""
    natural = size.within(_UNKNOWN)
    if width is None and height is None:
        return natural
    has_ratio = min(natural) > 0.0 and (size.view_box is not None or None not in (size.width, size.height))
    if width is None:
        return (height or 0.0) * natural[0] / natural[1] if has_ratio else natural[0], height or 0.0
    if height is None:
        return width, width * natural[1] / natural[0] if has_ratio else natural[1]
    return width, height
