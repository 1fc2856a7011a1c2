"""How much a document comes to once every `use` is replaced by what it shows, counted before it is."""

from __future__ import annotations

from planner.drawing.scene.place import DEPTH_LIMIT, ELEMENT_LIMIT
from planner.drawing.scene.references import by_href
from planner.drawing.xml_tree import Document, Element
from planner.errors import DrawingError


def check_expansion(document: Document) -> None:
    """Each element is counted once and then remembered, so that this is linear in the document. What refers to itself
    counts nothing: it is not shown. Errors: DrawingError where it comes to more than the limits."""
    sizes: dict[Element, int] = {}
    heights: dict[Element, int] = {}
    entered = {document.root}
    pending = [(document.root, iter(_shown_by(document, document.root)))]
    while pending:
        element, rest = pending[-1]
        following = next((other for other in rest if other not in sizes and other not in entered), None)
        if following is not None:
            entered.add(following)
            pending.append((following, iter(_shown_by(document, following))))
            continue
        pending.pop()
        below = _shown_by(document, element)
        sizes[element] = 1 + sum(sizes.get(other, 0) for other in below)
        heights[element] = 1 + max((heights.get(other, 0) for other in below), default=0)
    if sizes[document.root] > ELEMENT_LIMIT:
        raise DrawingError(
            document.source,
            f"its `use` elements multiply to more than {ELEMENT_LIMIT} elements"
            " (simplify it, or split it into several drawings)",
        )
    if heights[document.root] > DEPTH_LIMIT:
        raise DrawingError(document.source, f"its `use` elements nest more than {DEPTH_LIMIT} deep (flatten it)")


def _shown_by(document: Document, element: Element) -> list[Element]:
    if element.tag != "use":
        return element.children
    target = by_href(document, element)
    return [*element.children, target] if target is not None else element.children
