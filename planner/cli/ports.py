"""`plan ports`: the serial devices that are plugged in."""

from __future__ import annotations

from planner.cli.parser import Parser
from planner.cli.terminal import print_lines

_DESCRIPTION = """\
List the serial devices that are plugged in, with what each is likely to be, for `plan run --port`. A port may also be
a URL, such as socket://10.0.0.7:2000 or rfc2217://10.0.0.7:2217 for an arm behind a network bridge."""

_EPILOG = """\
example:
  plan ports"""


def ports(arguments: list[str]) -> int:
    """List serial devices. Errors: PlannerError."""
    Parser("plan ports", _DESCRIPTION, _EPILOG).parse_args(arguments)

    from hardware.drivers.usb_ids import likely_controller
    from hardware.port import plugged_in

    rows = [(port.device, port.description, likely_controller(port.usb_id)) for port in plugged_in()]
    widths = [max((len(row[column]) for row in rows), default=0) for column in (0, 1)]
    print_lines(
        [
            f"{device:<{widths[0]}}  {description:<{widths[1]}}  {likely}".rstrip()
            for device, description, likely in rows
        ]
        or ["nothing is plugged in"]
    )
    return 0
