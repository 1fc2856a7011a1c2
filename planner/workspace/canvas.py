"""Three rectangles to draw on, in the half ring in front of an arm.

Canvas points (X, Y) lie as in an SVG, X to the right and Y down, seen from behind the arm with the base at
the bottom: arm x = far side - Y, arm y = left side - X.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import casadi
import numpy as np

from planner.arms.arm import JointKind
from planner.arrays import BoolArray, FloatArray
from planner.errors import PlanError
from planner.kept import Arrays
from planner.kinematics.limits import SLACK, beyond_limits
from planner.kinematics.link_clearance import KEPT_MM
from planner.kinematics.projection import project
from planner.redundancy.arm_model import ArmModel
from planner.redundancy.configuration_map import ConfigurationMap
from planner.redundancy.ring_map import RingMap
from planner.settings import CanvasKind

_MOST_ITERATIONS = 3000
_GRID_CELLS = 160
_RADIAL_STEPS = 600
_HEIGHTS = 7
_ROUNDING = 1e-12
_LEVEL = 0.99
"""Cosine from which the base's z axis counts as square to the paper."""
_SQUARES, _HEIGHTS_OF_SQUARES = 90, 3
"""Of a map over the plane: along its longer side, and from the paper up to the lift height."""


@dataclass(frozen=True, slots=True)
class Canvas:
    """An axis-aligned rectangle of paper in arm millimetres: near and far are distances from the base along
    x, right and left are the y of its sides. Errors: PlanError where that is no rectangle."""

    kind: CanvasKind
    near_mm: float
    far_mm: float
    right_mm: float
    left_mm: float

    def __post_init__(self) -> None:
        if not (0 < self.width_mm < np.inf and 0 < self.height_mm < np.inf):
            raise PlanError(
                f"there is no {self.kind} canvas: it would be {self.width_mm:g} mm wide and"
                f" {self.height_mm:g} mm high; try another --canvas"
            )

    @property
    def width_mm(self) -> float:
        """Size across the arm, along y: the canvas' X."""
        return self.left_mm - self.right_mm

    @property
    def height_mm(self) -> float:
        """Size away from the arm, along x: the canvas' Y."""
        return self.far_mm - self.near_mm

    @property
    def corners_arm_mm(self) -> FloatArray:
        """(4, 2): canvas corners (0, 0), (w, 0), (w, h), (0, h) in arm coordinates."""
        return np.array(
            [
                [self.far_mm, self.left_mm],
                [self.far_mm, self.right_mm],
                [self.near_mm, self.right_mm],
                [self.near_mm, self.left_mm],
            ]
        )

    def to_arm_mm(self, canvas_mm: FloatArray) -> FloatArray:
        """(..., 2) arm coordinates of canvas points (..., 2)."""
        arm_mm: FloatArray = np.stack((self.far_mm - canvas_mm[..., 1], self.left_mm - canvas_mm[..., 0]), axis=-1)
        return arm_mm


def documented_canvas(r_max_mm: float, r_min_mm: float) -> Canvas:
    """The documents' rectangle: near side tangent to the inner circle, far corners on the outer one, half
    angle acos(sqrt(2)/r) - 45 degrees with r = r_max/r_min (seed document on the kinematics, drawing limits).
    Errors: PlanError up to r = 2, where that angle is not above zero."""
    inner = _share(CanvasKind.DOCUMENTED, r_max_mm, r_min_mm, 2.0)
    return _tangent_canvas(CanvasKind.DOCUMENTED, r_max_mm, r_min_mm, float(np.arccos(np.sqrt(2) * inner) - np.pi / 4))


def optimal_canvas(r_max_mm: float, r_min_mm: float) -> Canvas:
    """The rectangle of largest area of the same kind: cos(half angle) = (1 + sqrt(1 + 8 r^2)) / (4 r), the
    root of the derivative of the area that the documents misprint. Errors: PlanError where there is no ring."""
    inner = _share(CanvasKind.OPTIMAL, r_max_mm, r_min_mm, 1.0)
    return _tangent_canvas(
        CanvasKind.OPTIMAL, r_max_mm, r_min_mm, float(np.arccos((inner + np.hypot(inner, np.sqrt(8))) / 4))
    )


def _share(kind: CanvasKind, r_max_mm: float, r_min_mm: float, least: float) -> float:
    """1/r, which there is for a ring without a hole too. Errors: PlanError where r is not above its least value."""
    if not least * r_min_mm < r_max_mm < np.inf:
        raise PlanError(
            f"no {kind} canvas: the outer radius {r_max_mm:.1f} mm is not above {least:g} times the inner"
            f" radius {r_min_mm:.1f} mm; try another --canvas"
        )
    return r_min_mm / r_max_mm


def _tangent_canvas(kind: CanvasKind, r_max_mm: float, r_min_mm: float, half_angle_rad: float) -> Canvas:
    half_width = r_max_mm * float(np.sin(half_angle_rad))
    return Canvas(kind, r_min_mm, r_max_mm * float(np.cos(half_angle_rad)), -half_width, half_width)


def geometric_reach_mm(model: ArmModel) -> float:
    """Largest distance from the base axis at which the pen, held as the arm holds it, touches the paper, limits of
    turning joints aside: how far a joint slides is a length of the arm. For the drawing arm
    sqrt((L2+L3+L4)^2 - (L5-L1)^2): minus, where the documents print plus. Errors: PlanError where it is not found."""
    arm = model.arm
    if not (rings := model.rings()):
        raise PlanError(
            f"arm {arm.name} does not turn about the normal of its paper, and reaches no ring that a documented or an"
            " optimal canvas could lie in; try --canvas usable"
        )
    outermost = max(rings, key=lambda branch: branch.radii_mm[-1])
    kinematics = outermost.level
    solver = casadi.nlpsol(
        "reach",
        "ipopt",
        {"x": kinematics.independent, "f": -(kinematics.tip[0] / 100), "g": kinematics.task[1:]},
        {
            "ipopt.print_level": 0,
            "ipopt.sb": "yes",
            "ipopt.max_iter": _MOST_ITERATIONS,
            "print_time": False,
            "error_on_fail": False,
        },
    )
    slides = kinematics.independent_of(np.array([joint.kind is JointKind.PRISMATIC for joint in arm.joints]))
    solution = solver(
        x0=outermost.configurations[-1],
        lbg=0,
        ubg=0,
        lbx=np.where(slides, kinematics.independent_of(arm.minimum), -np.inf),
        ubx=np.where(slides, kinematics.independent_of(arm.maximum), np.inf),
    )
    if not solver.stats()["success"]:
        raise PlanError(
            f"arm {arm.name}: how far its stretched links reach was not found, so that there is no documented and no"
            " optimal canvas; try --canvas usable"
        )
    return max(float(-solution["f"]) * 100, float(outermost.radii_mm[-1]))


def usable_canvas(model: ArmModel, lift_mm: float) -> Canvas:
    """The largest axis-aligned rectangle where the pen gets to the paper and to the lift height
    with all joints within limits, clear of singularities and links apart, found on a grid and then grown."""
    regions = _regions(model, lift_mm)
    low, high = np.min([region.box_mm[0] for region in regions], axis=0), np.max([r.box_mm[1] for r in regions], axis=0)
    step = float((high - low).max()) / (2 * _GRID_CELLS)
    middle = (low + high) / 2
    count = int(np.ceil((high - low)[0] / 2 / step - 1e-9))
    x, y = middle[0] + step * np.arange(-count, count + 1), np.arange(low[1], high[1] + step, step)
    found = _largest_rectangle(_in_any(regions, np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)))
    if found is None:
        raise PlanError(
            f"arm {model.arm.name} has no usable canvas: nowhere is the paper reached pen down and pen up"
            f" ({lift_mm:g} mm) within the joint limits"
        )
    i0, i1, j0, j1 = found
    sides = np.array([x[i0], x[i1], y[j0], y[j1]])
    grow = step * np.array([-1.0, 1.0, -1.0, 1.0])
    while np.abs(grow).max() > 0.005:  # push each side out as far as it goes
        moved = False
        for side in range(4):
            trial = sides.copy()
            trial[side] += grow[side]
            if _in_any(regions, _border(trial)).all():
                sides, moved = trial, True
        if not moved:
            grow /= 2
    near, far, right, left = map(float, sides)
    return Canvas(CanvasKind.USABLE, near, far, right, left)


def canvas_of(model: ArmModel, kind: CanvasKind, lift_mm: float) -> Canvas:
    """The canvas of that kind. Errors: PlanError where there is none."""

    def sides() -> Arrays:
        canvas = _canvas_of(model, kind, lift_mm)
        return {"sides_mm": np.array([canvas.near_mm, canvas.far_mm, canvas.right_mm, canvas.left_mm])}

    return Canvas(kind, *model.kept(f"{kind} canvas, {lift_mm!r} mm", sides)["sides_mm"].tolist())


def _canvas_of(model: ArmModel, kind: CanvasKind, lift_mm: float) -> Canvas:
    if kind is CanvasKind.USABLE:
        return usable_canvas(model, lift_mm)
    r_max = geometric_reach_mm(model)
    r_min = max(model.arm.workspace.inner_radius_mm, min(float(branch.radii_mm[0]) for branch in model.rings()))
    return (documented_canvas if kind is CanvasKind.DOCUMENTED else optimal_canvas)(r_max, r_min)


class _Region(Protocol):
    """A part of the paper that one branch of an arm draws on."""

    @property
    def box_mm(self) -> FloatArray:
        """(2, 2) corners that it lies between."""
        ...

    def contains(self, points_mm: FloatArray) -> BoolArray:
        """(...) of points (..., 2)."""
        ...


def _regions(model: ArmModel, lift_mm: float) -> Sequence[_Region]:
    rings = model.rings()
    if rings:
        return [_Sector.of(ring, rings[0].ahead_rad, lift_mm) for ring in rings]
    patches = [_Patch.of(branch, lift_mm) for branch in model.branches()]
    base = model.arm.paper.T_paper_base
    if base[2, 2] < _LEVEL:  # a board, or a ceiling: nothing stands on it
        return patches
    before = [patch.beyond(float(base[0, 3])) for patch in patches]  # the base stands beside the paper
    return before if any(patch.good.any() for patch in before) else patches


@dataclass(frozen=True, eq=False, slots=True)
class _Patch:
    """Where the map's configurations are within limits: the squares all of whose corners (columns, rows) are so."""

    box_mm: FloatArray
    step_mm: float
    good: BoolArray

    @staticmethod
    def of(branch: ConfigurationMap, lift_mm: float) -> _Patch:
        low, high = branch.box_mm
        step_mm = float((high - low).max()) / _SQUARES
        counts = np.ceil((high - low) / step_mm) + 1
        x, y = (start + step_mm * np.arange(count) for start, count in zip(low, counts, strict=True))
        points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        rows = np.flatnonzero(branch.reaches(points))
        for height in np.linspace(0.0, lift_mm, _HEIGHTS_OF_SQUARES):
            tips = np.column_stack((points[rows], np.full(len(rows), height)))
            configurations, kept = branch.configurations_at(tips)
            rows = rows[kept & (branch.kinematics.clearance.least_mm(configurations)[0] >= KEPT_MM)]
        good = np.zeros(len(points), dtype=np.bool_)
        good[rows] = True
        return _Patch(branch.box_mm, step_mm, good.reshape(len(x), len(y)))

    def beyond(self, x_mm: float) -> _Patch:
        """What of it lies beyond that x."""
        x = self.box_mm[0, 0] + self.step_mm * np.arange(len(self.good))
        return replace(self, good=self.good & (x >= x_mm)[:, None])

    def contains(self, points_mm: FloatArray) -> BoolArray:
        at = (points_mm - self.box_mm[0]) / self.step_mm
        first = np.clip(np.floor(at).astype(np.int64), 0, np.array(self.good.shape) - 2)
        inside: BoolArray = ((at >= 0) & (at <= np.array(self.good.shape) - 1)).all(axis=-1)
        for i in range(2):
            for j in range(2):
                inside &= self.good[first[..., 0] + i, first[..., 1] + j]
        return inside


@dataclass(frozen=True, eq=False, slots=True)
class _Sector:
    """Where the map's configurations are within limits: for each radius an interval of azimuth, as far as it is on the
    side of the base that is `ahead_rad`; for the base stands beside the paper."""

    ring: RingMap
    ahead_rad: float
    radii_mm: FloatArray
    from_rad: FloatArray
    to_rad: FloatArray

    @staticmethod
    def of(ring: RingMap, ahead_rad: float, lift_mm: float) -> _Sector:
        level = replace(ring, kinematics=ring.level)
        arm, kinematics = level.arm, level.kinematics
        radii = np.linspace(ring.radii_mm[0], ring.radii_mm[-1], _RADIAL_STEPS)
        low, high = np.full(len(radii), -np.inf), np.full(len(radii), np.inf)
        for height in np.linspace(0.0, lift_mm, _HEIGHTS):
            tips = np.column_stack((radii, np.zeros_like(radii), np.full_like(radii, height)))
            independent, exact = project(kinematics, level.reference(tips), tips)
            # The first joint, which turns the whole of it, is what the azimuth is bounded by.
            good = exact & (beyond_limits(arm, arm.complete(independent))[:, 1:] <= SLACK).all(axis=1)
            good &= kinematics.clearance.least_mm(independent)[0] >= KEPT_MM
            at_zero = independent[:, 0] - level.polar(tips)[1]
            low = np.where(good, np.maximum(low, arm.minimum[0] - at_zero), np.inf)
            high = np.where(good, np.minimum(high, arm.maximum[0] - at_zero), -np.inf)
        return _Sector(ring, ahead_rad, radii, low, high)

    @property
    def box_mm(self) -> FloatArray:
        return self.ring.box_mm

    def contains(self, points_mm: FloatArray) -> BoolArray:
        tips_mm = np.concatenate((points_mm, np.zeros_like(points_mm[..., :1])), axis=-1)
        radius, azimuth = self.ring.polar(tips_mm)
        after = np.clip(np.searchsorted(self.radii_mm, radius), 1, len(self.radii_mm) - 1)
        inside: BoolArray = (radius >= self.radii_mm[0]) & (radius <= self.radii_mm[-1])
        inside &= np.cos(azimuth - self.ahead_rad) >= -_ROUNDING
        for node in (after - 1, after):  # both neighbours have to agree
            inside &= (azimuth >= self.from_rad[node]) & (azimuth <= self.to_rad[node])
        return inside


def _in_any(regions: Sequence[_Region], points_mm: FloatArray) -> BoolArray:
    inside: BoolArray = np.any([region.contains(points_mm) for region in regions], axis=0)
    return inside


def _border(sides: FloatArray) -> FloatArray:
    """(n, 2) dense points on the border of a rectangle (x0, x1, y0, y1)."""
    x0, x1, y0, y1 = sides
    x, y = np.linspace(x0, x1, 400), np.linspace(y0, y1, 800)
    lines = ((x, y0), (x, y1), (x0, y), (x1, y))
    return np.concatenate([np.column_stack(np.broadcast_arrays(*line)) for line in lines])


def _largest_rectangle(mask: BoolArray) -> tuple[int, int, int, int] | None:
    """First and last row and column of the largest all-true block: for each row the largest rectangle under
    its histogram of true runs."""
    heights = np.zeros(mask.shape[1] + 1, dtype=np.int64)
    best, found = 0, None
    for row, line in enumerate(mask):
        heights[:-1] = np.where(line, heights[:-1] + 1, 0)
        stack: list[tuple[int, int]] = []
        for column, height in enumerate(heights.tolist()):
            start = column
            while stack and stack[-1][1] >= height:
                start, tall = stack.pop()
                area = (tall - 1) * (column - 1 - start)
                if area > best:
                    best, found = area, (row - tall + 1, row, start, column - 1)
            stack.append((start, height))
    return found
