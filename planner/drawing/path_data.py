"""Path data with arcs rewritten to the same path in absolute M, L, C, Q and Z."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from planner.drawing.arcs import arc_to_cubics

_NUMBER = r"[\s,]*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)"
_FLAG = r"[\s,]*([01])"
_COMMAND = re.compile(r"[\s,]*([MmLlHhVvCcSsQqTtAaZz])")
_FOREIGN = re.compile(r"[^MmLlHhVvCcSsQqTtAaZz0-9eE+\-.,\s]")
# An integer part of ten digits or more, or a decimal exponent of nine or more.
_HUGE = re.compile(r"(?<![\d.])0*[1-9]\d{9}|[eE]\+?0*(?:9|[1-9]\d)")
_ARGUMENTS = {
    letter: re.compile(arguments)
    for letter, arguments in {
        "M": 2 * _NUMBER,
        "L": 2 * _NUMBER,
        "H": _NUMBER,
        "V": _NUMBER,
        "C": 6 * _NUMBER,
        "S": 4 * _NUMBER,
        "Q": 4 * _NUMBER,
        "T": 2 * _NUMBER,
        "A": 3 * _NUMBER + 2 * _FLAG + 2 * _NUMBER,
        "Z": "",
    }.items()
}


def has_unusable_numbers(data: str) -> bool:
    """Whether a number is too large (1e9 and more) to be a coordinate."""
    return _HUGE.search(data) is not None


def has_foreign_characters(data: str) -> bool:
    """Whether there is anything that path data cannot hold, such as `NaN`: the path ends there."""
    return _FOREIGN.search(data) is not None


def commands(data: str) -> Iterator[str]:
    """The same path in absolute M, L, C, Q and Z, bit by bit, as arcs may multiply what there is; data without arcs as
    it stands. After an error in the data, what stands before it is kept (SVG 1.1, section F.2)."""
    if "A" not in data and "a" not in data:
        return iter((data,))
    return _Rewriter(data).commands()


def command(letter: str, values: Iterable[float]) -> str:
    """One path command with every digit of its numbers."""
    return letter + " ".join(map(repr, values))


class _Rewriter:
    def __init__(self, data: str) -> None:
        self._data = data
        self._at = 0
        self._x = self._y = self._start_x = self._start_y = 0.0
        # The last control point, for S after C or S and for T after Q or T.
        self._cubic_handle: tuple[float, float] | None = None
        self._quadratic_handle: tuple[float, float] | None = None

    def commands(self) -> Iterator[str]:
        letter, is_first = "", True
        while True:
            match = _COMMAND.match(self._data, self._at)
            if match:
                letter, self._at = match[1], match.end()
                values = self._arguments(letter.upper())
            elif letter and letter not in "Zz":
                letter = {"M": "L", "m": "l"}.get(letter, letter)
                values = self._arguments(letter.upper())
            else:
                break
            if values is None or (is_first and letter not in "Mm"):
                break
            is_first = False
            yield from self._segment(letter.upper(), letter.islower(), values)

    def _arguments(self, letter: str) -> list[float] | None:
        """The numbers of one segment; None where they end or are not numbers."""
        match = _ARGUMENTS[letter].match(self._data, self._at)
        if not match:
            return None
        self._at = match.end()
        return [float(number) for number in match.groups()]

    def _segment(self, letter: str, relative: bool, values: list[float]) -> Iterator[str]:
        if letter == "Z":
            yield "Z"
            self._x, self._y = self._start_x, self._start_y
            self._cubic_handle = self._quadratic_handle = None
            return
        if letter in "HV":
            letter, values = "L", self._line_end(letter, relative, values[0])
        elif relative and letter == "A":
            values = [*values[:5], values[5] + self._x, values[6] + self._y]
        elif relative:
            values = [value + (self._y if index % 2 else self._x) for index, value in enumerate(values)]
        cubic_handle = quadratic_handle = None
        if letter == "S":
            letter, values = "C", [*self._reflected(self._cubic_handle), *values]
        elif letter == "T":
            letter, values = "Q", [*self._reflected(self._quadratic_handle), *values]
        if letter == "A":
            rx, ry, rotation, large, sweep, x, y = values
            for cubic in arc_to_cubics(self._x, self._y, rx, ry, rotation, large > 0.5, sweep > 0.5, x, y):
                yield command("C", cubic)
        else:
            yield command(letter, values)
            if letter == "C":
                cubic_handle = (values[2], values[3])
            elif letter == "Q":
                quadratic_handle = (values[0], values[1])
        self._x, self._y = values[-2], values[-1]
        self._cubic_handle, self._quadratic_handle = cubic_handle, quadratic_handle
        if letter == "M":
            self._start_x, self._start_y = self._x, self._y

    def _line_end(self, letter: str, relative: bool, value: float) -> list[float]:
        if letter == "H":
            return [value + self._x if relative else value, self._y]
        return [self._x, value + self._y if relative else value]

    def _reflected(self, handle: tuple[float, float] | None) -> tuple[float, float]:
        if handle is None:
            return (self._x, self._y)
        return (2.0 * self._x - handle[0], 2.0 * self._y - handle[1])
