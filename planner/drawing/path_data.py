"""Path data to subpaths, by the grammar of SVG 2, section 9.3: what stands before an error is drawn."""

from __future__ import annotations

import re
from array import array
from dataclasses import dataclass, field

import numpy as np

from planner.arrays import BoolArray, FloatArray
from planner.drawing.arcs import Cubic, arc_to_cubics
from planner.drawing.subpath import Subpath

# Atomic: no digit of a number is ever given up for the number that is missing after it.
_NUMBER = r"((?>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?))\s*,?\s*"
_FLAG = r"([01])\s*,?\s*"
_COMMAND = re.compile(r"\s*([MmLlHhVvCcSsQqTtAaZz])\s*")
_FOREIGN = re.compile(r"[^MmLlHhVvCcSsQqTtAaZz0-9eE+\-.,\s]")
# An integer part of ten digits or more, or a decimal exponent of nine or more.
_HUGE = re.compile(r"(?<![\d.])0*[1-9]\d{9}|[eE]\+?0*(?:9|[1-9]\d)")
_ARGUMENTS = {
    letter: re.compile(arguments)
    for letter, arguments in {
        "M": 2 * _NUMBER,
        "H": _NUMBER,
        "V": _NUMBER,
        "C": 6 * _NUMBER,
        "S": 4 * _NUMBER,
        "Q": 4 * _NUMBER,
        "T": 2 * _NUMBER,
        "A": 3 * _NUMBER + 2 * _FLAG + 2 * _NUMBER,
    }.items()
}
# A line may repeat its letter: where there are millions of commands, most are these.
_LINES = {letter: re.compile(rf"(?:{letter}\s*)?" + 2 * _NUMBER) for letter in "Ll"}
_ROUNDING = 1e-13
CURVE_LIMIT = 2_500_000
"""Of a whole drawing, and so of each path."""
Handle = tuple[float, float]


class TooManyCurves(Exception):
    """A path of more lines and curves than the limit, arcs counted as the curves that they become."""


def has_unusable_numbers(data: str) -> bool:
    """Whether a number is too large (1e9 and more) to be a coordinate."""
    return _HUGE.search(data) is not None


def has_foreign_characters(data: str) -> bool:
    """Whether there is anything that path data cannot hold, such as `NaN`: the path ends there."""
    return _FOREIGN.search(data) is not None


def parse_path(data: str) -> list[Subpath]:
    """The subpaths of path data, empty where it begins with an error.

    Every segment is a curve, those of zero length too; a subpath that `Z` closes ends with the closing one. An `M` with
    nothing after it is one curve of four equal points whose end is no vertex: it has a place and is not drawn. Errors:
    TooManyCurves.
    """
    return _Reader(data).subpaths()


def parse_points(text: str) -> FloatArray:
    """The points (n, 2) of `points`; half a point, and what follows an error, are left out."""
    at, flat = len(text) - len(text.lstrip()), array("d")
    while match := _ARGUMENTS["M"].match(text, at):
        flat.extend((float(match[1]), float(match[2])))
        at = match.end()
    return np.array(flat).reshape(-1, 2)


@dataclass(slots=True)
class Curves:
    """Cubics as they are collected: eight numbers each; where subpaths begin and which of them are closed."""

    flat: array[float] = field(default_factory=lambda: array("d"))
    is_vertex: bytearray = field(default_factory=bytearray)
    starts: list[int] = field(default_factory=list)
    is_closed: list[bool] = field(default_factory=list)

    def begin(self) -> None:
        """A new subpath, open so far."""
        self.starts.append(len(self.is_vertex))
        self.is_closed.append(False)

    def line(self, x0: float, y0: float, x1: float, y1: float, is_vertex: bool = True) -> None:
        across, down = (x1 - x0) / 3.0, (y1 - y0) / 3.0
        self.flat.extend((x0, y0, x0 + across, y0 + down, x1 - across, y1 - down, x1, y1))
        self.is_vertex.append(is_vertex)

    def cubic(self, x0: float, y0: float, rest: tuple[float, ...], is_vertex: bool = True) -> None:
        self.flat.extend((x0, y0, *rest))
        self.is_vertex.append(is_vertex)

    def cubics(self, x0: float, y0: float, curves: list[Cubic], end: tuple[float, float]) -> None:
        """Consecutive cubics, of which the last one ends exactly at `end`, and alone in a vertex."""
        if len(self.is_vertex) > CURVE_LIMIT:
            raise TooManyCurves
        for curve in curves[:-1]:
            self.cubic(x0, y0, curve, is_vertex=False)
            x0, y0 = curve[4:]
        self.cubic(x0, y0, (*curves[-1][:4], *end))

    def subpaths(self) -> list[Subpath]:
        """All of them, as views of one array."""
        if not self.starts:
            return []
        curves: FloatArray = np.frombuffer(self.flat, dtype=np.float64).reshape(-1, 4, 2)
        curves.setflags(write=False)
        vertices: BoolArray = np.frombuffer(bytes(self.is_vertex), dtype=np.bool_)
        ends = [*self.starts[1:], len(curves)]
        return [
            Subpath(curves[start:end], is_closed, vertices[start:end])
            for start, end, is_closed in zip(self.starts, ends, self.is_closed, strict=True)
        ]


class _Reader:
    """Where the pen is (x, y), where its subpath began, and the last handle of a curve, for S and T."""

    def __init__(self, data: str) -> None:
        self._data = data
        self._curves = Curves()
        self._x = self._y = self._start_x = self._start_y = 0.0
        self._handle: Handle | None = None
        self._handle_of = ""
        self._is_lone = False  # whether a subpath has begun that has no curve so far

    def subpaths(self) -> list[Subpath]:
        at, letter = 0, ""
        while match := _COMMAND.match(self._data, at):
            if not letter and match[1] not in "Mm":
                break
            letter, start = match[1], match.end()
            if letter in "Zz":
                self._close()
                at = start
                continue
            at = self._lines(start, letter) if letter in "Ll" else self._segments(start, letter)
            if at == start:
                break
            if letter in "Mm":
                at = self._lines(at, "L" if letter == "M" else "l")
        self._end_lone_move()
        return self._curves.subpaths()

    def _lines(self, at: int, letter: str) -> int:
        """As many lines as there are from `at` on; where they end."""
        match = _LINES[letter].match(self._data, at)
        if match is None:
            return at
        self._begin()
        data, pattern = self._data, _LINES[letter]
        flat, is_relative, n_before = self._curves.flat, letter == "l", len(self._curves.flat)
        x, y = self._x, self._y
        while match:
            before_x, before_y = x, y
            x, y = float(match[1]), float(match[2])
            if is_relative:
                x += before_x
                y += before_y
            across, down = (x - before_x) / 3.0, (y - before_y) / 3.0
            flat.extend((before_x, before_y, before_x + across, before_y + down, x - across, y - down, x, y))
            if len(flat) > 8 * CURVE_LIMIT:
                raise TooManyCurves
            at = match.end()
            match = pattern.match(data, at)
        self._curves.is_vertex.extend(b"\1" * ((len(flat) - n_before) // 8))
        self._x, self._y, self._handle_of = x, y, ""
        return at

    def _segments(self, at: int, letter: str) -> int:
        """As many segments of a kind as there are from `at` on, of `M` one; where they end."""
        kind, is_relative = letter.upper(), letter.islower()
        pattern = _ARGUMENTS[kind]
        while match := pattern.match(self._data, at):
            at = match.end()
            values = [float(number) for number in match.groups()]
            if is_relative:
                self._make_absolute(kind, values)
            if kind == "M":
                self._move(*values)
                break
            self._begin()
            self._draw(kind, values)
        return at

    def _make_absolute(self, kind: str, values: list[float]) -> None:
        if kind == "V":
            values[0] += self._y
            return
        for index in range(5 if kind == "A" else 0, len(values), 2):
            values[index] += self._x
            if index + 1 < len(values):
                values[index + 1] += self._y

    def _move(self, x: float, y: float) -> None:
        self._end_lone_move()
        self._x, self._y = self._start_x, self._start_y = x, y
        self._handle_of = ""
        self._curves.begin()
        self._is_lone = True

    def _end_lone_move(self) -> None:
        if self._is_lone:
            self._curves.line(self._x, self._y, self._x, self._y, is_vertex=False)
            self._is_lone = False

    def _begin(self) -> None:
        """A segment follows: after `Z` it begins a subpath of its own, where the last one began."""
        if self._curves.is_closed[-1]:
            self._curves.begin()
        self._is_lone = False

    def _close(self) -> None:
        self._is_lone = False
        reach = abs(self._start_x) + abs(self._start_y) + abs(self._x) + abs(self._y)
        if self._curves.starts[-1] < len(self._curves.is_vertex) and (
            abs(self._x - self._start_x) + abs(self._y - self._start_y) <= _ROUNDING * reach
        ):
            # What comes back to its start by sums of relative steps is there but for rounding.
            self._curves.flat[-2:] = array("d", (self._start_x, self._start_y))
            self._x, self._y = self._start_x, self._start_y
        self._curves.line(self._x, self._y, self._start_x, self._start_y)
        self._curves.is_closed[-1] = True
        self._x, self._y, self._handle_of = self._start_x, self._start_y, ""

    def _draw(self, kind: str, values: list[float]) -> None:
        x0, y0 = self._x, self._y
        if kind == "H":
            self._straight(values[0], y0)
        elif kind == "V":
            self._straight(x0, values[0])
        elif kind == "C":
            self._cubic(*values)
        elif kind == "S":
            self._cubic(*self._reflected("C"), *values)
        elif kind == "Q":
            self._quadratic(*values)
        elif kind == "T":
            self._quadratic(*self._reflected("Q"), *values)
        else:
            self._arc(*values)

    def _straight(self, x: float, y: float) -> None:
        self._curves.line(self._x, self._y, x, y)
        self._x, self._y, self._handle_of = x, y, ""

    def _cubic(self, x1: float, y1: float, x2: float, y2: float, x: float, y: float) -> None:
        self._curves.cubic(self._x, self._y, (x1, y1, x2, y2, x, y))
        self._x, self._y, self._handle, self._handle_of = x, y, (x2, y2), "C"

    def _quadratic(self, x1: float, y1: float, x: float, y: float) -> None:
        x0, y0 = self._x, self._y
        first = (x0 + (x1 - x0) / 1.5, y0 + (y1 - y0) / 1.5)
        second = (x + (x1 - x) / 1.5, y + (y1 - y) / 1.5)
        self._curves.cubic(x0, y0, (*first, *second, x, y))
        self._x, self._y, self._handle, self._handle_of = x, y, (x1, y1), "Q"

    def _arc(self, rx: float, ry: float, rotation: float, large: float, sweep: float, x: float, y: float) -> None:
        cubics = arc_to_cubics(self._x, self._y, rx, ry, rotation, large > 0.5, sweep > 0.5, x, y)
        if cubics:
            self._curves.cubics(self._x, self._y, cubics, (x, y))
            self._x, self._y, self._handle_of = x, y, ""
        else:
            self._straight(x, y)

    def _reflected(self, kind: str) -> Handle:
        if self._handle_of != kind or self._handle is None:
            return (self._x, self._y)
        return (2.0 * self._x - self._handle[0], 2.0 * self._y - self._handle[1])
