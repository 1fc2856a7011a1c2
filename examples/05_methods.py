"""Compare the methods: the same drawing by each, and how long the arm takes."""

from __future__ import annotations

from pathlib import Path

from planner import compare, plan

drawing = Path(__file__).with_name("harbour.svg")
print(compare(targets=[(53, 47.8)]))
for method in ("path", "dls"):
    planned = plan(drawing, method=method)
    print(f"{method}: {planned.summary.duration_s:.1f} s")
    planned.plot("timeline", f"timeline_{method}.png")
