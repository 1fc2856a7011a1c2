"""What a phone sees of a printed sheet that a true arm has drawn on, and how well it is read."""

from __future__ import annotations

import csv
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np

from hardware.jog.adjustments import paper_under
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.error_model.sheet.layout import sheet_for
from planner.error_model.sheet.marks import read_marks
from tests.error_model.photo.rendering import Camera, Ink, drawn_sheet, photograph
from tests.judge.inking import inked
from tests.judge.playing import Record, play, read_record
from tests.judge.true_arm import TrueArm

_ASTRAY_MM = 2.0


@dataclass(frozen=True)
class Sheet:
    """Files of one sheet: what `plan pattern`, `plan run` and `plan measure` write, and the photo."""

    name: str

    def file(self, kind: str) -> Path:
        return Path(f"{self.name}_{kind}")


def photograph_sheet(true: TrueArm, sheet: Sheet, camera: Camera, seed: int) -> None:
    """Writes photo.jpg of a sheet that was drawn."""
    marks = read_marks(sheet.file("marks.csv"))
    ink = [Ink(trace.points_mm, trace.width_mm) for trace in inked(true, read_record(sheet.file("pulses.csv")))]
    paper = drawn_sheet(sheet.file("sheet.pdf"), sheet_for(marks).origin_page_mm, ink)
    away = replace(camera, azimuth_deg=float(np.random.default_rng(seed).uniform(0, 360)))
    cv2.imwrite(str(sheet.file("photo.jpg")), photograph(paper, away, seed), [cv2.IMWRITE_JPEG_QUALITY, 95])


def on_a_card(arm: Arm, true: TrueArm, record: Record, marks: Path, depth_mm: float, sd_mm: float, seed: int) -> Arm:
    """The arm whose pen was set on a card in the middle of its marks, as `plan jog` does, good to sd_mm.

    depth_mm: how deep below the paper it meant its marks to be.
    """
    listed = read_marks(marks)
    places = np.array([mark.place_mm for mark in listed])
    middle = int(np.argmin(np.hypot(*(places - places.mean(axis=0)).T)))
    tip = true.tip_mm(play(true, record, np.array([listed[middle].t_s])))[0, 2]
    height = float(tip + depth_mm + np.random.default_rng(seed).normal(0.0, sd_mm))
    return paper_under(arm, np.array([0.0, 0.0, -height]), 0.0)


@dataclass(frozen=True)
class Read:
    """How a photo was read.

    inked, found, astray: numbers of marks that left ink, that were found, and of these that are more than 2 mm off:
    another mark was taken for them, or other ink. place_mm: rms of the others. begins, begin_mm: of how many the
    beginning was seen within 1 mm, and the rms of these.
    """

    inked: int
    found: int
    astray: int
    place_mm: float
    begins: int
    begin_mm: float


def read_well(true: TrueArm, sheet: Sheet) -> Read:
    """measured.csv against where the true arm's marks are."""
    record, marks = read_record(sheet.file("pulses.csv")), read_marks(sheet.file("marks.csv"))
    tips = true.tip_mm(play(true, record, np.array([mark.t_s for mark in marks])))
    with sheet.file("measured.csv").open() as file:
        rows = list(csv.DictReader(file))
    off = np.array([np.hypot(*(tips[int(row["mark"]), :2] - (float(row["x_mm"]), float(row["y_mm"])))) for row in rows])
    right = off < _ASTRAY_MM
    begins = _begins_off(
        true, record, [row for row, is_right in zip(rows, right, strict=True) if is_right and row["h_mm"]]
    )
    return Read(
        int((tips[:, 2] <= 0).sum()),
        len(rows),
        int((~right).sum()),
        _rms(off[right]),
        int((begins < _ASTRAY_MM / 2).sum()),
        _rms(begins[begins < _ASTRAY_MM / 2]),
    )


def _begins_off(true: TrueArm, record: Record, rows: list[dict[str, str]]) -> FloatArray:
    """(n,) how far from where it touched down each stroke was seen to begin."""
    around_s = np.arange(-0.75, 0.75, 0.005)
    moments = np.array([[float(row["touch_t_s"])] for row in rows]) + around_s
    order = np.argsort(moments, axis=None)
    ways = np.empty((moments.size, 3))
    ways[order] = true.tip_mm(play(true, record, moments.ravel()[order]))  # the whole record once
    ways = ways.reshape(*moments.shape, 3)
    down = np.argmax(ways[..., 2] <= 0, axis=1)
    seen = np.array([(float(row["touch_x_mm"]), float(row["touch_y_mm"])) for row in rows])
    return np.asarray(np.hypot(*(ways[np.arange(len(rows)), down, :2] - seen).T), np.float64)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0
