"""Random drawings as SVG text, with the points of their outlines found by plain formulas."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import cos, pi, radians, sin, tan
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from planner.arrays import FloatArray

_T = np.linspace(0.0, 1.0, 600)[:, None]


@dataclass(frozen=True, eq=False, slots=True)
class Shape:
    """An SVG element and dense points (n, 2) of its outline in the coordinates of the outermost `svg`."""

    element: str
    points: FloatArray


def svg_of(shapes: list[Shape], attributes: str = 'viewBox="0 0 100 100"') -> str:
    return lines_svg("".join(shape.element for shape in shapes), attributes)


def lines_svg(body: str, attributes: str) -> str:
    """An SVG of lines: nothing in it is filled, and lines of no length are dots."""
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {attributes} fill="none" stroke="black" stroke-linecap="round">'
    return f"{head}{body}</svg>"


def polyline(*vertices: tuple[float, float]) -> Shape:
    line = np.array(vertices)
    dense = [a + (b - a) * _T for a, b in pairwise(line)]
    return Shape(f'<polyline points="{" ".join(f"{x},{y}" for x, y in vertices)}"/>', np.concatenate(dense))


def bezier(*controls: tuple[float, float]) -> Shape:
    a, b, c, d = (np.array(control) for control in controls)
    text = " ".join(f"{x},{y}" for x, y in controls[1:])
    return Shape(
        f'<path d="M{controls[0][0]},{controls[0][1]} C{text}"/>',
        (1 - _T) ** 3 * a + 3 * (1 - _T) ** 2 * _T * b + 3 * (1 - _T) * _T**2 * c + _T**3 * d,
    )


def ellipse(x: float, y: float, rx: float, ry: float) -> Shape:
    around = 2 * pi * _T
    return Shape(
        f'<ellipse cx="{x}" cy="{y}" rx="{rx}" ry="{ry}"/>',
        np.column_stack((x + rx * np.cos(around), y + ry * np.sin(around))),
    )


def tap(x: float, y: float) -> Shape:
    return Shape(f'<path d="M{x},{y} z"/>', np.array([[x, y]]))


def transformed(shape: Shape, text: str, matrix: FloatArray) -> Shape:
    """The shape in a group: matrix (2, 3) is what the text of its transform says."""
    return Shape(f'<g transform="{text}">{shape.element}</g>', shape.points @ matrix[:, :2].T + matrix[:, 2])


_coordinate = st.integers(0, 1000).map(lambda value: value / 10)
_place = st.tuples(_coordinate, _coordinate)
_size = st.integers(5, 400).map(lambda value: value / 10)


@st.composite
def _transforms(draw: st.DrawFn) -> tuple[str, FloatArray]:
    amount = draw(st.integers(-60, 60))
    angle = radians(amount)
    return draw(
        st.sampled_from(
            [
                (f"rotate({amount})", np.array([[cos(angle), -sin(angle), 0], [sin(angle), cos(angle), 0]])),
                (f"skewX({amount})", np.array([[1, tan(angle), 0], [0, 1, 0]])),
                (
                    f"translate({amount} 7) scale(-1 {1 + abs(amount) / 40})",
                    np.array([[-1, 0, amount], [0, 1 + abs(amount) / 40, 7]]),
                ),
            ]
        )
    )


@st.composite
def shapes_made(draw: st.DrawFn) -> Shape:
    shape = draw(
        st.one_of(
            st.lists(_place, min_size=2, max_size=6).map(lambda vertices: polyline(*vertices)),
            st.tuples(_place, _place, _place, _place).map(lambda controls: bezier(*controls)),
            st.tuples(_coordinate, _coordinate, _size, _size).map(lambda numbers: ellipse(*numbers)),
            _place.map(lambda place: tap(*place)),
        )
    )
    return transformed(shape, *draw(_transforms())) if draw(st.booleans()) else shape


drawings_made = st.lists(shapes_made(), min_size=1, max_size=4).filter(
    lambda shapes: float(np.ptp(np.concatenate([shape.points for shape in shapes]), axis=0).max()) > 1
)


def scribbles(file: Path, count: int, points: int) -> Path:
    """Wavy lines and taps of 20 mm by 20 mm, some thousands of points."""
    random = np.random.default_rng(4)
    paths = []
    for _ in range(count):
        line = random.uniform(20, 80, 2) + np.cumsum(random.normal(0, 0.4, (points, 2)), axis=0)
        paths.append('<polyline points="' + " ".join(f"{x:.3f},{y:.3f}" for x, y in line) + '"/>')
    body = "".join(paths) + "".join(tap(10 * x, 5).element for x in range(1, 9))
    file.write_text(svg_of([]).replace("</svg>", body + "</svg>"), encoding="utf-8")
    return file
