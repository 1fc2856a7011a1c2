"""What the page shows of arms and trajectories, worked out in a process of its own:

`python -m planner.serve.view arm NAME FILE`, `python -m planner.serve.view film traj.csv FILE`.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from planner.arms.arm_file import load_arm
from planner.errors import PlannerError
from planner.files import written_aside
from planner.trajectory import read_trajectory


def main(arguments: list[str]) -> int:
    kind, source, target = arguments
    try:
        if kind == "arm":
            from planner.serve.arm_view import arm_view

            view = arm_view(load_arm(source))
        else:
            from planner.serve.film_view import film_view

            trajectory = read_trajectory(Path(source))
            view = film_view(trajectory, load_arm(trajectory.arm))
        with written_aside(Path(target)) as file:
            json.dump(view, file)  # type: ignore[arg-type]
    except PlannerError as error:
        print(f"plan: error: {error}", file=sys.stderr)
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
