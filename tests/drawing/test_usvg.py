"""The sandbox of the normaliser: nothing outside, bounded work."""

from __future__ import annotations

from pathlib import Path

import pytest

from planner.drawing import usvg
from planner.drawing.usvg import NormalisationFailed, normalise

ROOT = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">'


def test_files_outside_cannot_be_reached(tmp_path: Path) -> None:
    (tmp_path / "other.svg").write_text(f'{ROOT}<path d="M1 2L3 4"/></svg>')
    inside = f'{ROOT}<image width="5" height="5" href="{tmp_path}/other.svg"/><path d="M5 6L7 8"/></svg>'
    written = normalise(inside.encode())
    assert b"M 5 6 L 7 8" in written
    assert b"image" not in written


def test_work_is_bounded_whatever_the_load() -> None:
    levels = "".join(f'<g id="g{i}">' + f'<use href="#g{i - 1}"/>' * 10 + "</g>" for i in range(1, 9))
    with pytest.raises(NormalisationFailed, match="multiply to more work than the limit"):
        normalise(f'{ROOT}<path id="g0" d="M0 0L1 1"/>{levels}</svg>'.encode(), work_limit=100_000_000)


def test_a_normaliser_without_a_disk_cache_works(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    for variable in ("XDG_CACHE_HOME", "HOME"):
        monkeypatch.setenv(variable, str(tmp_path / "file"))
    usvg._module.cache_clear()
    try:
        assert b"M 1 2 L 3 4" in normalise(f'{ROOT}<path d="M1 2L3 4"/></svg>'.encode())
    finally:
        usvg._module.cache_clear()


def test_a_result_that_outgrows_its_drawing_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(usvg, "OUTPUT_LIMIT_BYTES", 200)
    copies = '<use href="#a"/>' * 9
    with pytest.raises(NormalisationFailed, match="larger than the limit"):
        normalise(f'{ROOT}<path id="a" d="M0 0L1 1"/>{copies}</svg>'.encode())
