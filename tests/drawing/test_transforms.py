"""Transforms: functions, origins, and errors that cost the whole list."""

from __future__ import annotations

import numpy as np
import pytest

from planner.arrays import FloatArray
from planner.drawing.style.style import Styles
from planner.drawing.transforms import IDENTITY, local_transform
from planner.drawing.xml_tree import read_tree

BOX = (10.0, 20.0, 30.0, 40.0)


def matrix(attributes: str) -> FloatArray:
    """Of an element with these attributes, in a viewport of 200 by 100, with BOX around it."""
    document = read_tree(f'<svg xmlns="http://www.w3.org/2000/svg"><rect {attributes}/></svg>'.encode(), "drawing.svg")
    styles = Styles(document)
    root = styles.of(document.root, styles.root((200.0, 100.0)), (200.0, 100.0))
    style = styles.of(document.root.children[0], root, (200.0, 100.0))
    return local_transform(style, (200.0, 100.0), lambda: BOX)


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ('transform="matrix(1 2 3 4 5 6)"', [[1, 3, 5], [2, 4, 6]]),
        ('transform="translate(1)"', [[1, 0, 1], [0, 1, 0]]),
        ('transform="translate(1,2)scale(3)"', [[3, 0, 1], [0, 3, 2]]),
        ('transform="rotate(90 10 20)"', [[0, -1, 30], [1, 0, 10]]),
        ('transform="rotate(90)"', [[0, -1, 0], [1, 0, 0]]),
        ('transform="skewX(45)"', [[1, 1, 0], [0, 1, 0]]),
        ('transform="skewY(45)"', [[1, 0, 0], [1, 1, 0]]),
        ('style="transform: rotate(.25turn)"', [[0, -1, 0], [1, 0, 0]]),
        ('style="transform: rotate(100grad)"', [[0, -1, 0], [1, 0, 0]]),
        ('style="transform: translate(1in, 10%)"', [[1, 0, 96], [0, 1, 10]]),
        ('style="transform: translateY(5px) scaleX(2)"', [[2, 0, 0], [0, 1, 5]]),
        ('style="transform: matrix3d(1,2,0,0,3,4,0,0,0,0,1,0,5,6,0,1)"', [[1, 3, 5], [2, 4, 6]]),
        ('style="transform: rotate3d(0,0,1,90deg)"', [[0, -1, 0], [1, 0, 0]]),
        ('style="translate: 5px 6px; scale: 2; rotate: 90deg"', [[0, -2, 5], [2, 0, 6]]),
        ('transform="scale(2)" transform-origin="10 20"', [[2, 0, -10], [0, 2, -20]]),
        ('transform="scale(2)" style="transform-origin: right bottom"', [[2, 0, -200], [0, 2, -100]]),
        ('transform="scale(2)" style="transform-origin: center; transform-box: fill-box"', [[2, 0, -25], [0, 2, -40]]),
    ],
)
def test_matrices(attributes: str, expected: list[list[float]]) -> None:
    assert np.allclose(matrix(attributes), expected, atol=1e-12)


@pytest.mark.parametrize(
    "text", ["", "scale(2) nonsense(3)", "scale(2) rotate(", "scale(a)", "matrix(1 2 3)", "scale(2),", "rotate(1 2)"]
)
def test_an_error_anywhere_costs_the_whole_list(text: str) -> None:
    assert np.array_equal(matrix(f'transform="{text}"'), IDENTITY)
