"""Where a character stands on the page, as an affine of its own frame."""

from __future__ import annotations

import math

import numpy as np

from planner.arrays import FloatArray
from planner.drawing.text.characters import Character


def frame(character: Character, *, is_vertical: bool, is_turned: bool = True) -> FloatArray | None:
    """The affine (2, 3) from a character's frame, in user units with x along its line from where it begins and y up
    from the alphabetic baseline, to the user units of its text. An upright character in a vertical line has x to the
    right from the middle of the line, and y up from where it begins. is_turned: whether `rotate` counts. None beyond
    the ends of its path.
    """
    turn = math.radians(character.rotate) if is_turned else 0.0
    path = character.span.path
    if path is not None:
        half = character.advance / 2.0
        found = path.at(path.offset + character.u + half)
        if found is None:
            return None
        x, y, direction = found
        below = character.v - character.rise
        angle = direction + turn
        x += -math.sin(direction) * below - math.cos(angle) * half
        y += math.cos(direction) * below - math.sin(angle) * half
        return _affine(angle, x, y, character.stretch, 1.0)
    if not is_vertical:
        return _affine(turn, character.u, character.v - character.rise, character.stretch, 1.0)
    return _vertical(character, turn)


def _vertical(character: Character, turn: float) -> FloatArray:
    """Chromium turns a character of a vertical line about the point that would be its origin if the line were not."""
    x, y = character.rise - character.v, character.u
    metrics = character.metrics
    centre = x - metrics.descent * character.size, y + metrics.ascent * character.size
    if character.is_upright:
        x += (metrics.ascent - metrics.descent) / 2.0 * character.size
    if turn:
        away = x - centre[0], y - centre[1]
        x = centre[0] + math.cos(turn) * away[0] - math.sin(turn) * away[1]
        y = centre[1] + math.sin(turn) * away[0] + math.cos(turn) * away[1]
    if character.is_upright:
        return _affine(turn, x, y, 1.0, character.stretch)
    return _affine(turn + math.pi / 2.0, x, y, character.stretch, 1.0)


def _affine(angle: float, x: float, y: float, along: float, up: float) -> FloatArray:
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine * along, sine * up, x], [sine * along, -cosine * up, y]])


def cell(character: Character) -> FloatArray:
    """Corners (4, 2), in the frame of a character, of the room that it takes."""
    metrics, size = character.metrics, character.size
    room = character.advance / character.stretch
    if character.is_upright:
        half = (metrics.ascent + metrics.descent) / 2.0 * size
        return np.array([[-half, 0.0], [half, 0.0], [half, -room], [-half, -room]])
    low, high = -metrics.descent * size, metrics.ascent * size
    return np.array([[0.0, low], [room, low], [room, high], [0.0, high]])
