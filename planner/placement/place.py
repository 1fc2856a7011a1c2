"""Where on the paper a drawing goes: from SVG user units to arm millimetres.

A drawing is turned on its page, a box of it (its page, or the extent of its ink) is scaled and moved, and whatever
ink there is goes with the box. So drawings of one page land in register, whatever each of them holds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from planner.affine import compose, rotation
from planner.arrays import FloatArray, frozen
from planner.counted import counted
from planner.drawing.copies import Copies
from planner.drawing.drawing import Drawing, Outline
from planner.drawing.fill_options import FillKind
from planner.drawing.flatten import extent
from planner.drawing.image_options import ImageStyle
from planner.errors import DoesNotFit, UsageError
from planner.head import Placement
from planner.placement.board import Board, board_of
from planner.placement.motions import Motion
from planner.settings import PlaceKind, PlanSettings
from planner.workspace.canvas import Canvas

_ROUNDING_MM = 0.01
"""Programs round the size of the page."""
_LEAST_MM = 0.1
"""What is smaller is a dot."""
_WORTH_A_HINT = 1.25
"""How much larger a drawing has to become for a turn to be recommended."""
_PAGE_TO_ARM = np.array([[0.0, -1.0], [-1.0, 0.0]])
_AS_IT_IS = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
_MIRROR = np.array([[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


@dataclass(frozen=True, eq=False, slots=True)
class Placed:
    """svg_to_arm: (2, 3) of the first copy. drawing: with all copies. told: for the header. scale: mm on paper for one
    on the page. size_mm: width and height of the ink of one copy. won: what its place wins. notes: what to say of
    it."""

    svg_to_arm: FloatArray
    drawing: Drawing
    told: Placement
    scale: float
    size_mm: tuple[float, float]
    canvas: Canvas
    board: Board
    notes: tuple[str, ...]
    won: str = ""


@dataclass(frozen=True, eq=False, slots=True)
class _Box:
    """Corners (2,) on the turned page, mm."""

    low: FloatArray
    high: FloatArray

    @property
    def size(self) -> FloatArray:
        return self.high - self.low


def placed(drawing: Drawing, canvas: Canvas, settings: PlanSettings, motion: Motion | None = None) -> Placed:
    """Where a drawing goes by the settings, and by a motion from there. Errors: UsageError where a margin leaves no
    room, DoesNotFit where ink would be beyond the paper or the canvas, unless what is out of reach is left out
    anyway."""
    pictures = _frames(drawing)
    turned, ink, box = _turned(drawing, settings)
    board = board_of(canvas, settings.paper, settings.orientation, settings.margin_mm, bool(box.size[0] > box.size[1]))
    counts = np.array(settings.copies)
    cell = (np.array(board.room_mm) - (counts - 1) * settings.margin_mm) / counts
    if (cell <= 0.0).any():
        raise UsageError(
            f"{counts[0]} x {counts[1]} copies leave no room for the drawing: ask for fewer, or for a smaller --margin"
        )
    if settings.scale and settings.scale * ink.size.max() < _LEAST_MM < ink.size.max():
        raise UsageError(f"a scale of {settings.scale:g} leaves nothing to see of the drawing: choose a larger one")
    factor = settings.scale or (_filling(box.size, cell) if settings.is_fitted else 1.0)
    step = (cell if settings.is_fitted else factor * box.size) + settings.margin_mm
    corner = _corner(board, canvas, factor * box.size, cell, (counts - 1) * step + factor * box.size, settings)
    onto_arm = compose(
        np.column_stack((_PAGE_TO_ARM, (canvas.far_mm, canvas.left_mm))),
        np.column_stack((factor * np.eye(2), corner - factor * box.low)),
    )
    svg_to_arm = frozen(compose(onto_arm, turned))
    inked = _Box(corner + factor * (ink.low - box.low), corner + factor * (ink.high - box.low) + (counts - 1) * step)
    turn_deg = settings.rotate_deg
    if motion is not None:
        svg_to_arm = frozen(compose(motion.matrix, svg_to_arm))
        turn_deg = (turn_deg + motion.turn_deg + 180.0) % 360.0 - 180.0
        low, high = extent(inked_outlines(drawing), svg_to_arm)
        corner = np.array([canvas.left_mm, canvas.far_mm])
        inked = _Box(corner - high[::-1], corner - low[::-1])
    # A page at its true size has margins of its own, and what is put somewhere by hand has none.
    if not settings.is_fitted and (box is not ink or settings.at_mm is not None):
        board = replace(board, margin_mm=0.0)
    beyond = _beyond(inked, board, canvas)
    if beyond and not settings.skip_unreachable:
        raise DoesNotFit(beyond)
    rectangle = board.rectangle
    sides = (rectangle.near_mm, rectangle.far_mm, rectangle.right_mm, rectangle.left_mm)
    copies = Copies(int(counts[0]), int(counts[1]), float(step[0]), float(step[1]))
    told = Placement(
        canvas_mm=None if beyond else sides,
        margin_mm=None if beyond else board.margin_mm,
        scale=factor,
        rotate_deg=turn_deg,
        mirror=settings.mirror,
        copies=copies if copies.count > 1 else None,
    )
    if settings.fill.draws_anything:
        from planner.drawing.fill.fill import with_fills

        drawing = with_fills(drawing, settings.fill, svg_to_arm)
    if pictures:
        from planner.drawing.image.lines import with_images

        drawing = with_images(drawing, svg_to_arm)
    hints = _turning(box.size, cell, factor, settings.rotate_deg) if settings.is_fitted and motion is None else []
    hints += _filling_hint(drawing) if settings.fill.kind is FillKind.NONE else []
    if drawing.reading.image.is_on and not settings.reading.image.is_on:
        hints += [_style_hint(drawing.reading.image.style)]
    width, height = inked.size if motion is not None else factor * ink.size
    size_mm = float(width), float(height)
    return Placed(svg_to_arm, copies.of(drawing, svg_to_arm), told, factor, size_mm, canvas, board, tuple(hints))


def box_size_mm(drawing: Drawing, settings: PlanSettings) -> tuple[float, float]:
    """Width and height of what is placed of a drawing, turned and scaled by the settings but not fitted."""
    width, height = (settings.scale or 1.0) * _turned(drawing, settings)[2].size
    return float(width), float(height)


def _turned(drawing: Drawing, settings: PlanSettings) -> tuple[FloatArray, _Box, _Box]:
    """From user units to the turned page, (2, 3), and the boxes on it of the ink and of what is placed."""
    turn = compose(rotation(settings.rotate_deg), _MIRROR if settings.mirror else _AS_IT_IS)
    turned = compose(turn, drawing.user_to_page)
    ink = _Box(*extent(inked_outlines(drawing), turned))
    is_page = settings.place is not PlaceKind.INK and drawing.has_page
    return turned, ink, _page_box(drawing, turn) if is_page else ink


def inked_outlines(drawing: Drawing) -> list[Outline]:
    """All that there may be ink within: the outlines, and what goes around pictures."""
    return [*drawing.outlines, *_frames(drawing)]


def _frames(drawing: Drawing) -> list[Outline]:
    """Around the pictures that are drawn."""
    if drawing.scene is None or not any(shape.pixels for shape in drawing.scene.shapes):
        return []
    from planner.drawing.image.lines import frames

    return frames(drawing)


def _page_box(drawing: Drawing, turn: FloatArray) -> _Box:
    width, height = drawing.page_mm
    corners = np.array([(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]) @ turn[:, :2].T
    return _Box(corners.min(axis=0), corners.max(axis=0))


def _filling(size: FloatArray, cell: FloatArray) -> float:
    """What a box is scaled by to fill a cell; 1 for a dot, which has no size."""
    with np.errstate(divide="ignore", over="ignore"):
        factor = float(np.min(cell / size))
    return factor if np.isfinite(factor) else 1.0


def _corner(
    board: Board, canvas: Canvas, size: FloatArray, cell: FloatArray, whole: FloatArray, settings: PlanSettings
) -> FloatArray:
    """(2,) where the top left corner of the first copy goes, in canvas mm. whole: what all copies take."""
    if settings.at_mm is not None:
        sheet = board.sheet or board.rectangle
        begin = np.array([canvas.left_mm - sheet.left_mm, canvas.far_mm - sheet.far_mm])
        corner: FloatArray = begin + settings.at_mm - settings.origin.fractions * whole
        return corner
    spare = cell - size if settings.is_fitted else np.array(board.room_mm) - whole
    corner = _room_corner(board, canvas)
    corner += settings.align.fractions * spare
    return corner


def _room_corner(board: Board, canvas: Canvas) -> FloatArray:
    rectangle = board.rectangle
    return board.margin_mm + np.array([canvas.left_mm - rectangle.left_mm, canvas.far_mm - rectangle.far_mm])


def _beyond(inked: _Box, board: Board, canvas: Canvas) -> str:
    """What is wrong where ink is beyond the room that there is, or nothing."""
    low = _room_corner(board, canvas)
    high = low + board.room_mm
    over_mm = np.concatenate((low - inked.low, inked.high - high))
    if (over_mm <= _ROUNDING_MM).all():
        return ""
    what = f"the {board.size} sheet" if board.size else "the canvas"
    if board.sheet is not None and board.sheet != board.rectangle:
        what += ", as far as the arm reaches,"
    width, height = board.room_mm
    room = f"{what} has {width:.1f} x {height:.1f} mm within its margin"
    if (inked.size > np.array(board.room_mm) + _ROUNDING_MM).any():
        return (
            f"the drawing is {inked.size[0]:.1f} x {inked.size[1]:.1f} mm, and {room}: use --fit, a smaller --scale or"
            " --margin, --rotate, --skip-unreachable, or --tile, which takes several sheets"
        )
    worst = int(np.argmax(over_mm))
    side = ("left", "top", "right", "bottom")[worst]
    return (
        f"the drawing's ink goes {over_mm[worst]:.1f} mm over the {side} side, though {room}: use --place ink, --align,"
        " another --at or --skip-unreachable"
    )


def _turning(size: FloatArray, cell: FloatArray, factor: float, rotate_deg: float) -> list[str]:
    larger = _filling(size[::-1], cell) / factor
    other_deg = (rotate_deg + 90.0) % 180.0
    return [f"--rotate {other_deg:g} would make it {larger:.2g} times as large"] if larger >= _WORTH_A_HINT else []


def _style_hint(style: ImageStyle) -> str:
    others = ", ".join(other for other in ImageStyle if other not in (style, ImageStyle.NONE))
    return f"the picture is drawn as with --image {style}; there are {others} too"


def _filling_hint(drawing: Drawing) -> list[str]:
    if drawing.scene is None:
        return []
    from planner.drawing.fill.areas import n_areas

    n_filled = n_areas(drawing.scene)
    return [f"{counted(n_filled, 'filled shape')} drawn by the edge alone; --fill hatch fills"] if n_filled else []
