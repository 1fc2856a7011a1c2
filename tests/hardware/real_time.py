"""Tests in which a host and a controller meet in real time, which a shared machine may keep from its cores.

They are few, since most of what is tested is not time: there a bench or a controller in lock step stands for both. How
often each of them had to be tried anew is what `pytest --reruns` says:

    for k in $(seq 20); do pytest -n 2 -r R tests/hardware/drivers/native; done | grep -c ^RERUN
"""

from __future__ import annotations

import pytest


def in_real_time(reason: str) -> pytest.MarkDecorator:
    """Tried twice more if it fails; `reason`: what a busy machine does to it that is no fault."""
    assert reason
    return pytest.mark.flaky(reruns=2)
