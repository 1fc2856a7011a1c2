from __future__ import annotations

import pytest

from planner.arms.arm import Arm
from tests.arms.chains import DRAWING_ARMS, load_once


@pytest.fixture(params=DRAWING_ARMS)
def arm(request: pytest.FixtureRequest) -> Arm:
    """Each drawing arm in turn."""
    return load_once(request.param)
