"""File names on the command line, as types of arguments: `-` is standard input or output, and some are no names."""

from __future__ import annotations

import argparse
from pathlib import Path

from planner.files import STANDARD

STANDARD_INPUT = Path("/dev/stdin")


def input_file(text: str) -> Path:
    """A file that is read; `-` is standard input."""
    return STANDARD_INPUT if text == STANDARD else output_file(text)


def output_file(text: str) -> Path:
    """A file or folder that is written; a file `-` is standard output, see `is_standard_output`."""
    if not text:
        raise argparse.ArgumentTypeError("the file name is empty")
    if "\0" in text:
        raise argparse.ArgumentTypeError("no file name holds a zero byte")
    return Path(text)
