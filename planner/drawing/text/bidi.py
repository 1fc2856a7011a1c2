"""The Unicode bidirectional algorithm (UAX #9) for one line: which way characters run, and in which order they stand.

Explicit embeddings (LRE, RLI and the like) are taken as neutral; `unicode-bidi: bidi-override` is honoured.
"""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from itertools import groupby

_STRONG = ("L", "R")
_NEUTRAL = ("B", "S", "WS", "ON", "LRE", "LRO", "RLE", "RLO", "PDF", "LRI", "RLI", "FSI", "PDI", "BN")


def levels(text: str, overrides: Sequence[str | None], *, is_rtl: bool) -> list[int]:
    """The embedding level of each character; odd levels run from right to left. overrides: "L" or "R" where the style
    says so whatever the character is."""
    base = "R" if is_rtl else "L"
    if not is_rtl and text.isascii() and not any(overrides):
        return [0] * len(text)
    kinds = [
        override or unicodedata.bidirectional(character) or "L"
        for character, override in zip(text, overrides, strict=True)
    ]
    _resolve_weak(kinds, base)
    _resolve_neutral(kinds, base)
    if is_rtl:
        return [1 if kind == "R" else 2 for kind in kinds]
    return [{"L": 0, "R": 1}.get(kind, 2) for kind in kinds]


def _resolve_weak(kinds: list[str], base: str) -> None:
    """Rules W1 to W7."""
    before, strong = base, base
    for index, kind in enumerate(kinds):
        if kind == "NSM":
            kinds[index] = before
        elif kind == "EN" and strong == "AL":
            kinds[index] = "AN"
        if kind in ("L", "R", "AL"):
            strong = kind
        before = kinds[index]
    kinds[:] = ["R" if kind == "AL" else kind for kind in kinds]
    for index in range(1, len(kinds) - 1):
        kind, beside = kinds[index], (kinds[index - 1], kinds[index + 1])
        if (kind in ("ES", "CS") and beside == ("EN", "EN")) or (kind == "CS" and beside == ("AN", "AN")):
            kinds[index] = beside[0]
    start = 0
    for kind, run in groupby(list(kinds)):
        stop = start + len(list(run))
        if kind == "ET" and "EN" in (kinds[start - 1] if start else "", kinds[stop] if stop < len(kinds) else ""):
            kinds[start:stop] = ["EN"] * (stop - start)
        start = stop
    strong = base
    for index, kind in enumerate(kinds):
        if kind in ("ES", "ET", "CS"):
            kinds[index] = "ON"
        elif kind == "EN" and strong == "L":
            kinds[index] = "L"
        elif kind in _STRONG:
            strong = kind


def _resolve_neutral(kinds: list[str], base: str) -> None:
    """Rules N1 and N2: between two of the same direction neutrals go that way, otherwise that of the line."""
    start = 0
    before = base
    for is_neutral, run in groupby(list(kinds), lambda kind: kind in _NEUTRAL):
        found = list(run)
        stop = start + len(found)
        if is_neutral:
            after = _direction(kinds[stop]) if stop < len(kinds) else base
            kinds[start:stop] = [before if before == after else base] * (stop - start)
        else:
            before = _direction(found[-1])
        start = stop


def _direction(kind: str) -> str:
    return "L" if kind == "L" else "R"


def visual_order(found: Sequence[int]) -> list[int]:
    """Indices of characters from left to right (rule L2)."""
    order = list(range(len(found)))
    for level in range(max(found, default=0), 0, -1):
        start = 0
        while start < len(order):
            stop = start
            while stop < len(order) and found[order[stop]] >= level:
                stop += 1
            order[start:stop] = order[start:stop][::-1]
            start = max(stop, start) + 1
    return order
