"""What elements refer to."""

from __future__ import annotations

from planner.drawing.style.colour import fragment
from planner.drawing.xml_tree import Document, Element


def href(element: Element) -> str:
    """`href` goes before `xlink:href`."""
    return element.attributes.get("href", element.attributes.get("xlink:href", "")).strip()


def by_href(document: Document, element: Element) -> Element | None:
    """What an element refers to inside the document."""
    return document.by_id.get(fragment(href(element)) or "")


def by_url(document: Document, url: str, *tags: str) -> Element | None:
    """What a property refers to inside the document by `url(...)`, if it is of one of the kinds asked for."""
    target = document.by_id.get(fragment(url) or "")
    return target if target is not None and target.tag in tags else None


def chain(document: Document, element: Element, *tags: str) -> list[Element]:
    """A gradient or a pattern, what it refers to, what that refers to, as far as they are of the kinds asked for."""
    found: list[Element] = []
    at: Element | None = element
    while at is not None and at not in found and at.tag in tags:
        found.append(at)
        at = by_href(document, at)
    return found


def inherited_attribute(elements: list[Element], name: str) -> str | None:
    """An attribute of the first one in a chain that has it."""
    return next((element.attributes[name] for element in elements if name in element.attributes), None)
