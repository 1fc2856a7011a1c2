"""Draw what a program makes: the text of an SVG is a drawing too. Here a rose curve of seven petals."""

from __future__ import annotations

from math import cos, pi, sin

from planner import plan

angles = [2 * pi * step / 720 for step in range(721)]
points = " ".join(f"{50 + 45 * cos(7 * a) * cos(a):.3f},{50 + 45 * cos(7 * a) * sin(a):.3f}" for a in angles)
svg = (
    f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><polyline points="{points}" stroke="black"/></svg>'
)

planned = plan(svg, arm="scara", tolerance_mm=0.02)
planned.save("rose.csv")
planned.plot("speed", "rose_speed.png")
