"""Markup holds what it was given, whatever that is."""

from __future__ import annotations

from html.parser import HTMLParser

from hypothesis import given
from hypothesis import strategies as st

from planner.report.markup import Markup, clean, definitions, element, joined, table

ANY_TEXT = st.text(st.characters(exclude_categories=()))


class Reader(HTMLParser):
    """What a browser sees: tags with attributes, and the text between them."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text: list[str] = []
        self.open: list[str] = []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attributes)))
        if tag not in {"br", "img", "input", "meta", "source"}:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text.append(data)


@given(ANY_TEXT, ANY_TEXT)
def test_text_and_attributes_come_back_as_they_went_in(text: str, value: str) -> None:
    seen = Reader(element("p", text, class_=value, aria_label="x"))
    assert "".join(seen.text) == clean(text)
    assert seen.tags == [("p", {"class": clean(value), "aria-label": "x"})]
    assert not seen.open


def test_markup_enters_as_it_is_and_only_once() -> None:
    inner = element("b", "1 < 2")
    assert element("p", inner, " & ") == "<p><b>1 &lt; 2</b> &amp; </p>"
    assert isinstance(joined((inner, "x")), Markup)
    assert element("img", src="data:,") == '<img src="data:,">'


@given(st.lists(st.tuples(ANY_TEXT, ANY_TEXT, ANY_TEXT), max_size=4))
def test_tables_and_definitions_have_every_cell(rows: list[tuple[str, str, str]]) -> None:
    cells = Reader(table(("a", "b", "c"), rows))
    assert [tag for tag, _ in cells.tags].count("td") == 3 * len(rows)
    assert [attributes["class"] for tag, attributes in cells.tags if tag == "td"] == ["text", "figure", "figure"] * len(
        rows
    )
    terms = Reader(definitions((term, told) for term, told, _ in rows))
    assert "".join(terms.text) == "".join(clean(term) + clean(told) for term, told, _ in rows)
