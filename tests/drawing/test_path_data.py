"""Path data: arcs rewritten, errors ending the path and not losing what stands before them."""

from __future__ import annotations

import pytest

from planner.drawing.path_data import commands, has_foreign_characters, has_unusable_numbers


def without_arcs(data: str) -> str:
    return "".join(commands(data))


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        ("M1 2A0 0 0 0 0 1 2L3 4", "M1.0 2.0L3.0 4.0"),
        ("m1 2h1v1H9V8zl1 1a1 1 0 0 0 0 0", "M1.0 2.0L2.0 2.0L2.0 3.0L9.0 3.0L9.0 8.0ZL2.0 3.0"),
        ("M1 2q1 1 2 0t2 0A1 1 0 0", "M1.0 2.0Q2.0 3.0 3.0 2.0Q4.0 1.0 5.0 2.0"),
        ("M1 2 3 4 5A", "M1.0 2.0L3.0 4.0"),
        ("M1 2L3 4 A1 1 0 2 0 5 5", "M1.0 2.0L3.0 4.0"),
        ("M1 2L3 4 x A1 1 0 1 0 5 5", "M1.0 2.0L3.0 4.0"),
        ("L1 2A1 1 0 0 0 5 5", ""),
        ("A1 1 0 0 0 5 5", ""),
        ("M.5.5-1e-3-2.L0.1.2A1 1 0 0 1", "M0.5 0.5L-0.001 -2.0L0.1 0.2"),
    ],
)
def test_rewriting_stops_at_the_first_error(data: str, expected: str) -> None:
    assert without_arcs(data) == expected


def test_flags_need_no_separators() -> None:
    assert without_arcs("M0 0a1 1 0 1110 0") == without_arcs("M 0,0 A 1,1 0 1,1 10,0")
    assert without_arcs("M0 0a1 1 0 01.5.5") == without_arcs("M0 0A1 1 0 0 1 .5 .5")


def test_paths_without_arcs_are_left_alone() -> None:
    assert without_arcs("M1 2L3 4 nonsense") == "M1 2L3 4 nonsense"


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
