"""What Inkscape runs to save a document as a trajectory: it hands the document to `plan`, in the Python that has it.

Runs in Inkscape's own Python, with nothing but the standard library. Arguments: the parameters of drawing_arm.inx as
--NAME=VALUE, which are options of plan, and the document. The trajectory goes to standard output, and what plan says to
standard error, which Inkscape shows.
"""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

_NAME = "{http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd}docname"


def options_of(parameters: list[str]) -> list[str]:
    """The options of plan that parameters stand for; one that is empty, false or "default" stands for none. Errors:
    ValueError for a quotation mark without its other."""
    options = []
    for parameter in parameters:
        name, _, value = parameter.partition("=")
        if name == "--tab" or value in ("", "false", "default"):
            continue
        if name == "--more":
            options += shlex.split(value)
        elif value == "true":
            options.append(name)
        else:
            options.append(f"{name}={value}")
    return options


def name_of(document: Path) -> str:
    """What the document is called in Inkscape, which hands over a copy of it by another name."""
    try:
        _, root = next(ElementTree.iterparse(document, ["start"]))  # noqa: S314  # Inkscape wrote it
    except (ElementTree.ParseError, StopIteration):
        return document.name
    return Path(root.get(_NAME) or document.name).name


def main(arguments: list[str]) -> int:
    """The exit code of plan."""
    *parameters, document = arguments
    with open(Path(__file__).with_suffix(".json"), encoding="utf-8") as file:  # noqa: PTH123  # written by plan inkscape
        told = json.load(file)
    surroundings = {**os.environ, "PYTHONPATH": told["packages"]}  # Inkscape's own is for its extensions
    surroundings.pop("PYTHONHOME", None)
    with tempfile.TemporaryDirectory() as folder:
        try:
            options = options_of(parameters)
            copy = shutil.copy(document, Path(folder) / name_of(Path(document)))
            command = [told["python"], "-m", "planner", str(copy), "-o", "-", *options]
            window = getattr(subprocess, "CREATE_NO_WINDOW", 0)
            return subprocess.run(command, env=surroundings, creationflags=window, check=False).returncode
        except ValueError as error:
            print(f"plan: error: in the other options: {error}", file=sys.stderr)
        except OSError as error:
            print(f"plan: error: {error}; if the planner has moved, run 'plan inkscape' again", file=sys.stderr)
    return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
