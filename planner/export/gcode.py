"""Joint-space G-code: each joint is an axis of the controller, in degrees where it turns and in mm where it slides.

A line a sample. GRBL, grblHAL and FluidNC are told how long each takes (G93, inverse time: F is 1/min); Marlin, which
has no such mode, how fast it is (F in units a minute, the length of a line being that over all its axes). Where nothing
moves they are told to wait. What the arm does between two lines is straight in the joints.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from planner.errors import UsageError
from planner.export.motion import Motion

_DECIMALS = 4
_AXES = "XYZABCUVW"
_APPROACH_PER_MIN = 600.0
"""10 deg/s or mm/s: to the first point, from wherever the arm is."""


class Controller(StrEnum):
    GRBL = "grbl"
    GRBLHAL = "grblhal"
    FLUIDNC = "fluidnc"
    MARLIN = "marlin"


MOST_AXES = {Controller.GRBL: 3, Controller.GRBLHAL: 8, Controller.FLUIDNC: 6, Controller.MARLIN: 9}
_LONGEST_LINE = {Controller.GRBL: 79, Controller.GRBLHAL: 255, Controller.FLUIDNC: 255, Controller.MARLIN: 95}


@dataclass(frozen=True, slots=True)
class GcodeOptions:
    """axes: a letter for each joint; None for the first of XYZABCUVW. pen: None where the arm itself lifts it, "m3" for
    `M3 S...`, or the letter of one more axis; down, up: what that is set to."""

    controller: Controller = Controller.GRBLHAL
    axes: str | None = None
    pen: str | None = None
    down: float = 1000.0
    up: float = 0.0


def gcode_lines(motion: Motion, options: GcodeOptions) -> Iterator[str]:
    """The program. Errors: UsageError where the controller has not that many axes."""
    axes = _axes(motion, options)
    return _program(motion, options, axes)


def _axes(motion: Motion, options: GcodeOptions) -> str:
    n_joints, controller = len(motion.joints), options.controller
    extra = options.pen if options.pen not in (None, "m3") else ""
    axes = options.axes
    if axes is None:
        axes = "".join(letter for letter in _AXES if letter != extra)[:n_joints]
    if len(axes) < n_joints or (options.axes is not None and len(axes) > n_joints):
        raise UsageError(
            f"--axes {axes}: {motion.arm} has {n_joints} joints ({', '.join(motion.names)}), a letter each"
        )
    if len(set(axes + (extra or ""))) < len(axes) + len(extra or ""):
        raise UsageError(f"--axes {axes}{f', --pen {extra}' if extra else ''}: an axis is named twice")
    if n_joints + len(extra or "") > MOST_AXES[controller]:
        raise UsageError(
            f"{controller} has {MOST_AXES[controller]} axes at most, and {motion.arm} needs"
            f" {n_joints + len(extra or '')}: choose another --controller, or fewer joints with --joints"
        )
    return axes


def _program(motion: Motion, options: GcodeOptions, axes: str) -> Iterator[str]:
    positions = np.round(motion.positions_in_file_units, _DECIMALS) + 0.0
    marlin = options.controller is Controller.MARLIN
    yield f"; {_printable(motion.drawing)} by {motion.arm}, {motion.n_samples} samples, {motion.rate_hz:g} a second"
    for letter, joint in zip(axes, motion.joints, strict=True):
        yield f"; {letter}: {_printable(joint.urdf_name or joint.name)}, {joint.file_unit}"
    yield "G21"
    yield "G90"
    yield from _pen(options, down=False)
    yield "G94" if not marlin else "; F: units a minute, over all axes"
    yield f"G1 {_words(axes, positions[0])} F{_APPROACH_PER_MIN:g}"
    if not marlin:
        yield "G93"
    waited = 0
    inverse_time = f"F{60.0 * motion.rate_hz:.6g}"
    lengths = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    for index in range(1, motion.n_samples):
        if lengths[index - 1] == 0:
            waited += 1
        else:
            yield from _wait(waited, motion.rate_hz, marlin=marlin)
            waited = 0
            feed = f"F{60.0 * motion.rate_hz * lengths[index - 1]:.4f}" if marlin else inverse_time
            yield f"G1 {_words(axes, positions[index])} {feed}"
        if motion.pen[index] != motion.pen[index - 1] and options.pen is not None:
            yield from _wait(waited, motion.rate_hz, marlin=marlin)
            waited = 0
            if not marlin:
                yield "G94"
            yield from _pen(options, down=bool(motion.pen[index]))
            if not marlin:
                yield "G93"
    yield from _wait(waited, motion.rate_hz, marlin=marlin)
    if not marlin:
        yield "G94"
    yield from _pen(options, down=False)
    yield "M400" if marlin else "M2"


def _words(axes: str, position: np.ndarray) -> str:
    return " ".join(f"{letter}{value:.{_DECIMALS}f}" for letter, value in zip(axes, position.tolist(), strict=True))


def _wait(samples: int, rate_hz: float, *, marlin: bool) -> Iterator[str]:
    """G4 counts P in seconds, and Marlin's in milliseconds."""
    if samples:
        seconds = samples / rate_hz
        yield f"G4 P{1000 * seconds:.0f}" if marlin else f"G4 P{seconds:.6g}"


def _pen(options: GcodeOptions, *, down: bool) -> Iterator[str]:
    value = options.down if down else options.up
    if options.pen == "m3":
        yield f"M3 S{value:g}"
    elif options.pen is not None:
        yield f"G0 {options.pen}{value:g}"


def _printable(text: str) -> str:
    """Without what ends a comment or a line, nor what a controller takes for a command in real time."""
    return "".join(c if c.isascii() and c.isprintable() and c not in "();!?~" else "_" for c in text)[:60]
