"""The rendering tree: which elements are shown where, in the order in which they are painted."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from planner.affine import compose
from planner.arrays import FloatArray
from planner.drawing.options import ReadingOptions
from planner.drawing.scene.boxes import box_of_subpaths, moved_box, union
from planner.drawing.scene.conditions import fitting_child, is_met
from planner.drawing.scene.lettering import box_of_text
from planner.drawing.scene.place import Clipped, Inside, Leaf, Place, Window, Work
from planner.drawing.scene.references import by_href, href
from planner.drawing.scene.viewport import fitted, parse_view_box
from planner.drawing.shapes import SHAPES, outline_of
from planner.drawing.style.style import Style, Styles
from planner.drawing.style.units import Axis
from planner.drawing.transforms import IDENTITY, Box, local_transform, translation
from planner.drawing.xml_tree import Document, Element

LEAVES = SHAPES | {"text", "image", "foreignObject"}
_SHOWN = LEAVES | {"svg", "g", "a", "switch", "use"}
_ANIMATIONS = frozenset({"animate", "set", "animateTransform", "animateMotion"})


@dataclass(frozen=True, eq=False, slots=True)
class Tree:
    """What every walk through one document shares. px_per_user: CSS pixels on the page to a user unit."""

    document: Document
    styles: Styles
    options: ReadingOptions
    work: Work
    root: Place
    px_per_user: FloatArray
    document_styles: dict[Element, Style]

    def style_of(self, element: Element) -> Style:
        """The style of an element where it stands in the document, as those have that are shown only by reference."""
        known = self.document_styles.get(element)
        if known is None:
            above = self.root.style if element.parent is None else self.style_of(element.parent)
            known = self.document_styles[element] = self.styles.of(element, above, self.root.viewport)
        return known

    def is_rendered(self, resource: Element) -> bool:
        """Whether an element that is shown by reference can be: not where `display` takes away it, or what it is in."""
        at: Element | None = resource
        while at is not None:
            if self.style_of(at)["display"] == "none":
                return False
            at = at.parent
        return True


def leaves(tree: Tree, elements: Iterable[Element], place: Place) -> Iterator[Leaf]:
    """The elements in and under `elements` that show something themselves, in the order of painting."""
    pending = [(element, place) for element in elements][::-1]
    while pending:
        element, around = pending.pop()
        if element.tag not in _SHOWN or not is_met(element):
            _count_animation(tree, element)
            if element.tag == "flowRoot":  # text of a draft of SVG 1.2, which Inkscape wrote and no browser shows
                tree.work.skipped["flowRoot"] += 1
            continue
        tree.work.element(element, around.inside, around.nesting)
        style = tree.styles.of(element, around.style, around.viewport)
        if style["display"] == "none":
            continue
        inner = entered(tree, element, style, around)
        if element.tag in LEAVES:
            for child in element.children:
                _count_animation(tree, child)
            yield Leaf(element, style, inner)
        else:
            pending.extend(reversed(list(_contents(tree, element, style, inner))))


def box_of(tree: Tree, element: Element, style: Style, place: Place) -> Box:
    """The box around an element in its own user units, strokes and clips aside; of no size where it has none."""
    # Nothing is counted here but work: what is found is met again where it is painted.
    probe = replace(tree, work=replace(tree.work, skipped=Counter()))
    inner = replace(place, to_user=IDENTITY, clips=(), style=style)
    if element.tag in LEAVES:
        box = leaf_box(probe, Leaf(element, style, inner))
    else:
        found = leaves_under(probe, element, style, inner)
        box = union(moved_box(box, leaf.place.to_user) for leaf in found if (box := leaf_box(probe, leaf)))
    tree.work.n_elements = probe.work.n_elements
    return box or (0.0, 0.0, 0.0, 0.0)


def leaf_box(tree: Tree, leaf: Leaf) -> Box | None:
    """The box around what a leaf shows in its own user units."""
    if leaf.element.tag in SHAPES:
        return box_of_subpaths(outline_of(leaf.element, leaf.style))
    if leaf.element.tag == "text":
        return box_of_text(tree, leaf)
    x, y = leaf.style.length("x", "x") or 0.0, leaf.style.length("y", "y") or 0.0
    width, height = leaf.style.length("width", "x") or 0.0, leaf.style.length("height", "y") or 0.0
    return (x, y, width, height) if width > 0.0 and height > 0.0 else None


def leaves_under(tree: Tree, element: Element, style: Style, inner: Place) -> Iterator[Leaf]:
    """What a container shows that has been entered."""
    for child, place in _contents(tree, element, style, inner):
        yield from leaves(tree, [child], place)


def _contents(tree: Tree, element: Element, style: Style, inner: Place) -> Iterator[tuple[Element, Place]]:
    """What a container shows next, and where; `inner` is the place inside of it."""
    if element.tag == "use":
        yield from _used(tree, element, style, inner)
        return
    children = element.children
    if element.tag == "svg":
        framed = in_viewport(element, style, inner, *_viewport_box(style))
        if framed is None:
            return
        inner = framed
    elif element.tag == "switch":
        child = fitting_child(element)
        children = [child] if child is not None else []
    yield from ((child, inner) for child in children)


def _used(tree: Tree, use: Element, style: Style, inner: Place) -> Iterator[tuple[Element, Place]]:
    """What a `use` shows: nothing where that would be something that it is inside of."""
    reference = href(use)
    target = by_href(tree.document, use)
    if target is None:
        if reference and not reference.startswith("#"):
            tree.work.skipped["external reference"] += 1
        return
    if inner.inside is not None and inner.inside.holds(target, in_this_tree=True):
        tree.work.skipped["reference to itself"] += 1
        return
    x, y = style.length("x", "x") or 0.0, style.length("y", "y") or 0.0
    inner = replace(inner, to_user=compose(inner.to_user, translation(x, y)), context=Leaf(use, style, inner))
    if target.tag not in ("svg", "symbol"):
        yield target, inner
        return
    target_style = tree.styles.of(target, inner.style, inner.viewport)
    if not is_met(target) or target_style["display"] == "none":
        return
    tree.work.element(target, inner.inside, inner.nesting)
    x, y, width, height = _viewport_box(target_style)
    # The size that a `use` gives goes before that of its target.
    width = width if style["width"] == "auto" else style.length("width", "x")
    height = height if style["height"] == "auto" else style.length("height", "y")
    placed = entered(tree, target, target_style, inner)
    shown = in_viewport(target, target_style, placed, x, y, width, height)
    if shown is not None:
        yield from ((child, shown) for child in target.children)


def entered(tree: Tree, element: Element, style: Style, around: Place) -> Place:
    """The place inside of an element: its transform, opacity, clips and layer."""
    inside = Inside(element, around.inside, around.inside.depth + 1 if around.inside else 1)
    place = replace(around, style=style, inside=inside)
    transform = local_transform(style, around.viewport, lambda: box_of(tree, element, style, place))
    if transform is not IDENTITY:
        place = replace(place, to_user=compose(around.to_user, transform))
    if style["opacity"] != "1":
        place = replace(place, opacity=around.opacity * style.number("opacity"))
    if element.tag == "g":
        place = _on_layer(element, place)
    tree.work.skipped.update(style.unhonoured())
    if style["clip-path"] != "none" or style["mask"] != "none":
        place = replace(place, clips=(*place.clips, Clipped(element, style, place)))
    return place


def _on_layer(group: Element, place: Place) -> Place:
    """The layer that a group makes: the innermost one that Inkscape calls so, or else the outermost group with a
    name."""
    name = group.attributes.get("inkscape:label", group.attributes.get("id", ""))
    if group.attributes.get("inkscape:groupmode") == "layer":
        return replace(place, layer=name, has_layer=True)
    return place if place.layer or place.has_layer else replace(place, layer=name)


def _viewport_box(style: Style) -> tuple[float, float, float | None, float | None]:
    """x, y, width and height of an `svg`, None for what is as large as the viewport around it."""
    x, y = style.length("x", "x") or 0.0, style.length("y", "y") or 0.0
    return x, y, style.length("width", "x"), style.length("height", "y")


def in_viewport(
    element: Element, style: Style, place: Place, x: float, y: float, width: float | None, height: float | None
) -> Place | None:
    """The place inside of an element that is a viewport, as large as the one around it where no size is given; None
    where nothing in it can be seen."""
    size = (place.viewport[0] if width is None else width, place.viewport[1] if height is None else height)
    view_box = parse_view_box(element.attributes.get("viewBox"))
    if min(size) <= 0.0 or (view_box is not None and min(view_box[2:]) == 0.0):
        return None
    to_user = compose(place.to_user, translation(x, y))
    clips = place.clips
    if hides_overflow(style):
        clips = (*clips, Window((0.0, 0.0, *size), to_user))
    if view_box is not None:
        to_user = compose(to_user, fitted(view_box, size, element.attributes.get("preserveAspectRatio")))
        size = view_box[2:]
    return replace(place, to_user=to_user, viewport=size, clips=clips)


def hides_overflow(style: Style) -> bool:
    """Whether a viewport cuts what is in it; one that would get scroll bars does not."""
    return style["overflow"].split()[0] in ("hidden", "scroll", "clip")


def _count_animation(tree: Tree, element: Element) -> None:
    """Animations that run when the picture is first shown; what they do is not drawn."""
    if element.tag in _ANIMATIONS and any(
        re.fullmatch(r"\s*(?:[+-]?0*(?:\.0*)?(?:h|min|s|ms)?|-\S+)\s*", begin)
        for begin in element.attributes.get("begin", "0").split(";")
    ):
        tree.work.skipped["animation"] += 1


def attribute_length(style: Style, text: str | None, axis: Axis, whole: float | None) -> float:
    """A length that is an attribute of a resource; where `whole` is given, it is a fraction of that, as of a box."""
    if text is None:
        return 0.0
    if whole is None:
        return style.in_units(text, axis) or 0.0
    match = re.fullmatch(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(%?)\s*", text)
    return float(match[1]) * whole / (100.0 if match[2] else 1.0) if match else 0.0
