"""Pictures: an SVG in a picture is drawn as the part of the drawing that it is."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Iterator
from dataclasses import dataclass, replace
from urllib.parse import unquote_to_bytes

from planner.affine import compose
from planner.arrays import FloatArray
from planner.drawing.scene.page import FALLBACK, OwnSize, own_size
from planner.drawing.scene.place import NESTING_LIMIT, Leaf, Place, Window
from planner.drawing.scene.references import href
from planner.drawing.scene.viewport import fitted
from planner.drawing.scene.walk import Tree, entered, hides_overflow, leaves
from planner.drawing.source import SIZE_LIMIT_BYTES
from planner.drawing.style.style import Styles
from planner.drawing.transforms import Box, translation
from planner.drawing.xml_tree import Document, read_tree
from planner.errors import DrawingError

_UNKNOWN = (300.0, 150.0)
"""The size of a picture that does not say how large it is (CSS Images 3, section 5)."""


@dataclass(frozen=True, eq=False, slots=True)
class Picture:
    """kind: what it is, as it is counted where it is not drawn. box: where it is, None where that is not known.
    tree, found: of an SVG, what is shown of it."""

    kind: str
    box: Box | None
    tree: Tree | None = None
    found: Iterator[Leaf] | None = None


def embedded_svg(reference: str, source: str) -> Document | None:
    """The SVG in a `data:` reference; None where it holds something else, or none that can be read."""
    head, comma, body = reference.partition(",")
    kind, *parameters = head.removeprefix("data:").split(";")
    if not comma or kind.strip().lower() != "image/svg+xml":
        return None
    try:
        data = unquote_to_bytes(body)
        if "base64" in (parameter.strip().lower() for parameter in parameters):
            data = base64.b64decode(b"".join(data.split()) + b"==")
        return read_tree(data, source) if len(data) <= SIZE_LIMIT_BYTES else None
    except (binascii.Error, ValueError, DrawingError):
        return None


def picture_of(tree: Tree, leaf: Leaf) -> Picture | None:
    """What an `image` shows; None where that is nothing: without a reference, or of no size."""
    reference, style, place = href(leaf.element), leaf.style, leaf.place
    width, height = style.length("width", "x"), style.length("height", "y")
    if not reference or width == 0.0 or height == 0.0:
        return None
    x, y = style.length("x", "x") or 0.0, style.length("y", "y") or 0.0
    is_embedded = reference[:5].lower() == "data:"
    document = embedded_svg(reference, tree.document.source) if is_embedded else None
    if document is None:
        box = (x, y, width, height) if width is not None and height is not None else None
        return Picture("image", box)
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
