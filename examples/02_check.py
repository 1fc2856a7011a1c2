"""Check a trajectory: every law that it has to keep, with the worst figure and where it is."""

from __future__ import annotations

from pathlib import Path

from planner import check, plan

drawing = Path(__file__).with_name("harbour.svg")
planned = plan(drawing, speed_mm_s=40, margin_mm=10)
planned.save("harbour.csv")
planned.plot("error", "harbour_error.png")

result = check("harbour.csv", drawing)
print(result)
worst = max((finding for finding in result.findings if finding.limit), key=lambda law: law.worst / law.limit)
print(f"nearest to its limit: {worst.words}")
