"""`plan serve`: the page."""

from __future__ import annotations

import ipaddress
import secrets
import socket
from contextlib import suppress
from pathlib import Path

from planner import DISTRIBUTION
from planner.cli.files import output_file
from planner.cli.parser import Parser
from planner.cli.terminal import print_lines, print_note
from planner.errors import UsageError

_DESCRIPTION = """\
Serve a page on this machine: drop a drawing, place it on the arm's paper, plan it, watch it, and run it on the arm,
with a button that stops. It does what the commands do, and shows them. Other machines cannot reach it, unless --host
says so: then the address that is printed holds a token. Ctrl-C lifts the pen and parks the arm before it ends."""

_EPILOG = """\
examples:
  plan serve                           then open http://127.0.0.1:8200
  plan serve --demo                    without an arm: simulated ones alone
  plan serve --host 0.0.0.0            for others in the room, with a token"""

_PORT = 8200
_WAITING = 100
_TOKEN_BYTES = 24


def serve(arguments: list[str]) -> int:
    """Serve until interrupted. Errors: PlannerError."""
    options = _parser().parse_args(arguments)
    try:
        import starlette  # noqa: F401
        import uvicorn
    except ImportError:
        raise UsageError(f"the page needs the extra 'web': pip install '{DISTRIBUTION}[web]'") from None

    from hardware.drivers.table import DRIVERS, SIMULATORS
    from planner.serve.app import application
    from planner.serve.house import House

    alone = _is_loopback(options.host)
    token = None if alone and not options.token else options.token or secrets.token_urlsafe(_TOKEN_BYTES)
    names = frozenset({"localhost", options.host.lower(), socket.gethostname().lower()})
    house = House(options.folder or default_folder(), SIMULATORS if options.demo else DRIVERS)
    listening = _listening(options.host, options.port)
    port = listening.getsockname()[1]
    host = f"[{options.host}]" if ":" in options.host else options.host
    print_lines([f"http://{host}:{port}/" + (f"?token={token}" if token else "")])
    if not alone:
        print_note("warning: whoever has that address can move the arm")
    server = uvicorn.Server(
        uvicorn.Config(
            application(house, names, token),
            log_level="warning",
            access_log=False,
            server_header=False,
            timeout_graceful_shutdown=2,
        )
    )
    with suppress(KeyboardInterrupt):  # which uvicorn raises again once all is closed
        server.run(sockets=[listening])
    return 0


def _is_loopback(host: str) -> bool:
    try:
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _listening(host: str, port: int) -> socket.socket:
    """Errors: UsageError."""
    try:
        family = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0][0]
        listening = socket.socket(family, socket.SOCK_STREAM)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((host, port))
        listening.listen(_WAITING)  # from here on pages are answered, if only in a moment
    except OSError as error:
        raise UsageError(f"port {port} of {host} cannot be served: {error.strerror}; try another --port") from error
    return listening


def default_folder() -> Path:
    """Where drawings of this user are kept, by the rule of the platform."""
    import platformdirs

    return platformdirs.user_data_path(DISTRIBUTION, appauthor=False) / "page"


def _port(text: str) -> int:
    if not text.isdecimal() or int(text) > 65535:
        raise UsageError(f"--port is a number from 0 to 65535, not '{text:.20}'; 0 takes one that is free")
    return int(text)


def _parser() -> Parser:
    parser = Parser("plan serve", _DESCRIPTION, _EPILOG)
    parser.add_argument("--host", default="127.0.0.1", metavar="ADDRESS", help="to listen at (default: %(default)s)")
    parser.add_argument("--port", type=_port, default=_PORT, metavar="N", help="(default: %(default)s; 0: a free one)")
    parser.add_argument("--token", metavar="TEXT", help="that pages have to know (default: made up, with --host)")
    parser.add_argument(
        "--folder", type=output_file, metavar="DIR", help="where drawings are kept (default: of this user)"
    )
    parser.add_argument("--demo", action="store_true", help="simulated arms alone")
    return parser
