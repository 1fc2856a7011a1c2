"""`marks.csv`: what is written is read, and what is damaged is named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.error_model.sheet.layout import sheet_for
from planner.error_model.sheet.marks import Mark, MarksFileError, TouchDown, read_marks, write_marks
from planner.error_model.sheet.modes import with_modes

places = st.tuples(st.floats(20, 120), st.floats(-80, 80))
contacts = st.none() | st.builds(
    lambda start, length, slope: TouchDown(start, (start[0] + length, start[1]), slope),
    places,
    st.floats(1, 12),
    st.sampled_from([0.25, 0.7, 1.0]),
)


@given(st.lists(st.tuples(places, contacts), min_size=1, max_size=8))
def test_what_is_written_is_read_and_means_the_same_sheet(
    tmp_path_factory: pytest.TempPathFactory, rows: list[tuple[tuple[float, float], TouchDown | None]]
) -> None:
    marks = [Mark(k, k / 4, place, contact) for k, (place, contact) in enumerate(rows)]
    marks = with_modes(marks, np.random.default_rng(0).normal(0, 3, (20, len(marks), 2)))
    file = tmp_path_factory.mktemp("marks") / "marks.csv"
    write_marks(file, marks)
    assert list(read_marks(file)) == marks
    assert sheet_for(read_marks(file)).tag_ids == sheet_for(marks).tag_ids


def test_columns_of_others_are_passed_over_and_touch_downs_may_be_missing(tmp_path: Path) -> None:
    file = tmp_path / "marks.csv"
    file.write_text("note,mark,t_s,x_mm,y_mm\r\nfirst,4,0.5,80,-10\r\n\r\n", encoding="utf-8-sig")
    assert read_marks(file) == (Mark(4, 0.5, (80.0, -10.0)),)


HEADER = "mark,t_s,x_mm,y_mm,touch_x0_mm,touch_y0_mm,touch_x1_mm,touch_y1_mm,touch_slope\n"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no column mark"),
        ("mark,x_mm\n1,2\n", "line 1: no column t_s, y_mm"),
        (HEADER, "no marks"),
        (HEADER + "0,0,far,3\n", "line 2: x_mm 'far' is not a number"),
        (HEADER + "0,0,nan,3\n", "x_mm 'nan' is not a finite number"),
        (HEADER + "0,0,80\n", "y_mm '' is not a number"),
        (HEADER + "0,0,99999,3\n", "no place on a sheet"),
        (HEADER + "0.5,0,80,3\n", "not a whole number"),
        (HEADER + "0,0,80,3\n0,1,90,3\n", "mark 0 stands in it 2 times"),
        (HEADER + "0,0,80,3,80,3,,,\n", "some are empty"),
        (HEADER + "0,0,80,3,80,3,80,3,1\n", "no length"),
        (HEADER + "0,0,80,3,80,3,90,3,0\n", "slope"),
        ("\x00\x01\x02", "no column mark"),
    ],
)
def test_what_is_wrong_is_named(text: str, said: str, tmp_path: Path) -> None:
    file = tmp_path / "marks.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(MarksFileError, match=said):
        read_marks(file)


def test_a_picture_is_no_file_of_marks(tmp_path: Path) -> None:
    file = tmp_path / "marks.csv"
    file.write_bytes(bytes(range(256)) * 4)
    with pytest.raises(MarksFileError, match="no text file of marks"):
        read_marks(file)
    with pytest.raises(MarksFileError, match="cannot be read"):
        read_marks(tmp_path / "none.csv")
