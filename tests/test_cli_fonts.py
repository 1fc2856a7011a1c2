"""`plan fonts`."""

from __future__ import annotations

from pathlib import Path

import pytest

from planner.cli import main


def test_the_faces_are_listed_with_what_they_have_and_their_licences(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["fonts"]) == 0
    printed = capsys.readouterr().out
    for word in ("sans: Relief SingleLine", "serif: EMS Nixish", "script: EMS Allure", "mono: NewStroke"):
        assert word in printed
    assert "SIL OFL 1.1" in printed and "CC0 1.0" in printed and "Cyrillic 96 of 96" in printed


@pytest.mark.parametrize("suffix", ["png", "pdf"])
def test_the_faces_are_drawn(tmp_path: Path, suffix: str) -> None:
    target = tmp_path / f"fonts.{suffix}"
    assert main(["fonts", "-o", str(target), "Grüße"]) == 0
    assert target.stat().st_size > 2000


def test_all_pangrams_are_drawn(tmp_path: Path) -> None:
    target = tmp_path / "fonts.svg"
    assert main(["fonts", "-o", str(target)]) == 0
    assert target.read_text(encoding="utf-8").count("<path") >= 20


def test_what_no_face_has_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["fonts", "-o", str(tmp_path / "a.svg"), "a中"]) == 0
    assert "plan: warning: no face has U+4E2D" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [["text"], ["-o", "x.txt"], ["-o", "x.png", " "], ["-o", "nowhere/x.png"]])
def test_what_means_nothing_is_refused(
    tmp_path: Path, arguments: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["fonts", *arguments]) == 2
    assert capsys.readouterr().err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []
