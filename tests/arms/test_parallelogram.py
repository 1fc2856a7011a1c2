"""The recipe of docs/arms.md for arms whose rods turn the forearm and keep the hand level."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.arms.arm import Arm
from planner.arms.arm_file import arm_of_text
from planner.kinematics.frame_jacobian import chain_frames, frame_jacobian

_LIMITS = "min_deg = -95.0\nmax_deg = 95.0\n" + "".join(
    f"max_{what} = 1000.0\n" for what in ("velocity_deg_s", "acceleration_deg_s2", "jerk_deg_s3")
)


@pytest.fixture(scope="module")
def arm() -> Arm:
    page = (Path(__file__).resolve().parents[2] / "docs" / "arms.md").read_text(encoding="utf-8")
    recipe = page[page.index("### Arms with parallelograms") :]
    table, block = recipe.split("```toml", 1)
    rows = [[cell.strip(" `") for cell in line.split("|")[1:5]] for line in table.splitlines() if line[:3] == "| `"]
    head, couplings = block[: block.index("```")].split("[[coupling]]", 1)
    joints = "".join(
        f'[[joints]]\nname = "{name}"\nkind = "revolute"\n'
        f"d_mm = {d or 0}.0\na_mm = {a or 0}.0\nalpha_deg = {alpha or 0}.0\n{_LIMITS}"
        for name, d, a, alpha in rows
    )
    text = 'name = "rods"\nsource = "docs"\n' + head.replace("[tool]", "lift_mm = 5.0\n\n[tool]") + joints
    return arm_of_text(f"{text}[workspace]\ninner_radius_mm = 150.0\n[[coupling]]{couplings}", "docs/arms.md")


@given(waist=st.floats(-1.5, 1.5), shoulder=st.floats(0.1, 1.5), forearm=st.floats(-1.4, 0.2))
def test_each_motor_turns_its_link_from_level_and_the_pen_hangs_down(
    arm: Arm, waist: float, shoulder: float, forearm: float
) -> None:
    joints = arm.complete(np.array([waist, shoulder, forearm]))
    frame = chain_frames(arm, joints[None])[0, -1]
    radius = 135 * np.cos(shoulder) + 147 * np.cos(forearm) + 60
    height = 138 + 135 * np.sin(shoulder) + 147 * np.sin(forearm) - 60
    np.testing.assert_allclose(frame[:3, 3], [radius * np.cos(waist), radius * np.sin(waist), height], atol=1e-9)
    np.testing.assert_allclose(frame[:3, :3] @ np.array(arm.pen.tool_axis), [0, 0, -1], atol=1e-12)
    of_shoulder = (frame_jacobian(arm, joints[None])[0] @ arm.coupling_matrix[0])[:3, 1]
    np.testing.assert_allclose(of_shoulder[2], 135 * np.cos(shoulder), atol=1e-9)  # the forearm does not turn with it
