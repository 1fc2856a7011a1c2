"""What a controller makes of the samples: straight lines and cubic splines against the limits of the joints.

python benchmarks/interpolation.py --rates 100 1000
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from planner.arms.arm_file import load_arm
from planner.pipeline import plan
from planner.settings import PlanSettings
from planner.trajectory import Trajectory

_PLACES = 20
"""A step is looked at in so many."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rates", nargs="+", type=float, default=[100.0, 1000.0])
    options = parser.parse_args()
    for drawing in sorted((Path(__file__).resolve().parent.parent / "examples").glob("*.svg")):
        for rate_hz in options.rates:
            trajectory = plan(drawing, PlanSettings(rate_hz=rate_hz), lambda *_: None).trajectory
            print(f"{drawing.stem} at {rate_hz:g} Hz: {figures(trajectory)}", flush=True)


def figures(trajectory: Trajectory) -> str:
    arm = load_arm(trajectory.arm)
    limits = [arm.to_file_units(limit) for limit in (arm.max_velocity, arm.max_acceleration, arm.max_jerk)]
    positions, times = trajectory.positions, trajectory.times_s
    jump = np.abs(np.diff(positions, n=2, axis=0)).max(axis=0) * trajectory.rate_hz
    spline = CubicSpline(times, positions, bc_type="clamped")
    fine = (np.arange((len(times) - 1) * _PLACES) + 0.5) / _PLACES / trajectory.rate_hz
    shares = [
        float((np.abs(spline(fine, order)).max(axis=0) / limit).max()) for order, limit in enumerate(limits, start=1)
    ]
    lines = np.column_stack([np.interp(fine, times, column) for column in positions.T])
    return (
        f"straight lines: speed jumps by {jump.max():.1f} deg/s, acceleration over a step "
        f"{(jump * trajectory.rate_hz / limits[1]).max():.2f} of its limit; off the spline by "
        f"{np.abs(spline(fine) - lines).max():.4f} deg; cubic spline: velocity, acceleration, jerk "
        + ", ".join(f"{share:.2f}" for share in shares)
        + " of their limits"
    )


if __name__ == "__main__":
    main()
