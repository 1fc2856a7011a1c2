"""An arm whose file an earlier process has checked is the arm of that file, and no file goes unchecked."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import is_dataclass, replace
from enum import Enum
from pathlib import Path
from typing import get_args, get_type_hints

import numpy as np
import pytest

from planner.arms import arm_file, kept_arm
from planner.arms.accuracy import Accuracy
from planner.arms.arm import Arm
from planner.arms.arm_file import arms_folder, known_arms, load_arm, read_arm_file
from planner.arms.kept_arm import arm_as_json, arm_of_json
from planner.errors import ArmFileError
from planner.kept import FOLDER_VARIABLE
from tests.arms.chains import load_once
from tests.arms.unusual_arms import PLANE_ARMS

CALIBRATED = replace(
    load_once("drawing_arm"), name="calibrated", accuracy=Accuracy(30, 0.1, np.pi / 10, (1e-3, 0.1 + 0.2, 0.0))
)
ARMS = [*map(load_once, known_arms()), *PLANE_ARMS.values(), CALIBRATED]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "kept"))
    return tmp_path / "kept"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    copy = tmp_path / "mine.toml"
    copy.write_bytes((arms_folder() / "drawing_arm.toml").read_bytes())
    return copy


@pytest.fixture
def checked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The texts that were checked."""
    texts: list[str] = []
    check: Callable[[str, str], Arm] = arm_file.arm_of_text

    def noted(text: str, source: str) -> Arm:
        texts.append(text)
        return check(text, source)

    monkeypatch.setattr(arm_file, "arm_of_text", noted)
    return texts


@pytest.mark.parametrize("arm", ARMS, ids=lambda arm: arm.name)
def test_an_arm_comes_back_to_the_last_bit(arm: Arm) -> None:
    back = arm_of_json(arm_as_json(arm))
    assert back == arm and repr(back) == repr(arm)


def test_there_is_a_name_for_all_that_an_arm_is_made_of() -> None:
    assert set(made_of(Arm)) == set(kept_arm._TYPES.values())


def made_of(hint: object) -> Iterator[type]:
    """The types of values within what is annotated so."""
    if isinstance(hint, type) and (is_dataclass(hint) or issubclass(hint, Enum)):
        yield hint
        for one in get_type_hints(hint).values() if is_dataclass(hint) else ():
            yield from made_of(one)
    for one in get_args(hint):
        yield from made_of(one)


def test_a_file_is_checked_once_for_what_it_says(folder: Path, file: Path, checked: list[str]) -> None:
    first = load_arm(str(file))
    again = load_arm(str(file))
    assert first == again == read_arm_file(file)
    assert len(checked) == 2  # the other by read_arm_file, which keeps nothing
    file.write_text(file.read_text().replace('name = "drawing_arm"', 'name = "mine"'))
    assert load_arm(str(file)).name == "mine" and len(checked) == 3
    assert load_arm(str(file), cache=False).name == "mine" and len(checked) == 4


def test_a_file_with_faults_is_told_so_each_time(folder: Path, file: Path) -> None:
    file.write_text(file.read_text().replace("lift_mm", "height_of_lift_mm"))
    for _ in range(2):
        with pytest.raises(ArmFileError, match=r"pen\.lift_mm: missing"):
            load_arm(str(file))
    assert not folder.exists()
