"""A handful of what benchmarks/soak/interruptions.py does by the thousand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.soak.interrupted_host import Kind
from benchmarks.soak.interruptions import Soak, Subject, subject_in
from tests.hardware.emulator.emulator import Build

_KINDS = [Kind.KILL, Kind.KILL_AND_RESET, Kind.DISK]


@pytest.fixture(scope="module")
def subject(tmp_path_factory: pytest.TempPathFactory) -> Subject:
    return subject_in(tmp_path_factory.mktemp("subject"), None)


@pytest.mark.parametrize("kind", _KINDS)
def test_whatever_interrupts_it_nothing_is_lost_and_nothing_drawn_twice(
    built: Build, subject: Subject, tmp_path: Path, kind: Kind
) -> None:
    kinds = [kind, Kind.KILL] if kind is Kind.DISK else [kind]
    soak = Soak(built, subject, tmp_path, np.random.default_rng(5), kinds)
    soak.draw()
    assert soak.wrong == []
    assert soak.struck >= 2
