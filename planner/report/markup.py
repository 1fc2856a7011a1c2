"""HTML from values: text is escaped where it enters, markup is of a type of its own and enters as it is."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape

_VOID = frozenset({"br", "img", "meta", "source"})


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


def element(name: str, /, *children: str, **attributes: str) -> Markup:
    """An element. Children that are no Markup are escaped. In the name of an attribute a final underscore is left out
    and others are hyphens: `class_`, `http_equiv`."""
    given = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{escape(clean(value))}"' for key, value in attributes.items()
    )
    if name in _VOID:
        return Markup(f"<{name}{given}>")
    return Markup(f"<{name}{given}>{joined(children)}</{name}>")


def joined(parts: Iterable[str], separator: str = "") -> Markup:
    """Parts one after another, those that are no Markup escaped."""
    return Markup(separator.join(part if isinstance(part, Markup) else escape(clean(part)) for part in parts))


def clean(text: str) -> str:
    """`text` without the characters that a page may not hold, as names of files can."""
    if text.isprintable():  # as pictures of megabytes are
        return text
    return "".join(
        character if character.isprintable() or character in "\n\t" else "\N{REPLACEMENT CHARACTER}"
        for character in text
    )


def table(head: Sequence[str], rows: Iterable[Sequence[str]], *, n_texts: int = 1) -> Markup:
    """A table in a box that scrolls sideways where the page is narrow. The first n_texts columns are text, the others
    figures, which stand to the right."""

    def cells(name: str, row: Sequence[str]) -> Markup:
        return element(
            "tr",
            *(element(name, cell, class_="text" if place < n_texts else "figure") for place, cell in enumerate(row)),
        )

    return element(
        "div",
        element("table", element("thead", cells("th", head)), element("tbody", *(cells("td", row) for row in rows))),
        class_="scrolls",
        tabindex="0",
    )


def definitions(pairs: Iterable[tuple[str, str]], **attributes: str) -> Markup:
    """Terms with what is said of them."""
    return element(
        "dl", *(element("div", element("dt", term), element("dd", told)) for term, told in pairs), **attributes
    )


@dataclass(frozen=True, slots=True)
class Section:
    """A part of the page behind a heading. name: that a link leads to it by."""

    name: str
    heading: str
    body: Markup

    def markup(self) -> Markup:
        return element("section", element("h2", self.heading), self.body, id=self.name)

    def link(self) -> Markup:
        """To it, from elsewhere on the page."""
        return element("a", self.heading, href=f"#{self.name}")
