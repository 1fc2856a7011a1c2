"""Sequences of starts, stops and reloads: no stuck state."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given, settings

from tests.serve.sequences import STEPS, follow
from tests.serve.served import Server


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Server, str]]:
    with Server(tmp_path_factory.mktemp("house"), "--demo") as server:
        yield server, server.planned()["id"]


@settings(max_examples=8, deadline=None)
@given(STEPS)
def test_no_sequence_leaves_a_stuck_state(served: tuple[Server, str], steps: list[str]) -> None:
    follow(*served, steps)
