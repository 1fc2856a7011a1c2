"""Use the samples as a data frame: how fast each joint turns, beside what the arm allows (needs pandas)."""

from __future__ import annotations

from pathlib import Path

from planner import load_arm, plan

arm = load_arm("drawing_arm")
planned = plan(Path(__file__).with_name("spirograph.svg"), arm)
frame = planned.to_frame().set_index("t_s")

joints = frame[list(planned.trajectory.columns)]
speeds = joints.diff().abs() * planned.trajectory.rate_hz
for joint, fastest in zip(arm.joints, speeds.max(), strict=True):
    print(f"{joint.name}: {fastest:.1f} of {joint.max_velocity / joint.per_file_unit:.1f} {joint.file_unit}/s")
planned.plot("profiles", "profiles.png", to_s=5)
