"""Selectors beyond plain names and combinators, which the brute force of the cascade tries: what Chromium matches."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.drawing.style.styling import styles_of

BODY = (
    '<g id="1" class="k" xml:lang="en-US"><path id="2" class="k l"/><rect id="3"/><path id="4" stroke="RED"/></g>'
    '<g id="5"/><a id="6" href="#1"/><g id="7"> </g><path id="8" class="m:n" xlink:href="#1"/>'
)


@pytest.mark.parametrize(
    ("selector", "expected"),
    [
        (":root > *", "15678"),
        ("svg > :first-child, g > :last-child", "4"),  # the style sheet is the first child of the svg
        (":nth-child(2n+1)", "2457"),
        (":nth-last-child(-n+2)", "3478"),
        ("path:nth-of-type(2), path:first-of-type:last-of-type", "48"),
        (":only-of-type:not(svg, style)", "368"),
        (":nth-child(2 of .k)", ""),
        (":nth-child(even of path)", "4"),
        (":nth-last-child(1 of path)", "48"),
        ("g:empty", "5"),
        (":not(g):not(.l, rect, style)", "468"),
        (":is(path, rect).l, :where(#3)", "2"),  # an id does not begin with a digit
        (":is(path:foo, rect, ..)", "3"),
        (":not(path:foo), rect", ""),
        ("g:has(> rect), path:has(+ rect), rect:has(~ path)", "123"),
        ("svg:has(.l) > g:has(.l)", "1"),
        ("[stroke=red i], [class~=l], [class|=m], [id^='5'], [id$='7'], [href*='1']", "24567"),
        ("[class~='k l'], [class^=''], [id=8]", ""),
        (":link, :any-link", "6"),
        (":hover, :visited, :focus, :target, :checked, :enabled", ""),
        (":lang(en)", "1234"),
        (":foo, path", ""),
        ("path::before, ::foo", ""),
        ("path::before, rect", "3"),
        ("s|rect, x|*", "3"),
        ("[xlink|href], [*|lang]", "18"),
        (r"#\32, .m\:n", "28"),
        ("PATH, .K", ""),
        ("path, rect,", ""),
        ("g path + rect ~ path", "4"),
    ],
)
def test_what_matches(selector: str, expected: str) -> None:
    names = (
        "@namespace s 'http://www.w3.org/2000/svg'; @namespace x url(urn:x);"
        '@namespace xlink "http://www.w3.org/1999/xlink";'
    )
    sheet = f"{names} {selector} {{opacity:.5}}".replace("<", "&lt;").replace(">", "&gt;")
    found = styles_of(f"<style>{sheet}</style>{BODY}", 'xmlns:xlink="http://www.w3.org/1999/xlink"')
    assert "".join(sorted(name for name, style in found.items() if name and style["opacity"] == ".5")) == expected


@given(st.integers(-4, 4), st.integers(-4, 6), st.integers(0, 8))
def test_steps_are_those_of_a_plain_count(a: int, b: int, n: int) -> None:
    shapes = "".join(f'<path id="{index}"/><rect/>' for index in range(1, n + 1))
    step = f"{a}n{b:+d}"
    sheet = f"path:nth-of-type({step}){{stroke-width:5px}} path:nth-last-of-type({step}){{opacity:0}}"
    found = styles_of(f"<style>{sheet}</style><g>{shapes}</g>")
    chosen = {a * k + b for k in range(20)}
    for index in range(1, n + 1):
        assert (found[str(index)]["stroke-width"] == "5px") is (index in chosen)
        assert (found[str(index)]["opacity"] == "0") is (n + 1 - index in chosen)


def test_selectors_take_few_steps_on_many_elements() -> None:
    """Quadratic work, or a call for each element, would not come back."""
    rules = (
        "path ~ path{stroke:red} path:nth-of-type(2n){fill:red} path:has(~ rect){opacity:.3} g:has(rect){fill:red}"
        + "g " * 60
        + "path{fill:red} :not(.a ~ .b ~ .c){stroke:red}"
    )
    shapes = "<path/>" * 5000 + '<path id="a"/><rect/>'
    found = styles_of(f"<style>{rules}</style>" + "<g>" * 90 + shapes + "</g>" * 90)
    assert (found["a"]["stroke"], found["a"]["opacity"], found["a"]["fill"]) == ("red", ".3", "red")
