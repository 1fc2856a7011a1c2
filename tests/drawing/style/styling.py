"""What tests of styles share: documents of a few lines, and the styles of all their elements."""

from __future__ import annotations

from planner.drawing.style.style import Style, Styles
from planner.drawing.xml_tree import Element, read_tree

PAGE = (200.0, 100.0)


def styles_of(body: str, attributes: str = "", page: tuple[float, float] = PAGE) -> dict[str, Style]:
    """The style of every element that has an id, each under its parent; "" is that of the outermost `svg`."""
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>{body}</svg>'
    document = read_tree(text.encode(), "drawing.svg")
    styles = Styles(document)
    known: dict[Element, Style] = {}
    for element in document.root.descendants():
        parent = known[element.parent] if element.parent is not None else styles.root(page)
        known[element] = styles.of(element, parent, page)
    return {element.attributes.get("id", ""): style for element, style in reversed(known.items())}


def style_of(said: str, page: tuple[float, float] = PAGE) -> Style:
    """That of a rectangle with this style attribute."""
    escaped = said.replace("&", "&amp;").replace('"', "&quot;").replace("<", "&lt;")
    return styles_of(f'<rect id="a" style="{escaped}"/>', page=page)["a"]
