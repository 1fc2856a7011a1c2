"""The lines that a pen draws of a drawing's pictures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from planner.arrays import FloatArray, frozen
from planner.drawing.drawing import Drawing, Outline
from planner.drawing.image.centreline import centrelines
from planner.drawing.image.coverage import dot_density, scribble_density
from planner.drawing.image.curves import rounded
from planner.drawing.image.hatching import hatching
from planner.drawing.image.scribble import tour
from planner.drawing.image.seen import SeenPicture, seen_pictures
from planner.drawing.image.stipples import stipples
from planner.drawing.image.tones import tones
from planner.drawing.image.trace import traced
from planner.drawing.image_options import ImageOptions, ImageStyle
from planner.drawing.subpath import polyline
from planner.drawing.transforms import IDENTITY
from planner.errors import DrawingError

_GRID = {ImageStyle.HATCH: 3, ImageStyle.SCRIBBLE: 2, ImageStyle.STIPPLE: 2}
"""Cells to the finest detail."""
_CORNER = 0.125
"""Of the finest detail: what rounded corners are off."""


def with_images(drawing: Drawing, user_to_mm: FloatArray) -> Drawing:
    """The drawing with the lines of its pictures behind its own, for where `user_to_mm` (2, 3) puts it. Errors:
    PlanError where they would be too many, UsageError where a style lacks a library, DrawingError where there is
    nothing at all."""
    lines = image_lines(drawing, user_to_mm)
    if not lines and not drawing.outlines:
        options = drawing.reading.image
        raise DrawingError(
            drawing.source,
            f"nothing to draw: --image {options.style} finds nothing in the picture that is dark, and"
            f" {options.least_mm:g} mm across or more on the paper (try hatch, or a smaller --image-detail)",
        )
    return replace(drawing, outlines=(*drawing.outlines, *lines)) if lines else drawing


def frames(drawing: Drawing) -> list[Outline]:
    """Around what is seen of each picture, user units: how far its lines may go."""
    if drawing.scene is None or not drawing.reading.image.is_on:
        return []
    seen = seen_pictures(drawing.scene, drawing.reading, IDENTITY)
    return [
        Outline(polyline(shapely.get_coordinates(picture.shape.envelope)).beziers, picture.layer) for picture in seen
    ]


def image_lines(drawing: Drawing, user_to_mm: FloatArray) -> list[Outline]:
    """The lines of all pictures, user units."""
    options = drawing.reading.image
    if drawing.scene is None or not options.is_on:
        return []
    back = np.linalg.inv(user_to_mm[:, :2])
    return [
        Outline(frozen((curves - user_to_mm[:, 2]) @ back.T), picture.layer)
        for picture in seen_pictures(drawing.scene, drawing.reading, user_to_mm)
        for curves in _curves(picture, options)
    ]


def _curves(picture: SeenPicture, options: ImageOptions) -> list[FloatArray]:
    """(n, 4, 2) each, mm; a dot is one cubic of four equal points."""
    within_mm = _CORNER * options.least_mm
    if options.style is ImageStyle.TRACE:
        lines = _within(traced(picture, options.levels, options.least_mm), picture.shape)
        return [_drawn(line, within_mm) for line in lines]
    if options.style is ImageStyle.CENTRELINE:
        lines = _within(centrelines(picture, options.least_mm), picture.shape)
        return [_drawn(line, within_mm) for line in lines]
    # Ink stays within the picture: the middle of a line is half its width from the edge.
    inner = picture.shape.buffer(-options.line_mm / 2.0)
    if inner.is_empty:
        return []
    wanted = tones(replace(picture, shape=inner), options.least_mm, _GRID[options.style], options.ink)
    if options.style is ImageStyle.HATCH:
        angle_rad = np.radians(options.angle_deg) + np.pi / 2  # counterclockwise from left to right, as with fills
        return [
            polyline(line).beziers for line in hatching(wanted, inner, options.line_mm, options.least_mm, angle_rad)
        ]
    density = dot_density if options.style is ImageStyle.STIPPLE else scribble_density
    dots = stipples(density(wanted.values, options.line_mm), wanted.low_mm, wanted.pitch_mm)
    dots = dots[shapely.contains_xy(inner, dots)]
    if options.style is ImageStyle.STIPPLE:
        return [polyline(dot[None]).beziers for dot in dots]
    return [_drawn(line, np.inf) for line in _within([tour(dots)], inner) if len(line)]


def _drawn(line: FloatArray, within_mm: float) -> FloatArray:
    return rounded(line, within_mm) if len(line) > 1 else polyline(line).beziers


def _within(lines: list[FloatArray], shape: BaseGeometry) -> list[FloatArray]:
    """What of lines and dots is in a shape."""
    shapely.prepare(shape)
    found: list[FloatArray] = []
    for line in lines:
        if len(line) < 2:
            found += [line] if len(line) and shape.covers(shapely.Point(line[0])) else []
            continue
        whole = shapely.LineString(line)
        if shape.covers(whole):
            found.append(line)
            continue
        cut = shapely.line_merge(shapely.intersection(whole, shape))
        found += [np.asarray(part.coords) for part in shapely.get_parts(cut) if part.geom_type == "LineString"]
    return found
