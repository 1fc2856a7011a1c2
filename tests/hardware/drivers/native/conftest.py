from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.hardware.emulator.emulator import Build, Emulator, Faults, LockStep, build, in_lock_step, on_pty


@pytest.fixture(scope="session")
def built(tmp_path_factory: pytest.TempPathFactory) -> Build:
    return build(tmp_path_factory.mktemp("firmware"))


@pytest.fixture
def lock_step(built: Build, tmp_path: Path) -> Iterator[Callable[[Faults], LockStep]]:
    """Starts the controller with a line of these faults."""
    started: list[LockStep] = []

    def start(faults: Faults) -> LockStep:
        started.append(in_lock_step(built, tmp_path, faults))
        return started[-1]

    yield start
    for one in started:
        one.emulator.end()


@pytest.fixture
def controller(lock_step: Callable[[Faults], LockStep]) -> LockStep:
    """The firmware on a clean line."""
    return lock_step(Faults())


@pytest.fixture
def pty(built: Build, tmp_path: Path) -> Iterator[tuple[Emulator, Path]]:
    """The firmware in real time, and the device name of its line."""
    emulator, device = on_pty(built, tmp_path)
    yield emulator, device
    emulator.end()
