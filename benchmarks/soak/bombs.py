"""SVGs that mean ill: small files that ask for a great deal of work, or for work without end."""

from __future__ import annotations

import base64
import random
from collections.abc import Callable

_HEAD = b'<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 100 100"'
_RECT = '<rect width="90" height="90" fill="none" stroke="black"/>'
Chance = random.Random


def bomb(chance: Chance) -> bytes:
    """One of them, of a random size."""
    made = chance.choice(_KINDS)(chance)
    return made if isinstance(made, bytes) else _HEAD + b">" + made.encode() + b"</svg>"


def _size(chance: Chance, largest: int) -> int:
    """Small as often as large."""
    return int(2.0 ** (chance.random() * chance.random() ** 0.3 * largest.bit_length())) + 1


def _doubling_use(chance: Chance) -> str:
    n, wide = chance.randrange(2, 60), chance.choice((1, 2, 2, 10))
    levels = "".join(
        f'<g id="u{i}">' + f'<use href="#u{i - 1}" x="{chance.choice((0, 1, 1e-9, 1e9))}"/>' * wide + "</g>"
        for i in range(1, n)
    )
    wrap = chance.choice(("<defs>{}</defs>", "{}"))
    return wrap.format(f'<g id="u0">{_RECT}</g>' + levels) + f'<use href="#u{n - 1}"/>'


def _circles(chance: Chance) -> str:
    """Things that refer to one another in a circle."""
    n = chance.randrange(1, 6)
    kinds = [chance.choice(("g", "pattern", "clipPath", "mask", "marker", "symbol", "filter")) for _ in range(n)]
    referring = ('fill="url(#{})"', 'stroke="url(#{})"', 'clip-path="url(#{})"', 'mask="url(#{})"', 'marker="url(#{})"')
    parts = []
    for i, kind in enumerate(kinds):
        reference = chance.choice(referring).format(f"r{(i + 1) % n}")
        inside = chance.choice(
            (
                f'<path d="M0 0L9 9 0 9" {reference}/>',
                f'<use href="#r{(i + 1) % n}" {reference}/>',
                f"<text {reference}>x</text>",
            )
        )
        parts.append(f'<{kind} id="r{i}" width="9" height="9" {chance.choice((reference, ""))}>{inside}</{kind}>')
    uses = "".join(f'<rect width="50" height="50" {one.format("r0")}/>' for one in referring)
    return "".join(parts) + uses + '<use href="#r0"/>'


def _nested_paints(chance: Chance) -> str:
    """Pattern in pattern, clip in clip, mask in mask, marker in marker: each multiplies the work."""
    kind, refers = chance.choice(
        (
            ("pattern", 'fill="url(#n{})" stroke="red"'),
            ("clipPath", 'clip-path="url(#n{})"'),
            ("mask", 'mask="url(#n{})" fill="white"'),
            ("marker", 'marker-mid="url(#n{})" fill="none" stroke="red"'),
        )
    )
    n, side = _size(chance, 300), chance.choice(("1", "0.1", "1e-3", "1e-6", "50%"))
    shape = '<path d="M0 0L5 5 0 9 9 1 3 2 8 8" {}/>' * chance.choice((1, 1, 3))
    size = f'width="{side}" height="{side}" patternUnits="userSpaceOnUse" overflow="visible"'
    parts = [
        f'<{kind} id="n{i}" {size}>' + shape.replace("{}", refers.format(i + 1) if i < n else "") + f"</{kind}>"
        for i in range(n + 1)
    ]
    return "".join(parts) + shape.replace("{}", refers.format(0))


def _tiny_pattern(chance: Chance) -> str:
    side = 10.0 ** -chance.randrange(0, 300 if chance.random() < 0.2 else 9)
    turn = chance.choice(("", "rotate(30)", "scale(1e-5)", "skewX(89.9999)", "matrix(0 0 0 0 0 0)", "scale(1e9)"))
    return (
        f'<pattern id="p" width="{side}" height="{side}" patternUnits="userSpaceOnUse" patternTransform="{turn}">'
        f'<path d="M0 0L1 1" stroke="red"/></pattern>'
        f'<rect width="{chance.choice((1, 100, 1e9))}" height="99" fill="url(#p)"/>'
    )


def _dashes(chance: Chance) -> str:
    array = " ".join(str(10.0 ** chance.uniform(-9, 3)) for _ in range(_size(chance, 100_000)))
    if chance.random() < 0.5:
        array = chance.choice(("1e-9", "1e-300 1e-300", "0 0", "0 1e-7", "1e308", "nan", "1e-3,1e-3", "0.0001%"))
    more = f'stroke-dashoffset="{chance.choice((0, -1e9, 1e300, 0.5))}" pathLength="{chance.choice((1, 0, 1e-9, 1e9))}"'
    where = chance.choice(("M0 0L1e6 1e6", "M0 0L100 100", "M0 0C0 1e9 100 1e9 9 9", "M0 0A50 50 0 1 1 1 1", "M0 0h0"))
    return f'<path d="{where}" stroke="black" stroke-linecap="round" stroke-dasharray="{array}" {more}/>'


def _deep(chance: Chance) -> str:
    n = _size(chance, 200_000)
    tag = chance.choice(("g", "svg", "a", "switch", "text", "symbol", "defs", "tspan", "x", "clipPath", "pattern"))
    attribute = chance.choice(("", ' opacity="0.5"', ' transform="scale(0.99)"', ' style="font-size:1.1em"'))
    return f"<{tag}{attribute}>" * n + _RECT + f"</{tag}>" * n


def _entities(chance: Chance) -> bytes:
    n, wide = chance.randrange(1, 40), chance.choice((1, 2, 10, 100))
    declared = "".join(f'<!ENTITY e{i} "{f"&e{i - 1};" * wide}">' for i in range(1, n))
    first = chance.choice(("lol", "<rect width='9' height='9'/>", "x" * _size(chance, 100_000), "&e1;", "1 1 "))
    kind = chance.choice((f'"{first}"', 'SYSTEM "file:///etc/passwd"', 'SYSTEM "http://drawing.invalid/x"'))
    used = chance.choice((f"&e{n - 1};", f'<path d="&e{n - 1};"/>', f"<text>&e{n - 1};</text>")) * _size(chance, 1000)
    document = f'<?xml version="1.0"?><!DOCTYPE svg [<!ENTITY e0 {kind}>{declared}]>'
    return document.encode() + _HEAD + b">" + used.encode() + _RECT.encode() + b"</svg>"


def _css(chance: Chance) -> str:
    n = _size(chance, 3000)
    kind = chance.randrange(7)
    if kind == 0:  # custom properties that double
        rules = (
            "*{"
            + "".join(f"--v{i}: var(--v{i + 1}) var(--v{i + 1});" for i in range(n))
            + f"--v{n}: red; fill: var(--v0)}}"
        )
    elif kind == 1:
        rules = "rect{stroke-width:" + "calc(" * n + "1px" + " + 1px)" * n + "}"
    elif kind == 2:
        rules = "".join(f"g:nth-child({i}n+1) * > rect:not(.c{i}) ~ rect {{ stroke: #00{i % 10} }}" for i in range(n))
    elif kind == 3:
        rules = ":is(" * n + "rect" + ")" * n + "{ stroke: red }"
    elif kind == 4:
        rules = "@media screen {" * n + "rect { stroke: red }" + "}" * n
    elif kind == 5:
        rules = (
            "*{font-size: 1000em; stroke-width: 1e300em; --a: var(--b); --b: var(--a, var(--b)); stroke: var(--a)}" * n
        )
    else:
        rules = "rect{stroke:url(data:" + "a" * n + ");d:path('" + "M0 0" * n + "');transform:" + "scale(2) " * n + "}"
    return f"<style>{rules.replace('<', '')}</style>" + ("<g>" + _RECT * 20 + "</g>") * min(n, 100)


def _text(chance: Chance) -> str:
    n = _size(chance, 50_000)
    words = chance.choice(("x", "é ", "e\u0301\u0302", "\u202e\u05d0", "👨‍👩‍👧", "漢", "&#9;", "\u0915\u094d")) * n
    kind = chance.randrange(5)
    size = chance.choice(("10", "1e9", "1e-9", "0", "-5", "1e300", "nan", "100%"))
    if kind == 0:
        return f'<text x="{"1 " * n}" dy="{"1e9 " * n}" rotate="{"1 2 " * n}" font-size="{size}">{words}</text>'
    if kind == 1:
        along = f'<path id="t" d="M0 0{"l1 1-1-1" * n}"/>'
        return f'{along}<text font-size="{size}"><textPath href="#t">{words}</textPath></text>'
    if kind == 2:
        return f'<text textLength="{chance.choice((0, 1e-9, 1e300))}" letter-spacing="{size}">{words}</text>'
    if kind == 3:
        return f'<text id="q">{words[:500]}<textPath href="#q">x<tref href="#q"/></textPath></text><use href="#q"/>'
    return "<text>" + "<tspan x='1' dx='1 2'>a" * n + "</tspan>" * n + "</text>"


def _many(chance: Chance) -> str:
    n = _size(chance, 20_000)
    shapes = "".join(
        f'<circle cx="{chance.uniform(0, 100):.3f}" cy="{chance.uniform(0, 100):.3f}" r="{chance.uniform(0, 40):.3f}"/>'
        for _ in range(n)
    )
    lines = "M" + " ".join(
        f"{chance.uniform(0, 100):.2f} {chance.uniform(0, 100):.2f}" for _ in range(_size(chance, 20_000))
    )
    kind = chance.choice(("clipPath", "mask"))
    name = "clip-path" if kind == "clipPath" else "mask"
    return f'<{kind} id="m" fill="white">{shapes}</{kind}><path d="{lines}" {name}="url(#m)" fill="none" stroke="red"/>'


def _markers(chance: Chance) -> str:
    n = _size(chance, 100_000)
    return (
        f'<marker id="k" markerWidth="{chance.choice((3, 1e9, 1e-9))}" markerHeight="3" orient="auto"'
        f' viewBox="0 0 1e-9 1">'
        f'<path d="M0 0{"l1 1" * _size(chance, 300)}"/></marker>'
        f'<path d="M0 0{"l1 1-1-1" * n}" marker-mid="url(#k)" fill="none" stroke="red"/>'
    )


def _images(chance: Chance) -> str:
    inside = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">' + _RECT.encode() + b"</svg>"
    for _ in range(chance.randrange(1, 9)):
        link = b"data:image/svg+xml;base64," + base64.b64encode(inside)
        image = b'<image width="9" height="9" href="' + link + b'"/>'
        inside = (
            b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">' + image * chance.choice((1, 2)) + b"</svg>"
        )
    return f'<image width="90" height="90" href="data:image/svg+xml;base64,{base64.b64encode(inside).decode()}"/>'


def _numbers(chance: Chance) -> str:
    def number() -> str:
        return chance.choice(("1e308", "-1e308", "1e39", "1e-320", "nan", "inf", "1e9", "5", "0", "-0", "1e17", "0.1"))

    path = "M5 5" + "".join(
        chance.choice("MLCSQTAHVZmlcsqtahvz") + " ".join(number() for _ in range(chance.randrange(8)))
        for _ in range(_size(chance, 2000))
    )
    turn = f"matrix({' '.join(number() for _ in range(6))})"
    box = " ".join(number() for _ in range(4))
    return (
        f'<svg viewBox="{box}" width="{number()}" height="{number()}"><g transform="{turn}">'
        f'<path d="{path}" stroke="red" stroke-width="{number()}" stroke-dasharray="{number()} {number()}"/>'
        f'<ellipse rx="{number()}" ry="{number()}"/>'
        f'<rect width="{number()}" height="{number()}" rx="{number()}"/></g></svg>' + _RECT
    )


_KINDS: tuple[Callable[[Chance], str | bytes], ...] = (
    _doubling_use,
    _circles,
    _nested_paints,
    _tiny_pattern,
    _dashes,
    _deep,
    _entities,
    _css,
    _text,
    _many,
    _markers,
    _images,
    _numbers,
)
