"""The routines that are loaded without the rest of their package are those of the package."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
from scipy.linalg import lapack as whole

from planner import lapack


def test_alone_or_with_the_package_they_give_the_same() -> None:
    band = np.ones((3, 9)) + np.outer([9.0, 0.0, 0.0], np.ones(9))
    right = np.arange(9.0)
    factor, failed = lapack.dpbtrf(band, lower=1)
    assert failed == 0
    np.testing.assert_array_equal(factor, whole.dpbtrf(band, lower=1)[0])
    np.testing.assert_array_equal(lapack.dpbtrs(factor, right, lower=1)[0], whole.dpbtrs(factor, right, lower=1)[0])
    rows = np.vstack((np.zeros((2, 9)), np.ones((2, 9)), np.full((1, 9), 7.0), np.ones((2, 9))))
    np.testing.assert_array_equal(lapack.dgbsv(2, 2, rows, right)[2], whole.dgbsv(2, 2, rows, right)[2])


def test_the_package_can_follow_in_the_same_process_and_is_not_loaded_before() -> None:
    asked = (
        "import sys, numpy; from planner import lapack; assert 'scipy' not in sys.modules;"
        "from scipy.linalg import solve_banded, lapack as whole;"
        "print(whole.dpbtrf(numpy.ones((1, 2)), lower=1)[1] + lapack.dpbtrf(numpy.ones((1, 2)), lower=1)[1],"
        " solve_banded((0, 0), numpy.full((1, 2), 2.0), numpy.ones(2)).sum())"
    )
    told = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    assert told.stdout.split() == ["0", "1.0"], told.stderr
