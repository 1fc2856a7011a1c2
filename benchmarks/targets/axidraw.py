"""AxiDraw as modelled: constant acceleration between junctions, with the constants of its own software.

They are those of `axidraw_conf.py` 3.9.0 (github.com/evil-mad/axidraw), but for the acceleration, which is taken in
full where the software takes three quarters unless told otherwise, for the servo, at its full rate, and for gaps, which
it is let draw across up to 0.2 mm where the file says 0.006 inches. Its pen gets the arm's cap, its strokes the
planner's order; the software keeps the order of the file unless told otherwise.
"""

from __future__ import annotations

from benchmarks.targets.trapezoids import Plotter

_INCH_MM = 25.4
_TRAVEL_SHARE = 75 / 110
"""Of the top speed of the high resolution: the default for pen-up moves, as the software turns it into a speed."""
_LIFT_PERCENT = 60 - 30
"""The default heights, in parts of the servo's range."""
_SERVO_S = ((0.045 + 0.00269 * _LIFT_PERCENT) ** 4 + (0.2 * _LIFT_PERCENT / 100) ** 4) ** 0.25
GAP_MM = 0.2


def axidraw(cap_mm_s: float) -> Plotter:
    return Plotter(
        down_mm_s=cap_mm_s,
        down_mm_s2=40.0 * _INCH_MM,
        deviation_mm=10.0 / 5000 * _INCH_MM,
        up_mm_s=_TRAVEL_SHARE * 8.6979 * _INCH_MM,
        up_mm_s2=60.0 * _INCH_MM,
        lower_s=_SERVO_S,
        raise_s=_SERVO_S,
        gap_mm=GAP_MM,
    )
