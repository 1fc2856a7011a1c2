"""Elliptical arcs as cubic Bezier curves, to within 4e-7 of the radius."""

from __future__ import annotations

import math

Cubic = tuple[float, float, float, float, float, float]

# A cubic over an angle a misses the circle by about 2.7e-4 (a / 90 deg)^6 of its radius.
_LARGEST_ANGLE_RAD = math.radians(30.0)


def arc_to_cubics(
    x0: float, y0: float, rx: float, ry: float, rotation_deg: float, large: bool, sweep: bool, x1: float, y1: float
) -> list[Cubic]:
    """The path command `A rx ry rotation large sweep x1 y1` from (x0, y0): control points and end of each cubic.

    Empty where both ends coincide; one straight cubic where a radius is zero; radii that are too
    small are scaled up (SVG 1.1, appendix F.6).
    """
    if (x0, y0) == (x1, y1):
        return []
    rx, ry = abs(rx), abs(ry)
    straight = [(x0 + (x1 - x0) / 3.0, y0 + (y1 - y0) / 3.0, x1 - (x1 - x0) / 3.0, y1 - (y1 - y0) / 3.0, x1, y1)]
    if rx == 0.0 or ry == 0.0:
        return straight
    cosine, sine = math.cos(math.radians(rotation_deg)), math.sin(math.radians(rotation_deg))
    # F.6.5.1, scaled to the unit circle: half the chord in the frame of the ellipse.
    half_x, half_y = (x0 - x1) / 2.0, (y0 - y1) / 2.0
    u = (cosine * half_x + sine * half_y) / rx
    v = (-sine * half_x + cosine * half_y) / ry
    length = math.hypot(u, v)
    if length == 0.0:  # underflow: the chord is nothing beside the radii
        return straight
    if length >= 1.0:
        rx, ry, u, v = rx * length, ry * length, u / length, v / length
        length = 1.0
    # F.6.5.2: the centre lies on the bisector of the chord.
    distance = math.sqrt((1.0 - length) * (1.0 + length)) / length
    side = -1.0 if large == sweep else 1.0
    center_u, center_v = side * distance * v, -side * distance * u
    start = math.atan2(v - center_v, u - center_u)
    turn = math.atan2(-v - center_v, -u - center_u) - start
    if sweep and turn <= 0.0:
        turn += 2.0 * math.pi
    elif not sweep and turn >= 0.0:
        turn -= 2.0 * math.pi
    center_x = cosine * rx * center_u - sine * ry * center_v + (x0 + x1) / 2.0
    center_y = sine * rx * center_u + cosine * ry * center_v + (y0 + y1) / 2.0
    cubics = ellipse_cubics(center_x, center_y, rx, ry, start, turn, cosine, sine)
    cubics[-1] = (*cubics[-1][:4], x1, y1)
    return cubics


def ellipse_cubics(
    center_x: float,
    center_y: float,
    rx: float,
    ry: float,
    start_rad: float,
    turn_rad: float,
    cosine: float = 1.0,
    sine: float = 0.0,
) -> list[Cubic]:
    """Cubics along an ellipse whose axes are turned by (cosine, sine), from the parameter angle `start_rad` on."""
    count = max(1, math.ceil(abs(turn_rad) / _LARGEST_ANGLE_RAD - 1e-9))
    step = turn_rad / count
    handle = 4.0 / 3.0 * math.tan(step / 4.0)

    def placed(u: float, v: float) -> tuple[float, float]:
        return (center_x + cosine * rx * u - sine * ry * v, center_y + sine * rx * u + cosine * ry * v)

    cubics = []
    for index in range(count):
        a, b = start_rad + index * step, start_rad + (index + 1) * step
        first = placed(math.cos(a) - handle * math.sin(a), math.sin(a) + handle * math.cos(a))
        second = placed(math.cos(b) + handle * math.sin(b), math.sin(b) - handle * math.cos(b))
        cubics.append((*first, *second, *placed(math.cos(b), math.sin(b))))
    return cubics
