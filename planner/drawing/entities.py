"""Entities that a document declares for itself: how large they may make it.

The XML reader expands them. Before it does, their expanded sizes are summed: each entity once, from those that it
refers to, so that a few lines that stand for a billion cost no more than the few lines.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

COUNT_LIMIT = 500
DEPTH_LIMIT = 20
TEXT_LIMIT = 1 << 19
"""Characters of all declared texts together."""
EXPANDED_LIMIT = 8 << 20
"""Characters that all references together may come to."""
_PREDEFINED = frozenset({"amp", "lt", "gt", "quot", "apos"})
_REFERENCE = re.compile(r"&([^\s&;#][^\s&;]*);")
_ADVICE = "(save it as plain SVG)"


@dataclass(slots=True)
class Entities:
    """The general entities of a document, checked as they are declared. refuse: raises an error with a reason."""

    refuse: Callable[[str], None]
    _lengths: dict[str, int] = field(default_factory=dict)
    _references: dict[str, Counter[str]] = field(default_factory=dict)
    _referred: set[str] = field(default_factory=set)
    _sizes: dict[str, int] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self._lengths)

    def declare(self, name: str, text: str) -> None:
        """Take note of an entity; the first declaration of a name counts, as XML has it."""
        if name in self._lengths:
            return
        self._lengths[name] = len(text)
        self._references[name] = Counter(_REFERENCE.findall(text))
        if len(self._lengths) > COUNT_LIMIT:
            self.refuse(f"declares more than {COUNT_LIMIT} entities {_ADVICE}")
        if sum(self._lengths.values()) > TEXT_LIMIT:
            self.refuse(f"declares entities of more than {TEXT_LIMIT} characters {_ADVICE}")
        if name in self._referred:  # those declared before it grow
            self._sizes.clear()
        self._referred |= self._references[name].keys()
        for declared in self._lengths:
            self._check(self._size(declared, ()))

    def check(self, text: str) -> None:
        """Refuse a document whose references come to more than the limit."""
        largest = max(self._sizes.values(), default=0)
        total = 0
        for match in _REFERENCE.finditer(text):
            total += 1 if match[1] in _PREDEFINED else self._sizes.get(match[1], largest)
            self._check(total)

    def _check(self, size: int) -> None:
        if size > EXPANDED_LIMIT:
            self.refuse(f"its entities expand to more than {EXPANDED_LIMIT} characters {_ADVICE}")

    def _size(self, name: str, within: tuple[str, ...]) -> int:
        """Characters that an entity expands to, with all that is declared by now."""
        if name not in self._lengths:
            return 1
        if name not in self._sizes:
            if name in within:
                self.refuse(f"its entity &{name[:40]}; refers to itself, directly or in a circle")
            if len(within) >= DEPTH_LIMIT:
                self.refuse(f"its entities nest more than {DEPTH_LIMIT} deep {_ADVICE}")
            inner = self._references[name].items()
            size = self._lengths[name] + sum(n * self._size(other, (*within, name)) for other, n in inner)
            self._sizes[name] = size
        return self._sizes[name]
