"""`plan run` as it is, but for time and line, which are a bench's."""

from __future__ import annotations

from unittest import mock

from planner.cli import main
from tests.hardware.controllers.bench import Bench


def plan_run(bench: Bench, *arguments: str) -> int:
    """The exit code of `plan run`, with `--port` at the bench, by a name that other runs may use as well."""

    def line(name: str, baud: int | None) -> Bench:
        return bench

    with (
        mock.patch("planner.cli.run_playing.Line", line),
        mock.patch("planner.cli.run_playing.WallClock", return_value=bench),
    ):
        return main(["run", *arguments, "--port", "loop://"])
