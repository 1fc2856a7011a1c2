"""What faults of an arm look like: one drawing by arms with one fault each, for `docs/troubleshooting.md`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from hardware.clock import InstantClock
from hardware.motion.tip import link_nodes_mm
from hardware.simulation.ink import drawn_lines
from hardware.simulation.simulated_arm import Servos, SimulatedArm
from planner.arms.arm import Arm, Joint
from planner.arms.arm_file import load_arm
from planner.arms.paper_pose import PaperPose
from planner.arrays import FloatArray
from planner.cli import main
from planner.plots.drawing_error import draw_lines
from planner.plots.look import USUAL, Look
from planner.plots.sheet import Sheet
from planner.trajectory import Trajectory, read_trajectory

ARM = "drawing_arm"
_DRAWING = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 30" fill="none" stroke="black">
<path d="M2 2H58V28H2Z"/><circle cx="16" cy="15" r="9"/><circle cx="16" cy="15" r="4"/>
<path d="M32 6H53V9H32V12H53V15H32V18H53V21H32V24H53"/></svg>"""
_COLUMNS, _EDGE, _GAP, _TITLE = 3, 1.6, 2.2, 2.4  # em


def _of(name: str, change: Callable[[Joint], Joint]) -> Callable[[Arm], Arm]:
    return lambda arm: replace(
        arm, joints=tuple(change(joint) if joint.name == name else joint for joint in arm.joints)
    )


def _servo(**values: object) -> Callable[[Joint], Joint]:
    def change(joint: Joint) -> Joint:
        assert joint.servo is not None
        return replace(joint, servo=replace(joint.servo, **values))  # type: ignore[arg-type]

    return change


def _shifted(by_deg: float) -> Callable[[Joint], Joint]:
    def change(joint: Joint) -> Joint:
        assert joint.servo is not None
        return _servo(curve=tuple((at + np.radians(by_deg), pulse_us) for at, pulse_us in joint.servo.curve))(joint)

    return change


def _reversed(joint: Joint) -> Joint:
    assert joint.servo is not None
    return replace(joint, servo=replace(joint.servo, direction=-joint.servo.direction))


SYMPTOMS: dict[str, Callable[[Arm], Arm]] = {
    "a box is slanted": _of("q1", _shifted(6.0)),
    "gaps at the far edge": lambda arm: replace(arm, paper=PaperPose(z_mm=1.2, tilt_y_rad=np.radians(1.2))),
    "lines are doubled, circles do not close": _of("q1", _servo(backlash=np.radians(2.5))),
    "lines go in steps": _of("q1", _servo(resolution_us=14.0)),
    "it is a mirror image": _of("q1", _reversed),
    "the pen drags between strokes": lambda arm: replace(arm, paper=PaperPose(z_mm=4.3)),
}
"""What is seen, and what is wrong with the arm."""


def plot_symptoms(look: Look = USUAL) -> Figure:
    """A panel a symptom. Works in the current folder."""
    Path("symptom.svg").write_text(_DRAWING, encoding="utf-8")
    if main(["symptom.svg", "--arm", ARM, "-o", "symptom.csv", "--quiet"]):
        raise SystemExit(1)
    arm, trajectory = _faultless(load_arm(ARM)), read_trajectory(Path("symptom.csv"))
    tip_mm = link_nodes_mm(arm, arm.from_file_units(trajectory.positions))[:, -1, :2]
    wanted = [tip_mm[trajectory.stroke == stroke] for stroke in range(int(trajectory.stroke.max()) + 1)]
    everything = np.concatenate(wanted)
    middle, half = (everything.max(axis=0) + everything.min(axis=0)) / 2, np.ptp(everything, axis=0) / 2 + 5.0
    with look.style():
        sheet = Sheet(look)
        width = (sheet.width - 2 * _EDGE - (_COLUMNS - 1) * _GAP) / _COLUMNS
        height = width * half[0] / half[1]
        rows = -(-len(SYMPTOMS) // _COLUMNS)
        for number, (title, fault) in enumerate(SYMPTOMS.items()):
            row, column = divmod(number, _COLUMNS)
            bottom = _EDGE + (rows - 1 - row) * (height + _GAP + _TITLE)
            axes = sheet.panel(_EDGE + column * (width + _GAP), bottom, width, height)
            axes.set_title(title, loc="left")
            axes.set_xlim(middle[1] + half[1], middle[1] - half[1])
            axes.set_ylim(middle[0] - half[0], middle[0] + half[0])
            axes.axis("off")
            draw_lines(axes, wanted, "wanted", look.colours.wanted, 1.8)
            draw_lines(axes, _drawn(arm, fault(arm), trajectory), "drawn", look.colours.drawn, 0.9)
        remark = "one drawing by arms with one fault each, over what was wanted; the base is below"
        return sheet.finish("What is wrong?", remark, axes.get_legend_handles_labels()[0], room=_TITLE)


def _faultless(arm: Arm) -> Arm:
    joints = []
    for joint in arm.joints:
        assert joint.servo is not None
        servo = replace(joint.servo, backlash=0.0, dead_band_us=0.0, resolution_us=0.1, lag_s=0.001)
        joints.append(replace(joint, servo=servo))
    return replace(arm, joints=tuple(joints))


def _drawn(arm: Arm, true_arm: Arm, trajectory: Trajectory) -> list[FloatArray]:
    clock = InstantClock()
    driver = SimulatedArm(arm, clock, Servos.REAL, true_arm)
    positions = arm.from_file_units(trajectory.positions)
    driver.connect(positions[0])
    for k, position in enumerate(positions):
        clock.sleep_until(k / trajectory.rate_hz)
        driver.send(position, 1 / trajectory.rate_hz)
    return drawn_lines(true_arm, driver.recording.positions)
