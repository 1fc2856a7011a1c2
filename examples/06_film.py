"""Make a film: the arm as it draws, as a page with a player in it and as a GIF. A notebook shows `planned` so too."""

from __future__ import annotations

from pathlib import Path

from planner import plan

planned = plan(Path(__file__).with_name("harbour.svg"), arm="scara", progress=True)
planned.film("harbour.html")
planned.film("harbour.gif", speed_factor=20, fps=5)
