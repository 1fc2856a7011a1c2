"""The tolerance budget: what each station from the drawing to the samples may spend of the tolerance.

It is spent once: chords in the place of curves take a little, and all the rest is for what the pen makes of the
strokes, measured as one deviation, both ways: rounded corners, straight lines or cubics between samples, and that the
joints move straight rather than the tip.
"""

from __future__ import annotations

FLATTEN_SHARE = 0.04
"""Chords in the place of curves."""
JOIN_SHARE, NARROW_SHARE, ON_LINE_SHARE = 2.0, 0.5, 0.02
"""How far ends may be apart that are joined: the middle of the gap is half of that off the drawing. The pen may stray
there by all that it may elsewhere where the gap is a narrow one; wider ones are looked at, and crossed where it strays
little. An end is on a line where it is off that by the last of them: along the line there is no gap."""
STROKE_SHARE = 1.0 - FLATTEN_SHARE
"""How far the pen may be off a stroke, and the stroke off what the pen draws, at the samples and between them."""
CHORD_SHARE = 0.16
"""How far of the tolerance the tip may bulge from straight lines between samples, as it is the joints that move
straight: at 50 samples a second less of it would slow down straight lines. The samples are measured anyway."""

SPLINE_SHARE = 0.04
"""What the joints' splines may stray between their knots before there are more of them: hardly any do, and the samples
are measured anyway."""

# What samples are measured against, once they are there.
HEIGHT_SHARE = 0.5
"""Height of the tip while it draws."""
DRIFT_SHARE = 0.5
"""Drift, or depth below the paper, while the tip is lifted."""
ACROSS_SHARE = 0.45
"""How far a stroke may bend the way to and from it, and that way the stroke."""
