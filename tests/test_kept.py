"""What is kept on disk is never wrong, never needed, and never in the way."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import planner
from planner import kept as module
from planner.cli import main
from planner.kept import FOLDER_VARIABLE, OFF, Arrays, kept
from tests.drawn_shapes import lines_svg

DRAWING = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 60" width="60mm" height="60mm">'
    '<path d="M5 5 L55 20 C 30 60 20 0 5 50" fill="none" stroke="black"/></svg>'
)
ANSWER = {"radii": np.array([1.0, 2.0, np.pi]), "map": np.arange(12.0).reshape(4, 3)}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "kept"))
    return tmp_path / "kept"


class Asked:
    """An answer, and how often it was worked out."""

    def __init__(self) -> None:
        self.times = 0

    def __call__(self) -> Arrays:
        self.times += 1
        return ANSWER


def same(one: Arrays, other: Arrays) -> bool:
    return one.keys() == other.keys() and all(np.array_equal(one[name], other[name]) for name in one)


def test_a_question_is_answered_once_and_to_the_last_bit(folder: Path) -> None:
    asked = Asked()
    assert same(kept("which?", asked), ANSWER) and same(kept("which?", asked), ANSWER)
    assert asked.times == 1
    kept("which else?", asked)
    assert asked.times == 2 and len(list(folder.iterdir())) == 2


def test_another_version_of_this_package_asks_anew(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = Asked()
    kept("which?", asked)
    monkeypatch.setattr(module, "_answering", lambda: "another one")
    kept("which?", asked)
    assert asked.times == 2


def test_each_module_of_this_package_answers_as_it_lies_on_disk(tmp_path: Path) -> None:
    root = Path(module.__file__).parent
    told = list(module._modules(str(root)))
    assert sorted(line.rsplit(" ", 2)[0] for line in told) == sorted(map(str, root.rglob("*.py")))
    (tmp_path / "within").mkdir()
    (tmp_path / "within" / "one.py").write_text("old")
    before = list(module._modules(str(tmp_path)))
    (tmp_path / "within" / "one.py").write_text("newer")
    assert len(before) == 1 and list(module._modules(str(tmp_path))) != before


def test_libraries_are_told_by_their_versions_wherever_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("numpy", "casadi", "pydantic"):
        assert version(name) in module._version(name)
    monkeypatch.setattr(module, "find_spec", lambda name: None)  # no folder beside it
    assert module._version("numpy") == f"numpy {version('numpy')}"


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_a_damaged_file_is_as_good_as_none(folder: Path, data: st.DataObject) -> None:
    kept("which?", Asked())
    (file,) = folder.iterdir()
    whole = file.read_bytes()
    place = data.draw(st.integers(0, len(whole) - 1))
    damaged = data.draw(
        st.sampled_from(
            (b"", whole[:place], whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :], b"nothing of ours")
        )
    )
    file.write_bytes(damaged)
    assert same(kept("which?", Asked()), ANSWER)


@pytest.mark.parametrize("off", [True, False])
def test_where_nothing_can_be_kept_nothing_is_missed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, off: bool
) -> None:
    in_the_way = tmp_path / "file"
    in_the_way.write_text("not a folder")
    monkeypatch.setenv(FOLDER_VARIABLE, OFF if off else str(in_the_way))
    asked = Asked()
    assert same(kept("which?", asked), ANSWER) and same(kept("which?", asked), ANSWER)
    assert asked.times == 2
    assert list(tmp_path.iterdir()) == [in_the_way]


def test_only_so_many_files_are_kept(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_MOST_FILES", 3)
    for number in range(6):
        kept(f"number {number}?", Asked())
        for age, file in enumerate(sorted(folder.iterdir(), key=lambda file: file.stat().st_mtime_ns)):
            os.utime(file, (age, age))
    assert len(list(folder.iterdir())) == 3
    last = Asked()
    kept("number 5?", last)
    assert last.times == 0


def test_what_is_asked_for_again_and_again_stays(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_MOST_FILES", 3)
    often = Asked()
    for number in range(6):
        kept("often?", often)
        kept(f"number {number}?", Asked())
        for file in folder.iterdir():
            age = file.stat().st_mtime - 100
            os.utime(file, (age, age))
    assert often.times == 1


def test_plans_are_the_same_with_and_without_what_is_kept(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("d.svg").write_text(DRAWING)
    for name, more in (("none.csv", ("--no-cache",)), ("first.csv", ()), ("second.csv", ())):
        assert main(["d.svg", "-o", name, "--quiet", "--arm", "scara", *more]) == 0
        assert folder.exists() is (name != "none.csv")
    written = {Path(name).read_bytes() for name in ("none.csv", "first.csv", "second.csv")}
    assert len(written) == 1


def test_what_is_to_keep_nothing_keeps_nothing(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("planner.report.pictures.write_figure", lambda *_: None)  # of no use to what is kept
    drawing = tmp_path / "d.svg"
    drawing.write_text(lines_svg('<path d="M20 30h9"/>', 'viewBox="0 0 60 60"'))
    planner.plan(drawing, "scara", cache=False)
    assert not folder.exists()
    report = ["--arm", "scara", "--report", str(tmp_path / "report")]
    assert main([str(drawing), "-o", str(tmp_path / "d.csv"), "--quiet", "--no-cache", *report]) == 0
    assert not folder.exists()


def test_the_second_plan_of_an_arm_computes_no_map(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "d.svg").write_text(DRAWING)
    script = (
        "import sys; from planner.redundancy import arm_model; from planner.cli import main\n"
        "assert arm_model.ring_branches\n"
        "if sys.argv[1] == 'second': arm_model.ring_branches = None\n"
        "sys.exit(main(['d.svg', '-o', sys.argv[1] + '.csv', '--quiet', '--arm', 'scara']))"
    )
    for name in ("first", "second"):
        subprocess.run([sys.executable, "-c", script, name], cwd=tmp_path, check=True, env={**os.environ})
    assert (tmp_path / "first.csv").read_bytes() == (tmp_path / "second.csv").read_bytes()
