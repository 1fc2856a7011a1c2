"""The cascade: who wins, what is inherited, what variables come to. What is expected is what Chromium gives."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.drawing.style.style import Styles
from planner.drawing.xml_tree import Document, Element, read_tree
from tests.drawing.style.styling import PAGE, style_of, styles_of


def width(body: str) -> str:
    """The width of the element #a."""
    return styles_of(body)["a"]["width"]


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<rect id="a" width="1"/>', "1"),
        ('<style>*{width:2px}</style><rect id="a" width="1"/>', "2px"),
        ('<style>rect{width:3px} *{width:2px}</style><rect id="a" width="1"/>', "3px"),
        ('<style>rect{width:3px} rect{width:4px}</style><rect id="a"/>', "4px"),
        ('<style>.k{width:5px} rect{width:4px}</style><rect id="a" class="j k"/>', "5px"),
        ('<style>#a{width:6px} rect.k.k{width:4px}</style><rect id="a" class="k"/>', "6px"),
        ('<style>#a{width:6px}</style><rect id="a" style="width:7px"/>', "7px"),
        ('<style>rect{width:8px!important} #a{width:6px}</style><rect id="a" style="width:7px"/>', "8px"),
        ('<style>rect{width:8px!important}</style><rect id="a" style="width:7px ! important"/>', "7px"),
        ('<style>rect{width:8px; width:foo}</style><rect id="a"/>', "8px"),
        ('<style>rect{width:8px; width:5}</style><rect id="a"/>', "8px"),
        ('<rect id="a" width="abc" rx="abc" ry="-1"/>', "0"),
        ('<rect id="a" width="1" style="width:9px;;foo;height:3px;width"/>', "9px"),
        ('<rect id="a" style="width:5px;foo(;width:7px);height:9px"/>', "5px"),
        ('<rect id="a" style="/*width:1px;*/width:2px/**/"/>', "2px"),
        ('<rect id="a" style="height:9px;width:calc(5px + 1px"/>', "calc(5px + 1px)"),
        ('<style>@layer x,y; @layer y{#a{width:1px}} @layer x{#a{width:2px}}</style><rect id="a"/>', "1px"),
        ('<style>@layer x{#a{width:1px}} rect{width:2px}</style><rect id="a"/>', "2px"),
        ('<style>@layer x{rect{width:1px!important}} #a{width:2px!important}</style><rect id="a"/>', "1px"),
        ('<style>@layer x{@layer y{#a{width:1px}} rect{width:2px}}</style><rect id="a"/>', "2px"),
        ('<style>@layer x.y{#a{width:1px}} @layer x{rect{width:2px}}</style><rect id="a"/>', "2px"),
        ('<style>@layer x{#a{width:1px}} #a{width:revert-layer}</style><rect id="a" width="3"/>', "1px"),
        ('<style>@layer x{#a{width:1px}} #a{width:revert}</style><rect id="a" width="3"/>', "auto"),
        ('<style>#a{width:initial}</style><rect id="a" width="3"/>', "auto"),
        ('<style>#a{all:unset}</style><rect id="a" width="3"/>', "auto"),
        ('<rect width="3"/><g><rect id="a" style="width:inherit"/></g>', "auto"),
        ('<style>g{&amp; rect{width:4px}}</style><g><rect id="a"/></g>', "4px"),
        ('<style>g{> rect{width:4px} width:1px}</style><g><rect id="a"/></g>', "4px"),
        ('<style>g, a{rect{width:4px} @media print{rect{width:5px}}}</style><g><rect id="a"/></g>', "4px"),
        ('<style>@media screen{#a{width:4px}} @media print{#a{width:5px}}</style><rect id="a"/>', "4px"),
        (
            '<style media="print">#a{width:5px}</style><style media=" Screen ">#a{width:6px}</style><rect id="a"/>',
            "6px",
        ),
        ('<style type="text/x">#a{width:5px}</style><style type="TEXT/CSS">#a{width:6px}</style><rect id="a"/>', "6px"),
        ('<style>@supports (width:1px){#a{width:4px}} @supports (q:1){#a{width:5px}}</style><rect id="a"/>', "4px"),
        ('<style>@supports not ((q:1) or (cursor:none)){#a{width:5px}}</style><rect id="a" width="1"/>', "1"),
        ('<style><![CDATA[ g > rect{width:4px} ]]></style><g><rect id="a"/></g>', "4px"),
        ('<style>@import url(x.css); @font-face{} @keyframes k{from{}} #a{width:4px}</style><rect id="a"/>', "4px"),
        ('<style>{} #b{} , {width:1px} #a{width:4px</style><rect id="a"/>', "4px"),
        ('<style>#a, :foo{width:1px} #a, ::before{width:4px}</style><rect id="a"/>', "4px"),
        ('<style>RECT{width:1px} .K{width:2px}</style><rect id="a" class="k" width="3"/>', "3"),
        ('<rect id="a" style="WIDTH:4PX"/>', "4PX"),
        ('<rect id="a" style="inline-size:10px" width="3"/>', "10px"),
        ('<style>#a{width:8}</style><rect id="a" style="width:5"/>', "5"),
        ('<style>#a{width:8}</style><rect id="a" style="--a:5;width:var(--a)"/>', "5"),
    ],
)
def test_who_wins(body: str, expected: str) -> None:
    assert width(body) == expected


def test_nested_viewports_and_uses_take_their_size_from_attributes_alone() -> None:
    style = 'style="x:1px;width:2px"'
    found = styles_of(
        f'<svg id="s" width="9" {style}/><use id="u" x="8" width="9" {style}/><image id="i" {style}/>', style
    )
    assert [found[name]["width"] for name in ("s", "u", "i", "")] == ["9", "9", "2px", "2px"]
    assert [found[name]["x"] for name in ("s", "u", "i", "")] == ["0", "1px", "1px", "1px"]


def test_attributes_are_presentation_attributes_where_browsers_take_them_for_one() -> None:
    found = styles_of(
        '<text id="t" x="5" font="20px serif" marker="url(#m)" mix-blend-mode="multiply" r="3" line-height="3"/>'
        '<pattern id="p" transform="scale(3)" patternTransform="scale(2)" x="3"/>'
    )
    text, pattern = found["t"], found["p"]
    assert (text["x"], text["font-size"], text["marker-start"], text["r"], text["line-height"]) == (
        "0",
        "16px",
        "none",
        "0",
        "normal",
    )
    assert (pattern["transform"], pattern["x"], pattern["overflow"]) == ("scale(2)", "0", "hidden")


def test_inherited_values_are_handed_down_and_others_are_not() -> None:
    found = styles_of(
        '<g fill="red" opacity=".5" font-size="10" stroke-width="2em" stroke-dasharray="1em 10%">'
        '<g id="a" font-size="200%">'
        '<path id="b" stroke-width="1em" style="opacity:inherit;fill:currentColor"/></g></g>',
        'color="blue"',
    )
    assert (found["a"]["fill"], found["a"]["opacity"], found["a"].font_size) == ("red", "1", 20.0)
    assert (found["a"].length("stroke-width", "x"), found["a"]["stroke-dasharray"]) == (20.0, "10px 10%")
    assert (found["b"].length("stroke-width", "x"), found["b"]["opacity"]) == (20.0, "1")
    assert found["b"].paint("fill").colour == found[""].colour("color")


@pytest.mark.parametrize(
    ("said", "size"),
    [
        ("5px", 5.0),
        ("200%", 32.0),
        ("2em", 32.0),
        ("xx-large", 32.0),
        ("larger", 19.2),
        ("smaller", 16.0 / 1.2),
        ("calc(1em + 50%)", 24.0),
        ("-5px", 16.0),
        ("5", 5.0),
    ],
)
def test_font_sizes(said: str, size: float) -> None:
    assert style_of(f"font-size:{said}").font_size == pytest.approx(size, rel=1e-9)


def test_weights_and_old_writing_modes_come_to_those_of_today() -> None:
    found = styles_of('<g font-weight="bolder"><text id="a" font-weight="bolder" writing-mode="tb"/></g>')
    assert (found["a"]["font-weight"], found["a"]["writing-mode"]) == ("900", "vertical-rl")


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ("italic bold 20px/30px 'A B', serif", ("italic", "700", "20px", "30px", "'A B', serif")),
        ("1.5em serif", ("normal", "400", "24px", "normal", "serif")),
        ("small-caps condensed 10px / 2 a", ("normal", "400", "10px", "2", "a")),
        ("20px", ("oblique", "300", "1px", "5", "x")),
        ("foo 20px serif", ("oblique", "300", "1px", "5", "x")),
        ("20 serif", ("oblique", "300", "1px", "5", "x")),
        ("inherit", ("normal", "400", "16px", "normal", "")),
    ],
)
def test_the_shorthand_of_fonts(said: str, expected: tuple[str, ...]) -> None:
    names = ("font-style", "font-weight", "font-size", "line-height", "font-family")
    before = "font-style:oblique;font-weight:300;font-size:1px;line-height:5;font-family:x;"
    style = style_of(before + f"font:{said}")
    assert tuple(style[name].replace('"', "'") for name in names) == expected
    variable = style_of(f"--f:{said};{before}font:var(--f)")
    if "oblique" not in expected:
        assert tuple(variable[name].replace('"', "'") for name in names) == expected


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ("--a:5px;width:var(--a)", "5px"),
        ("--a:5;width:calc(var(--a)*1px)", "calc(5*1px)"),
        ("--a:var(--b);--b:var(--a);width:var(--a,7px)", "7px"),
        ("--a:var(--a);width:var(--a,7px)", "7px"),
        ("width:1px;width:var(--zz)", "auto"),
        ("width:1px;width:var(--zz,)", "auto"),
        ("width:var(--zz, var(--y, 9px))", "9px"),
        ("--A:1px;--a:2px;width:var(--A)", "1px"),
        ("--a:initial;width:var(--a,4px)", "4px"),
        ("--a:red;width:var(--a)", "auto"),
        ("width:env(zz, 52px)", "52px"),
        ("--a:inherit;width:var(--a,6px)", "6px"),
        ("--a:5px;width:VAR(--a) !important;width:1px", "5px"),
        ("--a: url(#x) ;--b:[{(;)}];width:3px", "3px"),
    ],
)
def test_variables(said: str, expected: str) -> None:
    assert style_of(said)["width"] == expected


def test_variables_are_inherited_and_work_in_attributes() -> None:
    body = '<g style="--c:red;--d:var(--c)"><rect id="a" style="--c:blue" fill="var(--c)" stroke="var(--d, lime)"/></g>'
    assert (styles_of(body)["a"]["fill"], styles_of(body)["a"]["stroke"]) == ("blue", "red")


def test_variables_that_double_one_another_are_given_up() -> None:
    laughs = "--a0:1px 1px;" + "".join(f"--a{n}:var(--a{n - 1}) var(--a{n - 1});" for n in range(1, 60))
    assert style_of(laughs + "stroke-dasharray:var(--a59)")["stroke-dasharray"] == "none"
    chain = "".join(f"--a{n}:var(--a{n + 1});" for n in range(3000)) + "--a3000:1px;"
    assert style_of(chain + "width:2px")["width"] == "2px"


@given(st.dictionaries(st.sampled_from("abcdef"), st.lists(st.sampled_from("abcdef"), max_size=3), max_size=6))
def test_variables_come_to_what_they_stand_for(references: dict[str, list[str]]) -> None:
    """Against a plain reading of the specification: one that can reach itself, or what is undefined, is undefined."""

    def expected(name: str, within: tuple[str, ...]) -> str | None:
        if name not in references or name in within:
            return None
        parts = [expected(other, (*within, name)) for other in references[name]]
        return None if None in parts else " ".join(["1", *(part for part in parts if part)])

    said = "".join(
        f"--{name}:1 {' '.join(f'var(--{other})' for other in others)};" for name, others in references.items()
    )
    for name in "abcdef":
        found = style_of(f"{said}stroke-dasharray:var(--{name})")["stroke-dasharray"]
        assert found == (expected(name, ()) or "none")


# The cascade against a brute force: every rule tried on every element by the definition of its combinators.
Compound = tuple[str, str, str]
"""A name, a class and an id, "" for any."""
Complex = list[tuple[str, Compound]]
"""Compounds from the left, each with what joins it to the one before it."""
names, classes, ids = st.sampled_from(["", "g", "a"]), st.sampled_from(["", "k", "l"]), st.sampled_from(["", "i", "j"])
compounds = st.tuples(names, classes, ids)
complexes = st.lists(st.tuples(st.sampled_from([" ", ">", "+", "~"]), compounds), min_size=1, max_size=3)
rules = st.lists(st.tuples(complexes, st.integers(1, 9), st.booleans()), max_size=6)


@st.composite
def elements(draw: st.DrawFn, depth: int = 3) -> str:
    tag, kind, name = draw(st.sampled_from(["g", "a"])), draw(classes), draw(ids)
    inner = draw(st.lists(elements(depth - 1), max_size=3)) if depth else []
    said = draw(
        st.sampled_from(["", 'stroke-width="11"', 'style="stroke-width:12px"', 'style="stroke-width:13px!important"'])
    )
    return f'<{tag} class="{kind}" id="{name}" {said}>{"".join(inner)}</{tag}>'


def selector_text(selector: Complex) -> str:
    parts = []
    for index, (joint, (tag, kind, name)) in enumerate(selector):
        text = (tag or "*") + (f".{kind}" if kind else "") + (f"#{name}" if name else "")
        parts.append(text if index == 0 else f" {joint} {text}")
    return "".join(parts)


def is_match(element: Element, selector: Complex) -> bool:
    joint, (tag, kind, name) = selector[-1]
    attributes = element.attributes
    if (
        (tag and element.tag != tag)
        or (kind and attributes.get("class") != kind)
        or (name and attributes.get("id") != name)
    ):
        return False
    if len(selector) == 1:
        return True
    if joint in " >":
        above = []
        place = element.parent
        while place is not None:
            above.append(place)
            place = place.parent
    else:
        siblings = element.parent.children if element.parent is not None else [element]
        above = siblings[: siblings.index(element)][::-1]
    return any(is_match(other, selector[:-1]) for other in (above[:1] if joint in ">+" else above))


@given(st.lists(elements(), min_size=1, max_size=3), rules)
def test_the_cascade_is_that_of_a_brute_force(body: list[str], given_rules: list[tuple[Complex, int, bool]]) -> None:
    sheet = "".join(
        f"{selector_text(selector)}{{stroke-width:{value}px{'!important' if is_important else ''}}}"
        for selector, value, is_important in given_rules
    ).replace(">", "&gt;")
    text = f'<svg xmlns="http://www.w3.org/2000/svg"><style>{sheet}</style>{"".join(body)}</svg>'
    document: Document = read_tree(text.encode(), "drawing.svg")
    styles = Styles(document)
    known = {}
    for element in document.root.descendants():
        parent = known[element.parent] if element.parent is not None else styles.root(PAGE)
        known[element] = style = styles.of(element, parent, PAGE)
        candidates: list[tuple[tuple[object, ...], str]] = [((-1,), parent["stroke-width"])]
        if "stroke-width" in element.attributes:
            candidates.append(((0,), element.attributes["stroke-width"]))
        own = element.attributes.get("style", "")
        if own:
            candidates.append(
                ((4,) if "!" in own else (2,), own.removeprefix("stroke-width:").removesuffix("!important"))
            )
        for order, (selector, value, is_important) in enumerate(given_rules):
            if is_match(element, selector):
                weight = [sum(bool(part[index]) for _, part in selector) for index in (2, 1, 0)]
                candidates.append(((3 if is_important else 1, weight, order), f"{value}px"))
        assert style["stroke-width"] == max(candidates, key=lambda candidate: candidate[0])[1]
