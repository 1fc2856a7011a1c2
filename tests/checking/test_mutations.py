"""Every kind of seeded fault is found in the trajectory of a real plan, and no sound plan is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from planner.arms.arm_file import load_arm
from planner.drawing.svg import read_drawing
from planner.errors import PlannerError
from planner.pipeline import plan
from planner.settings import PlanSettings
from tests.checking.mutations import MUTATIONS
from tests.checking.other_drawings import DRAWING
from tests.checking.scribbles import random_drawing
from tests.checking.sheet import Sheet


def planned(folder: Path, text: str, settings: PlanSettings, decimals: int = 9) -> Sheet:
    drawing_file = folder / "drawing.svg"
    drawing_file.write_text(text)
    trajectory = plan(drawing_file, settings, lambda *_: None).trajectory
    return Sheet.of(trajectory, load_arm(settings.arm), read_drawing(drawing_file), decimals)


@pytest.fixture(scope="module")
def sheet(tmp_path_factory: pytest.TempPathFactory) -> Sheet:
    """Small, so that it takes little time to check."""
    return planned(tmp_path_factory.mktemp("sound"), DRAWING, PlanSettings(margin_mm=30.0))


def test_the_unspoilt_trajectory_passes(sheet: Sheet, tmp_path: Path) -> None:
    assert not sheet.found(tmp_path / "traj.csv")


@pytest.mark.parametrize("kind", MUTATIONS)
def test_a_seeded_fault_is_found(kind: str, sheet: Sheet, tmp_path: Path) -> None:
    spoilt = MUTATIONS[kind](sheet)
    assert spoilt is not None
    assert spoilt.found(tmp_path / "traj.csv")


@pytest.mark.parametrize("seed", range(8))
def test_a_sound_trajectory_of_a_random_drawing_passes(seed: int, tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    settings = PlanSettings(
        arm=str(rng.choice(["drawing_arm", "scara"])),
        rate_hz=float(rng.choice([100.0, 250.0])),
        rotate_deg=float(rng.choice([0.0, 30.0])),
        skip_unreachable=bool(seed % 2),
        fit=seed % 4 != 3,
    )
    try:
        sound = planned(tmp_path, random_drawing(rng, 3), settings, decimals=int(rng.choice([6, 9])))
    except PlannerError:
        pytest.skip("nothing of it can be planned")
    assert not sound.found(tmp_path / "traj.csv")
