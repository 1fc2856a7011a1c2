"""`--workers`: how many processes, or which cluster, do the work."""

from __future__ import annotations

import argparse
import os
import re

from planner.execution.workers import Workers

_CLUSTER = re.compile(r"(?:tcp|tls)://[^\s/]+:\d+")
_MOST = 1024


def add_workers_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--workers",
        type=_workers,
        default=Workers(_cores()),
        metavar="N|tcp://HOST:PORT",
        help="processes that share the work, or a Dask cluster that does it; the result is the same"
        f" (default: as many as cores, {_cores()} here)",
    )


def _workers(text: str) -> Workers:
    if _CLUSTER.fullmatch(text):
        return Workers(cluster=text)
    if not (text.isascii() and text.isdigit() and 1 <= int(text) <= _MOST):
        raise argparse.ArgumentTypeError(
            f"'{text}' is neither a number of processes from 1 to {_MOST} nor a cluster, tcp://HOST:PORT"
        )
    return Workers(int(text))


def _cores() -> int:
    """The cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
