"""What all tests share: how fast a machine is says nothing of whether a law holds, and the arms that laws are tried
on."""

from __future__ import annotations

import pytest
from hypothesis import settings

from planner.arms.arm import Arm
from tests.arms.chains import DRAWING_ARMS, load_once

settings.register_profile("laws", deadline=None)
settings.load_profile("laws")


@pytest.fixture(params=DRAWING_ARMS)
def arm(request: pytest.FixtureRequest) -> Arm:
    """Each drawing arm in turn, where a module names no other."""
    return load_once(request.param)
