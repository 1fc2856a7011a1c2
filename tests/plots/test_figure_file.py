"""Pictures become valid files, whole or not at all, and equal pictures equal files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from matplotlib.figure import Figure

from planner.account import account_of
from planner.errors import OutputError, UsageError
from planner.plots.drawing import plot_drawing
from planner.plots.figure_file import picture_format, save_figure
from planner.trajectory import Trajectory


@pytest.fixture(scope="module")
def figure(make_trajectory: Callable[..., Trajectory]) -> Figure:
    trajectory = make_trajectory(n_samples=41, drawing="$5 & <b>\a 花.svg")
    return plot_drawing(trajectory, trajectory.positions, account_of(trajectory, trajectory.positions, 1.0))


@pytest.mark.parametrize(("suffix", "begins"), [(".png", b"\x89PNG\r\n"), (".svg", b"<?xml"), (".PDF", b"%PDF-")])
def test_the_suffix_decides_and_equal_figures_make_equal_files(
    figure: Figure, tmp_path: Path, suffix: str, begins: bytes
) -> None:
    first, second = tmp_path / f"first{suffix}", tmp_path / f"second{suffix}"
    save_figure(figure, first)
    save_figure(figure, second)
    assert first.read_bytes().startswith(begins)
    assert first.read_bytes() == second.read_bytes()
    assert sorted(tmp_path.iterdir()) == [first, second]


def test_an_svg_is_well_formed_whatever_the_drawing_is_called(figure: Figure, tmp_path: Path) -> None:
    save_figure(figure, tmp_path / "picture.svg")
    assert ET.parse(tmp_path / "picture.svg").getroot().tag == "{http://www.w3.org/2000/svg}svg"


@pytest.mark.parametrize("name", ["picture.jpg", "picture", "picture.svg.gz"])
def test_another_suffix_is_refused_naming_those_that_work(figure: Figure, tmp_path: Path, name: str) -> None:
    with pytest.raises(UsageError, match=r"\.png, \.svg, \.pdf"):
        save_figure(figure, tmp_path / name)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(UsageError):
        picture_format(tmp_path / name)


def test_a_missing_folder_is_an_output_error(figure: Figure, tmp_path: Path) -> None:
    with pytest.raises(OutputError, match="no folder"):
        save_figure(figure, tmp_path / "nowhere" / "picture.png")


def test_nothing_is_left_behind_when_saving_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "picture.png"
    target.write_bytes(b"the picture of before")

    def disk_full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    broken = Figure()
    monkeypatch.setattr(broken, "savefig", disk_full)
    with pytest.raises(OutputError, match="No space left"):
        save_figure(broken, target)
    assert list(tmp_path.iterdir()) == [target]
    assert target.read_bytes() == b"the picture of before"
