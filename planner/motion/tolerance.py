"""The tolerance budget: what each station from the drawing to the samples may spend of the tolerance.

Along the way of a stroke, what is spent adds up: chords for curves, gaps that are closed, rounded corners, straight
lines between samples, and what the tip strays from these because it is the joints that move straight. Together these
shares are the whole tolerance.
"""

from __future__ import annotations

SMOOTH_SHARE = 0.5
"""Rounded corners: how far the smooth pen path may be off the polyline."""
SAMPLE_SHARE = 0.4
"""Corners that straight lines between samples cut off."""
CHORD_SHARE = 0.04
"""How far the tip bulges from these straight lines, as it is the joints that move straight."""
FLATTEN_SHARE = JOIN_SHARE = 0.5 * (1.0 - SMOOTH_SHARE - SAMPLE_SHARE - CHORD_SHARE)
"""What is left, for chords in the place of curves, and for gaps that are closed."""

SPLINE_SHARE = 0.04
"""What the joints' splines may stray between their knots before there are more of them: hardly any do, and the samples
are measured anyway."""

# What samples are measured against, once they are there.
ASIDE_SHARE = 0.44
"""How far the tip may be off a stroke's smooth path between samples, and that off it: what lines between samples and
bulges may spend together."""
HEIGHT_SHARE = 0.5
"""Height of the tip while it draws."""
DRIFT_SHARE = 0.5
"""Drift, or depth below the paper, while the tip is lifted."""
ACROSS_SHARE = 0.45
"""How far a stroke may bend the way to and from it, and that way the stroke."""
