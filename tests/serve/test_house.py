"""What the server keeps, where there is too much of it."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path

import pytest

from planner.serve import house as houses
from planner.serve.child import finished
from planner.serve.house import House
from planner.serve.run import Playable
from planner.serve.store import Store, safe_name
from tests.serve.served import SQUARE


def test_the_oldest_drawings_make_room_but_not_what_is_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(houses, "MOST_JOBS", 2)

    async def add() -> None:
        house = House(tmp_path)
        try:
            drawn, second = house.add("drawn.svg", SQUARE), house.add("second.svg", SQUARE)
            run = Playable(drawn.id, drawn.name, house.store.of(drawn), "none.csv", lambda how, complete: None)
            house.arm.begin(run, {})
            later = [house.add(f"later{number}.svg", SQUARE) for number in range(3)]
            assert [job.id for job in house.store] == [drawn.id, *(job.id for job in later[1:])]
            assert house.store.of(drawn).exists() and not house.store.of(second).exists()
        finally:
            await house.close()

    asyncio.run(add())


@pytest.mark.parametrize("letter", ["a", "\u00e9", "\u6f22", "\U0001d49c"])
def test_files_beside_a_drawing_can_be_named_after_it(letter: str, tmp_path: Path) -> None:
    name = safe_name(f"{letter * 300}.svg")
    assert name.startswith(letter)
    (tmp_path / f"{Path(name).stem}.csv.sim.journal.lock").touch()


@pytest.mark.parametrize("change", [{"name": "../x.svg"}, {"name": "x.sh"}, {"id": "0123456789abcdef"}, {"state": "?"}])
def test_jobs_that_were_meddled_with_are_passed_over(change: dict[str, str], tmp_path: Path) -> None:
    store = Store(tmp_path)
    job = store.add("square.svg", SQUARE)
    assert [found.id for found in Store(tmp_path)] == [job.id]
    note = store.of(job) / "job.json"
    note.write_text(json.dumps(json.loads(note.read_text()) | change))
    assert not list(Store(tmp_path))


def test_nothing_that_lies_in_a_folder_is_run(tmp_path: Path) -> None:
    (tmp_path / "planner.py").write_text("raise SystemExit(1)")
    assert asyncio.run(finished(["--version"], tmp_path)) is None
