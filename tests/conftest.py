"""What all tests share: how fast a machine is says nothing of whether a law holds, and the arms that laws are tried
on."""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from planner.arms.arm import Arm
from planner.kept import FOLDER_VARIABLE
from tests.arms.chains import DRAWING_ARMS, load_once

settings.register_profile("laws", deadline=None)
settings.load_profile("laws")


@pytest.hookimpl(wrapper=True)
def pytest_sessionstart() -> Iterator[None]:
    """All processes of a session share what they compute of arms, and nothing with other sessions."""
    if "PYTEST_XDIST_WORKER" not in os.environ:
        os.environ[FOLDER_VARIABLE] = tempfile.mkdtemp(prefix="kept-")
    yield
    if sys.dont_write_bytecode:  # not beside the sources: else hundreds of short processes compile all of them anew
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
        os.environ["PYTHONPYCACHEPREFIX"] = str(Path(os.environ[FOLDER_VARIABLE], "bytecode"))


def pytest_sessionfinish() -> None:
    if "PYTEST_XDIST_WORKER" not in os.environ:
        shutil.rmtree(os.environ.pop(FOLDER_VARIABLE), ignore_errors=True)


@pytest.fixture(params=DRAWING_ARMS)
def arm(request: pytest.FixtureRequest) -> Arm:
    """Each drawing arm in turn, where a module names no other."""
    return load_once(request.param)
