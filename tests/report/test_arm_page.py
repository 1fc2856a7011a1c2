"""The page about an arm shows it, and says why one cannot draw."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from planner.arms.arm_file import load_arm
from planner.cli import main
from planner.plots.motion import arm_nodes
from planner.redundancy.arm_model import ArmModel
from planner.report.arm_page import arm_page, configurations_on_canvas
from planner.workspace.reach import paper_in_reach
from tests.arms.chains import DRAWING_ARMS


@pytest.mark.parametrize("name", DRAWING_ARMS)
def test_the_poses_shown_have_the_pen_on_the_canvas(name: str) -> None:
    arm = load_arm(name)
    model = ArmModel(arm)
    corners = paper_in_reach(model).corners_arm_mm
    tips = arm_nodes(arm, configurations_on_canvas(model, corners))[:, -1]
    np.testing.assert_allclose(tips[:, 2], 0.0, atol=1e-6)
    assert ((tips[:, :2] >= corners.min(axis=0)) & (tips[:, :2] <= corners.max(axis=0))).all()


def test_a_page_is_written_whole(tmp_path: Path) -> None:
    assert main(["arm", "scara", "--report", str(tmp_path / "page")]) == 0
    page = (tmp_path / "page" / "index.html").read_text(encoding="utf-8")
    assert page.startswith("<!doctype html>") and page.rstrip().endswith("</html>")
    assert page.count("<img") == 2 and "251 × 92 mm" in page and "http://" not in page
    assert main(["arm", "--report", str(tmp_path / "page")]) == 2
    (tmp_path / "file").write_text("")
    assert main(["arm", "scara", "--report", str(tmp_path / "file")]) == 2


def test_an_arm_that_cannot_draw_says_why() -> None:
    arm = load_arm("drawing_arm")
    short = replace(arm, joints=tuple(replace(joint, a_mm=0.3 * joint.a_mm) for joint in arm.joints))
    page = arm_page(short)
    assert "It cannot draw: " in page and "<img" not in page and "What its file says" in page
