"""A drawing, and others that differ from it by a little: the plan of one has to fail against another."""

from __future__ import annotations

DRAWING = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 60 40" width="60mm" height="40mm" fill="none" '
    'stroke="black" stroke-linecap="round"><path d="M0 0H60V40H0z"/><path d="M10 10C20 0 40 40 50 20"/>'
    '<path d="M30 20h0"/><path d="M12 30h1"/><path d="M40 35h.1"/></svg>'
)
"""A frame that keeps all of them in the same place, a curve, a tap, and strokes that are short and very short."""


def extra_plans(drawing: str) -> dict[str, str]:
    """Other drawings, of which the plan has to fail against the given one, an SVG whose first path is its frame."""
    end = drawing.index("</svg>")

    def added(paths: str) -> str:
        return drawing[:end] + paths + drawing[end:]

    return {
        "a tap six times": added('<path d="M30 20h0M30 20h0M30 20h0M30 20h0M30 20h0"/>'),
        "a tap twice": added('<path d="M30 20h0"/>'),
        "a tap too much": added('<path d="M44 11h0"/>'),
        "a short stroke twice": added('<path d="M12 30h1"/>'),
        "a tenth of a millimetre twice": added('<path d="M40 35h.1"/>'),
        "a part of a line twice": added('<path d="M10 0h5"/>'),
        "a line back and forth": added('<path d="M0 6v4"/>'),
        "a curve twice": added('<path d="M10 10C20 0 40 40 50 20"/>'),
        "another line": added('<path d="M55 5l1 1"/>'),
        "a line longer by 0.2 mm": drawing.replace("M12 30h1", "M12 30h1.3"),
        "a line shorter by 0.2 mm": drawing.replace("M12 30h1", "M12 30h.7"),
        "the curve otherwise": drawing.replace("40 40 50 20", "40 41 50 20"),
        "the tap elsewhere": drawing.replace("M30 20h0", "M30 20.3h0"),
        "no tap": drawing.replace("M30 20h0", ""),
        "no short stroke": drawing.replace("M12 30h1", ""),
    }
