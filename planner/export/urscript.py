"""A program in URScript for Universal Robots' arms: servoj, a set point a sample."""

from __future__ import annotations

from collections.abc import Iterator

from planner.errors import UsageError
from planner.export.motion import Motion

_JOINTS = 6
_LOOKAHEAD_S, _GAIN = 0.1, 300
"""The usual ones of servoj: how far it smooths ahead, and how hard it pulls."""
_APPROACH_RAD_S, _APPROACH_RAD_S2 = 0.25, 0.5


def urscript_lines(motion: Motion) -> Iterator[str]:
    """The program. Errors: UsageError where the arm is none of six turning joints."""
    if len(motion.joints) != _JOINTS or motion.slides.any():
        raise UsageError(
            f"URScript moves {_JOINTS} turning joints; {motion.arm} has {', '.join(motion.names)} (--joints chooses)"
        )
    return _program(motion)


def _program(motion: Motion) -> Iterator[str]:
    name = "".join(c if c.isascii() and c.isprintable() else "_" for c in motion.drawing)[:60]
    period = f"{1 / motion.rate_hz:.9g}"
    yield "def drawing():"
    yield f"  # {name} by {motion.arm}, {motion.n_samples} samples, {motion.rate_hz:g} a second"
    yield f"  # joints: {', '.join(motion.names)}"
    rows = [f"[{', '.join(f'{value + 0.0:.9f}' for value in row)}]" for row in motion.positions.tolist()]
    yield f"  movej({rows[0]}, a={_APPROACH_RAD_S2}, v={_APPROACH_RAD_S})"
    stroke = -1
    for row, of_stroke in zip(rows, motion.stroke.tolist(), strict=True):
        if of_stroke != stroke:
            stroke = of_stroke
            yield f"  # stroke {stroke}" if stroke >= 0 else "  # pen up"
        yield f"  servoj({row}, t={period}, lookahead_time={_LOOKAHEAD_S}, gain={_GAIN})"
    yield "  stopj(2.0)"
    yield "end"
    yield "drawing()"
