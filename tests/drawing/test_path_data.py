"""Path data: the grammar, errors that end a path, and the same path written in other ways."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.drawing import path_data
from planner.drawing.path_data import (
    TooManyCurves,
    has_foreign_characters,
    has_unusable_numbers,
    parse_path,
    parse_points,
)


def corners(data: str) -> list[list[tuple[float, float]]]:
    """The start of each subpath and the ends of its segments, those of arcs once."""
    return [
        [tuple(path.beziers[0, 0].tolist()), *map(tuple, path.beziers[path.is_vertex, 3].round(9).tolist())]
        for path in parse_path(data)
    ]


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        ("", []),
        ("L1 2 3 4", []),
        (",M1 2L3 4", []),
        ("M1 2L3 4", [[(1, 2), (3, 4)]]),
        ("M1 2 3 4 5", [[(1, 2), (3, 4)]]),
        ("m1 2 3 4h1v-1H0V0", [[(1, 2), (4, 6), (5, 6), (5, 5), (0, 5), (0, 0)]]),
        ("M1 2L3 4 M5 6", [[(1, 2), (3, 4)], [(5, 6)]]),
        ("M1 2M3 4M5 6L7 8", [[(1, 2)], [(3, 4)], [(5, 6), (7, 8)]]),
        ("M1 2L3 2 3 4z", [[(1, 2), (3, 2), (3, 4), (1, 2)]]),
        ("M1 2L3 2 3 4zl1 1", [[(1, 2), (3, 2), (3, 4), (1, 2)], [(1, 2), (2, 3)]]),
        ("M1 2L3 2zz", [[(1, 2), (3, 2), (1, 2), (1, 2)]]),
        ("M1 2z", [[(1, 2), (1, 2)]]),
        ("M L1 2", []),
        ("M1 2L M3 4L5 6", [[(1, 2)]]),
        ("M1 2L3 4M L5 6", [[(1, 2), (3, 4)]]),
        ("M1 2L3 4L5", [[(1, 2), (3, 4)]]),
        ("M1 2L30 40L50", [[(1, 2), (30, 40)]]),
        ("M1 2L3 4,,5 6", [[(1, 2), (3, 4)]]),
        ("M1 2L3 4 x L5 6", [[(1, 2), (3, 4)]]),
        ("M1 2L3 4e", [[(1, 2), (3, 4)]]),
        ("M.5.5-1e-1-2.5", [[(0.5, 0.5), (-0.1, -2.5)]]),
        ("M0 0a1 1 0 01.5.5", [[(0, 0), (0.5, 0.5)]]),
        ("M0 0a1 1 0 1110 0l1 1", [[(0, 0), (10, 0), (11, 1)]]),
        ("M1 2A1 1 0 2 0 5 5", [[(1, 2)]]),
        ("M1 2A0 5 0 0 0 3 4", [[(1, 2), (3, 4)]]),
        ("M1 2A1 1 0 0 0 1 2L3 4", [[(1, 2), (1, 2), (3, 4)]]),
    ],
)
def test_grammar(data: str, expected: list[list[tuple[float, float]]]) -> None:
    assert corners(data) == expected


def test_smooth_curves_go_on_from_curves_of_their_kind_alone() -> None:
    (path,) = parse_path("M0 0C1 2 3 4 5 4S9 0 9 4T11 4Q12 6 13 4T15 4")
    assert path.beziers[1, 1].tolist() == [7, 4]
    assert path.beziers[2, :2].tolist() == [[9, 4], [9, 4]]
    assert np.allclose(path.beziers[4, 1], [13 + (14 - 13) / 1.5, 4 + (2 - 4) / 1.5])


_COORDINATES = st.integers(-50, 50)
_SEGMENTS = st.lists(
    st.one_of(
        st.tuples(st.just("L"), _COORDINATES, _COORDINATES),
        st.tuples(st.just("H"), _COORDINATES),
        st.tuples(st.just("V"), _COORDINATES),
        st.tuples(st.just("C"), *[_COORDINATES] * 6),
        st.tuples(st.just("Q"), *[_COORDINATES] * 4),
        st.tuples(
            st.just("A"),
            st.integers(1, 50),
            st.integers(1, 50),
            st.just(0),
            st.just(1),
            st.just(0),
            *[_COORDINATES] * 2,
        ),
        st.tuples(st.just("M"), _COORDINATES, _COORDINATES),
        st.tuples(st.just("Z")),
    ),
    max_size=12,
)


@given(_SEGMENTS)
def test_relative_commands_and_separators_make_no_difference(segments: list[tuple[object, ...]]) -> None:
    absolute = "M3 4" + "".join(str(letter) + " ".join(map(str, values)) for letter, *values in segments)
    spaced = absolute.replace(" ", " , \n")
    expected = parse_path(absolute)
    relative, x, y, start = "m3,4", 3, 4, (3, 4)
    for letter, *values in segments:
        moved = [int(value) for value in values]
        first = 5 if letter == "A" else 0
        for at in range(first, len(moved)):
            is_x = letter == "H" or (letter != "V" and (at - first) % 2 == 0)
            moved[at] -= x if is_x else y
        relative += str(letter).lower() + ",".join(map(str, moved))
        if letter == "Z":
            x, y = start
        elif letter == "H":
            x = values[0]
        elif letter == "V":
            y = values[0]
        else:
            x, y = values[-2:]
        start = (x, y) if letter == "M" else start
    for other in (parse_path(spaced), parse_path(relative)):
        assert len(other) == len(expected)
        for one, two in zip(expected, other, strict=True):
            assert one.is_closed == two.is_closed and np.array_equal(one.is_vertex, two.is_vertex)
            assert np.allclose(one.beziers, two.beziers, atol=1e-9)


@given(_SEGMENTS)
def test_curves_follow_each_other_and_closed_subpaths_end_where_they_began(segments: list[tuple[object, ...]]) -> None:
    data = "M3 4" + "".join(str(letter) + " ".join(map(str, values)) for letter, *values in segments)
    for path in parse_path(data):
        assert np.array_equal(path.beziers[1:, 0], path.beziers[:-1, 3])
        assert not path.is_closed or np.array_equal(path.beziers[0, 0], path.beziers[-1, 3])
        assert path.is_vertex[-1] or len(path.beziers) == 1


def test_sums_of_steps_that_come_back_are_closed_without_a_last_step() -> None:
    (path,) = parse_path("m.1.1" + "l.1.2" * 3 + "l-.3-.6z")
    assert np.array_equal(path.beziers[-1], np.full((4, 2), 0.1))


def test_a_path_of_too_many_curves_is_refused_before_it_takes_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(path_data, "CURVE_LIMIT", 50)
    for data in ("M0 0" + "a1 1 0 1 1 1 1" * 50, "M0 0" + "l1 1" * 60):
        with pytest.raises(TooManyCurves):
            parse_path(data)


@pytest.mark.parametrize(
    ("text", "expected"),
    [("1,2 3,4", [[1, 2], [3, 4]]), ("1-2 30 40 5", [[1, -2], [30, 40]]), ("1 2 a 3 4", [[1, 2]]), ("", [])],
)
def test_points(text: str, expected: list[list[float]]) -> None:
    assert parse_points(text).tolist() == expected


@pytest.mark.parametrize(
    ("data", "unusable"),
    [
        ("M1e300 0", True),
        ("M0 0L1234567890 1", True),
        ("M1e9 1", True),
        ("M1e+12 1", True),
        ("M1e8 0", False),
        ("M0.12345678901234 1", False),
        ("M.12345678901234 1e-300", False),
        ("M000000000012 1", False),
    ],
)
def test_unusable_numbers(data: str, unusable: bool) -> None:
    assert has_unusable_numbers(data) is unusable


def test_foreign_characters() -> None:
    assert has_foreign_characters("M1 NaN")
    assert not has_foreign_characters("M1,2e-5\n\tA1 1 0 01-5.5z")
