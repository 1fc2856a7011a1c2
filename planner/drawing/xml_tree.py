"""An XML document as a tree that remembers where in the user's file each element stands."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(eq=False, slots=True)
class Element:
    """tag: the local name of an element of SVG, "" for one of another namespace. attributes: by plain name; those of
    other namespaces by the prefix that everyone knows, whatever the file calls it: `xlink:href`, `xml:space`,
    `inkscape:label`, `inkscape:groupmode`, `sodipodi:insensitive`. content: children and character data in
    order. line: in the file, from 1."""

    tag: str
    attributes: dict[str, str]
    line: int
    parent: Element | None = None
    content: list[Element | str] = field(default_factory=list)

    @property
    def children(self) -> list[Element]:
        return [item for item in self.content if isinstance(item, Element)]


@dataclass(frozen=True, eq=False, slots=True)
class Document:
    """by_id: the first element of each id. source: what messages call the file."""

    source: str
    root: Element
    by_id: dict[str, Element]


def read_tree(data: bytes, source: str) -> Document:
    """The document, its entities expanded within bounds. Errors: DrawingError with the line of the user's file."""
    raise NotImplementedError
