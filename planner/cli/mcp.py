"""`plan mcp`: tools for agents."""

from __future__ import annotations

from planner import DISTRIBUTION
from planner.cli.files import output_file
from planner.cli.parser import Parser
from planner.cli.serve import default_folder
from planner.errors import UsageError

_DESCRIPTION = """\
Serve tools to agents by the Model Context Protocol, on standard input and output: plan a drawing, look at what the arm
will make of it, check it, and run it on the simulated arm. A real arm moves only with --real-arm, and when a person at
the terminal agrees to each run."""

_EPILOG = """\
examples:
  plan mcp                     as the command of a server in the settings of an agent
  plan mcp --real-arm          where somebody sits at the terminal"""


def mcp(arguments: list[str]) -> int:
    """Serve until standard input ends. Errors: PlannerError."""
    parser = Parser("plan mcp", _DESCRIPTION, _EPILOG)
    parser.add_argument(
        "--folder", type=output_file, metavar="DIR", help="where drawings are kept (default: of this user)"
    )
    parser.add_argument("--real-arm", action="store_true", help="offer real arms, each run of which a person agrees to")
    options = parser.parse_args(arguments)
    try:
        from planner.serve.agent import agent_server
    except ImportError:
        raise UsageError(f"agents need the extra 'mcp': pip install '{DISTRIBUTION}[mcp]'") from None
    from hardware.drivers.table import DRIVERS, SIMULATORS
    from planner.serve.house import House

    house = House(options.folder or default_folder(), DRIVERS if options.real_arm else SIMULATORS)
    agent_server(house, real_arm=options.real_arm).run("stdio")
    return 0
