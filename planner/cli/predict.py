"""`plan predict`: how well an arm is going to draw a trajectory."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from planner.cli.files import input_file, output_file
from planner.cli.output import check_target
from planner.cli.parser import Parser
from planner.cli.terminal import print_summary, waiting
from planner.errors import UsageError

if TYPE_CHECKING:
    from planner.arms.arm import Arm
    from planner.error_model.prediction import Prediction
    from planner.trajectory import Trajectory

_DESCRIPTION = """\
Say how far from its lines an arm is going to draw a trajectory, and how much of the ink is going to be missing: the
arm with the errors that its file leaves open, slack taken up and lag led as plan run does, played many times."""

_EPILOG = """\
examples:
  plan predict traj.csv --arm my_arm_2.toml
  plan predict traj.csv --arm my_arm_2.toml --json
  plan predict traj.csv --plot expected.png"""


def predict(arguments: list[str]) -> int:
    """Predict one trajectory. Errors: PlannerError."""
    parser = Parser("plan predict", _DESCRIPTION, _EPILOG)
    parser.add_argument("trajectory", type=input_file, metavar="traj.csv", help="- for standard input")
    parser.add_argument("--arm", metavar="NAME|FILE", help="the arm (default: the one in the trajectory)")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="of what is random (default: %(default)s)")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    parser.add_argument(
        "--plot",
        type=output_file,
        metavar="FILE",
        help="also draw it: the lines with the band that 95 of 100 arms stay in, where ink may be missing, a map of "
        "the error over the paper, and what it comes from; .png, .svg or .pdf",
    )
    options = parser.parse_args(arguments)
    if options.seed < 0:
        raise UsageError(f"--seed {options.seed}: seeds are 0 or more")
    if options.plot:
        from planner.plots.figure_file import picture_format

        picture_format(options.plot)
        check_target(options.plot, options.trajectory)

    from planner.arms.arm_file import load_arm
    from planner.trajectory import read_trajectory

    with waiting("playing it many times", quiet=False):
        trajectory = read_trajectory(options.trajectory)
        arm = load_arm(options.arm or trajectory.arm)
        figures = prediction_of(arm, trajectory, options.trajectory, options.seed)
    if options.plot:
        from planner.plots.expected import plot_expected
        from planner.plots.figure_file import save_figure

        heading = trajectory.title
        save_figure(plot_expected(figures, heading, f"on {arm.name}: {figures.summary()}"), options.plot)
    lines = [json.dumps(figures.as_dict(), indent=2)] if options.json else figures.lines()
    print_summary(lines, *filter(None, [options.plot]))
    return 0


def prediction_of(arm: Arm, trajectory: Trajectory, source: Path, seed: int) -> Prediction:
    """The prediction for a trajectory from the file `source`, played as plan run plays it. Errors: PlannerError."""
    from hardware.compensation.servo_values import own_calibration
    from hardware.playback.compensated import compensated
    from hardware.playback.preflight import set_points
    from hardware.playback.program import make_program
    from planner.error_model.prediction import Played, predicted

    positions = set_points(trajectory, arm, source)
    program = make_program(arm, positions, trajectory.stroke, trajectory.rate_hz, park=arm.park)
    program = compensated(arm, program, own_calibration(arm))
    return predicted(arm, Played(program.positions, program.meant, program.stroke, program.rate_hz), seed)
