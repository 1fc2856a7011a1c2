"""saxi as modelled: constant acceleration between junctions, by its fast profile for an AxiDraw.

The constants are those of `AxidrawFast` and the default options in `src/planning.ts` (github.com/nornagon/saxi, January
2025): its own cap of 50 mm/s, and ends joined that are up to 0.5 mm apart, of strokes in the planner's order. The way
back to its corner at the end is left out.
"""

from __future__ import annotations

from benchmarks.targets.trapezoids import Plotter


def saxi(cap_mm_s: float) -> Plotter:
    return Plotter(
        down_mm_s=min(50.0, cap_mm_s),
        down_mm_s2=200.0,
        deviation_mm=0.127,
        up_mm_s=200.0,
        up_mm_s2=400.0,
        lower_s=0.12,
        raise_s=0.12,
        gap_mm=0.5,
    )
