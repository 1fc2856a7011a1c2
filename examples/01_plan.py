"""Plan a drawing: from an SVG to a trajectory that an arm can follow, with a picture of what the pen will draw."""

from __future__ import annotations

from pathlib import Path

from planner import plan

planned = plan(Path(__file__).with_name("garden.svg"), arm="so101")
print(*planned.summary.lines(), sep="\n")
planned.save("garden.csv")
planned.plot("drawing", "garden.png")
