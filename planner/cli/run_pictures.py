"""`plan run --picture FILE`: what the simulated arm drew, by itself or beside what was wanted."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from hardware.motion.tip import tips_mm
from hardware.simulation.ink import drawn_lines, write_svg
from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.cli.output import check_target
from planner.cli.run_job import Job


def check_pictures(targets: Sequence[Path], source: Path) -> None:
    """Errors: OutputError, UsageError (unknown suffix)."""
    for target in targets:
        check_target(target, source)
        if not _is_svg(target):
            from planner.plots.figure_file import picture_format

            picture_format(target)


def save_pictures(
    targets: Sequence[Path],
    job: Job,
    true_arm: Arm,
    positions: FloatArray,
    heights_mm: FloatArray,
    first_stroke: int,
) -> list[str]:
    """Write what was drawn as the joints of `true_arm` went through `positions` (n, n_joints), rad or mm, with pens
    that stick out by `heights_mm` (n,); its drawing error in words.

    An .svg holds what was drawn at its true size, any other picture shows it beside what was wanted from
    `first_stroke` on. Errors: OutputError.
    """
    from planner.checking.drawing_error import drawing_error

    drawn = drawn_lines(true_arm, positions, heights_mm)
    wanted = list(_wanted(job, first_stroke))
    text = drawing_error(drawn, wanted).text()
    for target in targets:
        if _is_svg(target):
            write_svg(drawn, target)
        else:
            from planner.plots.drawing_error import plot_drawing_error
            from planner.plots.figure_file import save_figure

            heading = job.trajectory.title
            save_figure(plot_drawing_error(wanted, drawn, heading, f"drawn on {job.arm.name}: {text}"), target)
    return [f"what was drawn is {text}"]


def _is_svg(target: Path) -> bool:
    return target.suffix.lower() == ".svg"


def _wanted(job: Job, first_stroke: int) -> Iterator[FloatArray]:
    """The tip's path on the paper, stroke by stroke."""
    stroke = job.trajectory.stroke
    samples = np.flatnonzero(stroke >= first_stroke)
    heights_mm = job.trajectory.pen_heights_mm[samples]
    tip_mm = tips_mm(job.arm, job.positions[samples], heights_mm)[:, :2]
    begins = np.flatnonzero(np.diff(stroke[samples], prepend=-1))
    yield from np.split(tip_mm, begins[1:])
