"""The soak of benchmarks/soak in small: files that are a little wrong are used, or refused in one sentence."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import pytest

from tests.drawn_shapes import lines_svg

SOAK = Path(__file__).parents[1] / "benchmarks" / "soak"
DRAWINGS = (
    '<rect x="5" y="5" width="9" height="6" rx="2"/><circle cx="20" cy="9" r="4"/>',
    '<defs><g id="a"><path d="M2 2l9 5-9 5"/><path d="M1 1h0"/></g></defs><use href="#a" x="9"/><use href="#a"/>',
    '<clipPath id="a"><path d="M0 0h9v9z"/></clipPath><g transform="rotate(9) scale(2 1)" clip-path="url(#a)">'
    '<path d="M1 1A4 2 7 1 0 9 9S5 5 1 9" stroke="red" stroke-dasharray="2 1"/></g>',
)


@pytest.fixture
def soak(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> ModuleType:
    monkeypatch.syspath_prepend(str(SOAK))
    (tmp_path / "desk").mkdir()
    monkeypatch.chdir(tmp_path / "desk")
    return importlib.import_module("guarded")


def test_mutated_drawings(soak: ModuleType, tmp_path: Path) -> None:
    drawings = importlib.import_module("drawings")
    for index, body in enumerate(DRAWINGS):
        (tmp_path / f"{index}.svg").write_text(lines_svg(f"{body}", 'viewBox="0 0 30 20"'))
    kinds = [drawings.attempt((tmp_path,), 7, item, tmp_path / "desk") for item in range(-1, 30)]
    assert [kind for kind in kinds if not kind[0].startswith("fine")] == []
    assert len(set(kinds)) > 2  # some are drawn, some are refused


def test_mutated_trajectories(soak: ModuleType, tmp_path: Path) -> None:
    trajectories = importlib.import_module("trajectories")
    trajectories.seeds(tmp_path)
    kinds = [trajectories.attempt(tmp_path, 7, item, tmp_path / "desk") for item in range(-1, 24)]
    assert [kind for kind in kinds if not kind[0].startswith("fine")] == []
    assert len({kind for kind, _ in kinds}) == 3  # passes, fails the check, refused


def test_a_process_that_takes_too_much_is_ended_and_told(soak: ModuleType, tmp_path: Path) -> None:
    found = list(soak.outcomes(_too_much, range(3), tmp_path, 1))
    assert [outcome.kind for outcome in found] == ["fine: small", "over 1000 MB", "fine: small"]


def _too_much(item: int, desk: Path) -> tuple[str, str]:
    if item == 1:
        block = bytearray(1_200_000_000)
        while block:
            block[::4096] = block[::4096]
    return "fine: small", ""
