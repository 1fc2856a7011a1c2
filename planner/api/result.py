"""What `planner.plan` returns: the trajectory with what it was planned from, so that it can judge and show itself."""

from __future__ import annotations

import html
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from planner.api.inputs import Progress, shown
from planner.checked import number_in, one_of
from planner.pictures import PlotKind, figure_of, film_page, film_to_file, motion_for_film
from planner.settings import PlanSettings

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from planner.arms.arm import Arm
    from planner.checking.check_result import CheckResult
    from planner.drawing.drawing import Drawing
    from planner.summary import PlanSummary
    from planner.trajectory import Trajectory

_FILM_DPI = 75
_FRAME_PIXELS = 560


@dataclass(frozen=True, eq=False, slots=True, repr=False)
class Plan:
    """A planned drawing. In a notebook it shows itself as a film.

    Attributes:
        trajectory: The samples.
        summary: Counts, lengths, times and warnings; ``summary.lines()`` are to read.
        drawing: As it was read.
        arm: What it was planned for.
        settings: How it was planned.
    """

    trajectory: Trajectory
    summary: PlanSummary
    drawing: Drawing
    arm: Arm
    settings: PlanSettings

    def __repr__(self) -> str:
        told = "; ".join(self.summary.lines())
        return f"<Plan of {self.trajectory.drawing} on {self.arm.name}: {told}>"

    def _repr_html_(self) -> str:
        """The film, in a frame of its own that can reach nothing else."""
        page = html.escape(film_page(self.trajectory, self.arm))
        return (
            f'<iframe srcdoc="{page}" sandbox="allow-scripts" width="100%" height="{_FRAME_PIXELS}"'
            ' style="border: 0"></iframe>'
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the trajectory as CSV, whole or not at all. Errors: OutputError."""
        self.trajectory.save(path)

    def to_frame(self) -> Any:
        """The samples as a pandas data frame, as `Trajectory.to_frame`."""
        return self.trajectory.to_frame()

    def check(self) -> CheckResult:
        """What the independent check says of it, with the drawing and the tolerance that it was planned with."""
        from planner.checking.check import check_trajectory

        return check_trajectory(self.trajectory, self.arm, self.drawing, self.settings.tolerance_mm)

    def plot(
        self,
        kind: str = "drawing",
        path: str | os.PathLike[str] | None = None,
        *,
        stroke: int | None = None,
        from_s: float | None = None,
        to_s: float | None = None,
    ) -> Figure:
        """A picture: "drawing", "speed", "error", "profiles", "phase" or "timeline".

        path: also write it there, as .png, .svg or .pdf. stroke: of "phase", which one, from 0. from_s, to_s: a part of
        "profiles" and "timeline". Errors: UsageError, OutputError.
        """
        from planner.plots.figure_file import picture_format, save_figure
        from planner.plots.look import USUAL

        wanted = one_of("kind", kind, PlotKind)
        if path is not None:
            picture_format(Path(path))
        figure = figure_of(
            self.trajectory,
            self.arm,
            wanted,
            USUAL,
            drawing=self.drawing,
            tolerance_mm=self.settings.tolerance_mm,
            stroke=stroke,
            from_s=from_s,
            to_s=to_s,
        )
        if path is not None:
            save_figure(figure, Path(path))
        return figure

    def film(
        self,
        path: str | os.PathLike[str],
        *,
        speed_factor: float | None = None,
        fps: float | None = None,
        progress: Progress = False,
    ) -> None:
        """Write a film: .html (one file with a player in it), .gif or .mp4.

        speed_factor: times as fast as the arm; None for its own speed, or what makes the film last 20 s. fps: pictures
        a second, 20 unless given. progress: as of `planner.plan`. Errors: UsageError, OutputError.
        """
        from planner.plots.film_file import film_format
        from planner.plots.look import Look

        film_format(Path(path))
        motion = motion_for_film(
            self.trajectory,
            self.arm,
            speed_factor=None if speed_factor is None else number_in("speed_factor", speed_factor, minimum=0.01),
            fps=None if fps is None else number_in("fps", fps, minimum=1, maximum=50),
        )
        with shown(progress) as show:
            film_to_file(motion, Path(path), Look.of(dpi=_FILM_DPI), show)
