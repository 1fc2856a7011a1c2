"""The XML of a drawing: its names, its lines, its entities, and what each kind of unusable file is told."""

from __future__ import annotations

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.drawing.entities import COUNT_LIMIT, DEPTH_LIMIT, EXPANDED_LIMIT, TEXT_LIMIT
from planner.drawing.xml_tree import DEPTH_LIMIT as ELEMENT_DEPTH_LIMIT
from planner.drawing.xml_tree import Document, read_tree
from planner.errors import DrawingError

NAMESPACE = 'xmlns="http://www.w3.org/2000/svg"'


def read(text: str | bytes) -> Document:
    return read_tree(text if isinstance(text, bytes) else text.encode(), "drawing.svg")


def refusal(text: str | bytes) -> str:
    with pytest.raises(DrawingError) as caught:
        read(text)
    message = str(caught.value)
    assert message.startswith("drawing.svg: ") and "\n" not in message
    return message


def tags(document: Document) -> list[str]:
    return [element.tag for element in document.root.descendants()]


@st.composite
def trees(draw: st.DrawFn, depth: int = 3) -> str:
    """Elements one a line, so that the line of each is its number."""
    inner = draw(st.lists(trees(depth - 1), max_size=3)) if depth else []
    return "\n<g>" + "".join(inner) + "</g>"


@given(trees())
def test_every_element_knows_its_line_and_its_parent(body: str) -> None:
    document = read(f"<svg {NAMESPACE}>{body}</svg>")
    elements = list(document.root.descendants())
    assert [element.line for element in elements] == list(range(1, len(elements) + 1))
    for element in elements:
        for child in element.children:
            assert child.parent is element
    assert document.root.parent is None


@pytest.mark.parametrize(
    "text",
    [
        f"<svg {NAMESPACE}><path/></svg>",
        "<svg><path/></svg>",
        '<s:svg xmlns:s="http://www.w3.org/2000/svg"><s:path/></s:svg>',
        '<!DOCTYPE svg [<!ENTITY ns "http://www.w3.org/2000/svg">]><svg xmlns="&ns;"><path/></svg>',
        '<!DOCTYPE svg SYSTEM "http://example.org/svg.dtd"><svg><path/></svg>',
        '<?xml version="1.0" encoding="utf-16"?><svg><path/></svg>',
    ],
)
def test_elements_of_svg_are_those_of_its_namespace_or_of_none_at_all(text: str) -> None:
    assert tags(read(text)) == ["svg", "path"]


def test_elements_of_other_namespaces_have_no_tag() -> None:
    document = read(
        f'<svg {NAMESPACE} xmlns:i="http://ns.adobe.com/x"><i:path/><path xmlns=""/><path xmlns="urn:a"/></svg>'
    )
    assert tags(document) == ["svg", "", "", ""]


def test_attributes_go_by_the_prefix_that_everyone_knows() -> None:
    document = read(
        f'<svg {NAMESPACE} xmlns:a="http://www.w3.org/1999/xlink"'
        ' xmlns:b="http://www.inkscape.org/namespaces/inkscape" xmlns:c="urn:other">'
        '<g a:href="#x" b:label="Ink" c:label="lost" xml:space="preserve" id="x" class="k"/></svg>'
    )
    assert document.root.children[0].attributes == {
        "xlink:href": "#x",
        "inkscape:label": "Ink",
        "xml:space": "preserve",
        "id": "x",
        "class": "k",
    }


def test_the_first_element_of_an_id_has_it() -> None:
    document = read(f'<svg {NAMESPACE}><g id="a"/><path id="a"/></svg>')
    assert document.by_id["a"].tag == "g"


def test_text_keeps_its_order_and_its_cdata() -> None:
    document = read(f"<svg {NAMESPACE}><text>a<tspan>b</tspan><![CDATA[<c>]]></text></svg>")
    text = document.root.children[0]
    assert [item if isinstance(item, str) else item.tag for item in text.content] == ["a", "tspan", "<c>"]
    assert text.text == "a<c>"


@pytest.mark.parametrize(
    "encoding", ["utf-8-sig", "utf-16", "utf-16-le", "iso-8859-5", "cp1251", "shift_jis", "gb18030"]
)
def test_encodings(encoding: str) -> None:
    said = "utf-16" if encoding.startswith("utf-16") else encoding.removesuffix("-sig")
    text = f'<?xml version="1.0" encoding="{said}"?><svg {NAMESPACE}><text>Ж</text></svg>'
    assert read(text.encode(encoding)).root.children[0].text == "Ж"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "no element found in line 1"),
        (f"<svg {NAMESPACE}>\n<g>\n</svg>", "mismatched tag in line 3"),
        (f"\n<?xml version='1.0'?><svg {NAMESPACE}/>", "XML or text declaration not at start of entity in line 2"),
        (f"<svg {NAMESPACE}>\n&nbsp;</svg>", "undefined entity in line 2"),
        (f"<svg {NAMESPACE}>\n<g a='1' a='2'/></svg>", "duplicate attribute in line 2"),
        (f"<svg {NAMESPACE}>\n<use xlink:href='#a'/></svg>", 'undeclared prefix "xlink:" in line 2 (add xmlns:xlink='),
        (f"<svg {NAMESPACE}>\n<v:use/></svg>", 'undeclared prefix "v:" in line 2 (remove it'),
        ("<svg:svg/>", 'undeclared prefix "svg:" in line 1 (add xmlns:svg='),
        ('<svg xmlns="urn:x"/>', 'its namespace is "urn:x"'),
        ("<page/>", "the outermost element is <page> in line 1"),
        ("<!DOCTYPE html>\n<html><svg/></html>", "<html> in line 2 (a web page"),
        ("<g>" * (ELEMENT_DEPTH_LIMIT + 1), "the outermost element is <g>"),
        (
            f"<svg {NAMESPACE}>\n" + "<g>" * ELEMENT_DEPTH_LIMIT,
            f"nested more than {ELEMENT_DEPTH_LIMIT} deep in line 2",
        ),
        (f'<?xml version="1.0" encoding="klingon"?><svg {NAMESPACE}/>', "unknown encoding"),
    ],
)
def test_what_is_no_drawing_is_told_why_and_where(text: str, expected: str) -> None:
    assert expected in refusal(text)


def document_with(entities: dict[str, str], body: str) -> str:
    declared = "".join(f'<!ENTITY {name} "{text}">' for name, text in entities.items())
    return f"<!DOCTYPE svg [{declared}]>\n<svg {NAMESPACE}><text>{body}</text></svg>"


@st.composite
def entities(draw: st.DrawFn) -> dict[str, str]:
    """Each of those after it, in any order of declaration."""
    n = draw(st.integers(1, 6))
    part = st.sampled_from(["x", "yz"] + [f"&e{index};" for index in range(n)])
    texts = {}
    for index in range(n):
        later = part.filter(lambda text, index=index: not text.startswith("&e") or int(text[2:-1]) > index)
        texts[f"e{index}"] = "".join(draw(st.lists(later, max_size=4)))
    return dict(draw(st.permutations(list(texts.items()))))


@given(entities())
def test_entities_stand_for_their_text(declared: dict[str, str]) -> None:
    expected = "&e0;"
    while "&" in expected:
        for name, text in declared.items():
            expected = expected.replace(f"&{name};", text)
    assert read(document_with(declared, "&e0;")).root.children[0].text == expected


@given(st.integers(2, 40), st.integers(1, DEPTH_LIMIT - 2), st.booleans())
def test_entities_that_multiply_are_refused_exactly_beyond_the_limit(n: int, depth: int, is_backward: bool) -> None:
    declared = {"e0": "abc"} | {f"e{index}": f"&e{index - 1};" * n for index in range(1, depth + 1)}
    size = 3
    for _ in range(depth):
        size = size * n + n * len("&e0;")  # the text that refers counts, too
    if is_backward:
        declared = dict(reversed(declared.items()))
    text = document_with(declared, f"&e{depth};")
    if size > 2 * EXPANDED_LIMIT:
        assert f"expand to more than {EXPANDED_LIMIT} characters" in refusal(text)
    elif size < EXPANDED_LIMIT // 2 and 3 * n**depth < EXPANDED_LIMIT // 100:
        assert len(read(text).root.children[0].text) == 3 * n**depth


def test_a_billion_laughs_are_refused_at_once() -> None:
    laughs = {"a": "lol" * 100} | {chr(98 + index): f"&{chr(97 + index)};" * 30 for index in range(12)}
    started = time.process_time()
    assert "expand to more than" in refusal(document_with(laughs, "&m;"))
    default = document_with(laughs, "").replace("]>", '<!ATTLIST text x CDATA "&m;">]>')
    assert "expand to more than" in refusal(default)
    many = document_with({"a": "x" * 100_000}, "&a;" * 1000)
    assert "expand to more than" in refusal(many)
    assert "expand to more than" in refusal(many.encode("utf-16"))
    assert time.process_time() - started < 5.0  # a bound on work, a hundred times what it takes


def test_the_bounds_of_entities_are_named() -> None:
    assert "refers to itself" in refusal(document_with({"a": "&b;", "b": "&a;"}, ""))
    chain = {f"e{index}": f"&e{index + 1};" for index in range(DEPTH_LIMIT + 2)}
    assert f"nest more than {DEPTH_LIMIT} deep" in refusal(document_with(chain, ""))
    many = {f"e{index}": "x" for index in range(COUNT_LIMIT + 1)}
    assert f"more than {COUNT_LIMIT} entities" in refusal(document_with(many, ""))
    assert f"more than {TEXT_LIMIT} characters" in refusal(document_with({"a": "x" * (TEXT_LIMIT + 1)}, ""))


def test_entities_may_hold_elements_and_attributes_their_defaults() -> None:
    document = read(
        "<!DOCTYPE svg [<!ENTITY shapes \"<path d='M0 0'/><path/>\">"
        "<!ATTLIST path stroke CDATA 'red' q CDATA #IMPLIED>]>"
        f"\n<svg {NAMESPACE}>\n&shapes;</svg>"
    )
    assert [(path.attributes, path.line) for path in document.root.children] == [
        ({"d": "M0 0", "stroke": "red"}, 3),
        ({"stroke": "red"}, 3),
    ]


def test_nothing_outside_the_file_is_fetched_and_what_shows_of_it_is_counted() -> None:
    outside = '<!DOCTYPE svg [<!ENTITY e SYSTEM "file:///etc/passwd">]>'
    document = read(f'<?xml-stylesheet href="a.css"?>{outside}<svg {NAMESPACE}><text>&e;</text></svg>')
    assert document.root.children[0].content == []
    assert document.skipped == {"external reference": 2}
    dtd = '<!DOCTYPE svg SYSTEM "svg.dtd" [<!ENTITY % p SYSTEM "file:///etc/passwd"> %p;]>'
    document = read(f"{dtd}<svg {NAMESPACE}><title>&nbsp;</title><text>a&nbsp;b</text></svg>")
    assert document.root.children[1].text == "ab"
    assert document.skipped["entity that is declared elsewhere"] == 1


PIECES = ["<svg>", "</svg>", "<g", ">", "/>", "&a;", "&#0;", "<!DOCTYPE svg [", "<!ENTITY a '&b;'>", "]>", "<![CDATA[",
          "]]>", "xmlns:a='", "a:b=''", "<?xml", "?>", "<!--", "-->", "%p;", "\x00", "é", " ", "'", '"']  # fmt: skip


@given(st.lists(st.sampled_from(PIECES) | st.text(max_size=3), max_size=20), st.sampled_from(["utf-8", "utf-16"]))
def test_whatever_is_given_is_read_or_refused_in_one_line(pieces: list[str], encoding: str) -> None:
    data = "".join(pieces).encode(encoding, "surrogatepass")
    try:
        said = read(data).root.tag
    except DrawingError as error:
        said = str(error)
    assert "\n" not in said
