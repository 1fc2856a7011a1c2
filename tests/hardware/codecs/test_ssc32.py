"""Lines of the SSC-32, by its user guide."""

from __future__ import annotations

import pytest

from hardware.codecs import ssc32


def test_examples_of_the_user_guide() -> None:
    assert ssc32.move([(5, 1600.0), (10, 750.0)], 2.5) == b"#5P1600#10P750T2500\r"
    assert ssc32.move([(17, 1499.6)], 0.02) == b"#17P1500T20\r"
    assert ssc32.stop([0, 31]) == b"STOP0\rSTOP31\r"


@pytest.mark.parametrize(("duration_s", "ms"), [(0.0, 1), (0.0004, 1), (0.0106, 11), (70.0, 65535)])
def test_times_are_whole_milliseconds_that_the_board_takes(duration_s: float, ms: int) -> None:
    assert ssc32.move([(0, 1500.0)], duration_s) == b"#0P1500T%d\r" % ms
