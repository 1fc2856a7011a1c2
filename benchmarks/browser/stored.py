"""References kept in files beside their drawings, so that tests need no browser.

python -m benchmarks.browser.stored tests/drawing/pages/*.svg    # paint them again
"""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import shapely

from planner.arrays import FloatArray

from .chromium import Chromium
from .reference import Reference, reference

_DIGITS = 2
_SIMPLER_PX = 0.02


def write(found: Reference, file: Path) -> None:
    """Lines simplified by a fiftieth of a pixel, a line of the file each."""
    kept = {
        "size_px": [round(side, 4) for side in found.size_px],
        "lines": _packed(found.lines),
        "sure": _packed(found.sure),
        "text_boxes": _packed(found.text_boxes),
    }
    file.write_text("{\n" + ",\n".join(f'"{name}": {_text(what)}' for name, what in kept.items()) + "\n}\n")


def read(file: Path) -> Reference:
    kept = json.loads(file.read_text())
    lines, sure, boxes = ([np.array(line) for line in kept[name]] for name in ("lines", "sure", "text_boxes"))
    return Reference((kept["size_px"][0], kept["size_px"][1]), lines, sure, boxes)


def _packed(lines: Sequence[FloatArray]) -> list[list[list[float]]]:
    simple = [
        shapely.get_coordinates(shapely.LineString(line).simplify(_SIMPLER_PX)) if len(line) > 2 else line
        for line in lines
    ]
    return [np.round(line, _DIGITS).tolist() for line in simple]


def _text(what: list[float] | list[list[list[float]]]) -> str:
    rows = [json.dumps(row, separators=(",", ":")) for row in what]
    return "[\n" + ",\n".join(rows) + "\n]" if rows else "[]"


def main(files: Sequence[str]) -> None:
    with Chromium() as browser:
        for file in map(Path, files):
            write(reference(browser, file.read_bytes()), file.with_suffix(".json"))
            print(f"wrote {file.with_suffix('.json')}")


if __name__ == "__main__":
    main(sys.argv[1:])
