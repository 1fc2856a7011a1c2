"""Which font stands for the families that a drawing asks for."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal

from planner.drawing.text.faces import FACES, load_face
from planner.drawing.text.fonts import FaceMetrics, Font, FontFile, MetricsFile

Kind = Literal["sans", "serif", "script", "mono"]

_GENERIC: dict[str, Kind] = {
    "serif": "serif",
    "ui-serif": "serif",
    "sans-serif": "sans",
    "system-ui": "sans",
    "ui-sans-serif": "sans",
    "ui-rounded": "sans",
    "monospace": "mono",
    "ui-monospace": "mono",
    "cursive": "script",
    "fantasy": "sans",
    "math": "serif",
}
_HINTS: tuple[tuple[Kind, str], ...] = (
    ("mono", r"mono|courier|consol|cascadia|\bcode\b|typewriter|terminal|fixed|menlo|inconsolata|lucida console|ocr"),
    (
        "script",
        r"script|hand|brush|cursive|chancery|comic|allura|zapfino|yellowtail|pacifico|lobster|calligra|italianno"
        r"|tangerine|caveat|signature|edwardian|mistral|bradley|ink free|virgil|excalifont|xkcd|humor",
    ),
    ("sans", r"sans|grotesk|grotesque|gothic|\bui\b"),
    (
        "serif",
        r"serif|times|roman|georgia|garamond|palatino|bookman|antiqua|minion|cambria|slab|century|baskerville|didot"
        r"|bodoni|caslon|constantia|charter|schoolbook|utopia|rockwell|merriweather|playfair|song|ming|mincho",
    ),
)
"""What names of families tell of them, the first that fits."""

_DEJAVU = {"sans": "DejaVu Sans", "serif": "DejaVu Serif", "script": "DejaVu Sans", "mono": "DejaVu Sans Mono"}
"""What a generic family is drawn in: Matplotlib brings them to every machine."""

_METRICS = {  # regular, bold, italic, bold italic; ascent and descent
    "helvetica": (("phvr8a", "phvb8a", "phvro8a", "phvbo8a"), 0.905, 0.212),
    "times": (("ptmr8a", "ptmb8a", "ptmri8a", "ptmbi8a"), 0.891, 0.216),
    "courier": (("pcrr8a", "pcrb8a", "pcrro8a", "pcrbo8a"), 0.833, 0.300),
    "palatino": (("pplr8a", "pplb8a", "pplri8a", "pplbi8a"), 0.732, 0.283),
    "bookman": (("pbkl8a", "pbkd8a", "pbkli8a", "pbkdi8a"), 0.717, 0.228),
    "new century schoolbook": (("pncr8a", "pncb8a", "pncri8a", "pncbi8a"), 0.737, 0.205),
    "avant garde": (("pagk8a", "pagd8a", "pagko8a", "pagdo8a"), 0.740, 0.192),
}
_SAME_METRICS = {
    "arial": "helvetica",
    "helvetica neue": "helvetica",
    "liberation sans": "helvetica",
    "nimbus sans": "helvetica",
    "nimbus sans l": "helvetica",
    "arimo": "helvetica",
    "times new roman": "times",
    "liberation serif": "times",
    "nimbus roman": "times",
    "nimbus roman no9 l": "times",
    "tinos": "times",
    "times-roman": "times",
    "courier new": "courier",
    "liberation mono": "courier",
    "nimbus mono": "courier",
    "cousine": "courier",
    "palatino linotype": "palatino",
    "book antiqua": "palatino",
    "bookman old style": "bookman",
    "century schoolbook": "new century schoolbook",
    "itc avant garde gothic": "avant garde",
}
_STRETCHES = (
    "ultra-condensed",
    "extra-condensed",
    "condensed",
    "semi-condensed",
    "normal",
    "semi-expanded",
    "expanded",
    "extra-expanded",
    "ultra-expanded",
)


@dataclass(frozen=True, slots=True)
class Request:
    """What a style asks for. families: as written, without quotes; weight: 1 to 1000; stretch: a keyword of CSS."""

    families: tuple[str, ...]
    weight: float
    is_italic: bool
    stretch: str

    @property
    def kind(self) -> Kind:
        """What sort of face suits: by the first family whose name tells."""
        return next((kind for family in self.families if (kind := _kind_of(family))), "sans")


def split_families(text: str) -> tuple[str, ...]:
    """The families of a value of `font-family`."""
    found = re.findall(r"\"([^\"]*)\"|'([^']*)'|([^,\"']+)", text)
    return tuple(name for parts in found if (name := " ".join("".join(parts).split())))


def _kind_of(family: str) -> Kind | None:
    name = family.casefold()
    if name in _GENERIC:
        return _GENERIC[name]
    if _SAME_METRICS.get(name, name) in ("helvetica", "avant garde"):
        return "sans"
    return next((kind for kind, pattern in _HINTS if re.search(pattern, name)), None)


@cache
def fonts_for(request: Request, *, needs_outlines: bool) -> tuple[Font, ...]:
    """Fonts in the order in which characters are looked for: those of the families that are at hand, or what comes
    nearest to the first; DejaVu Sans in the end. Fonts of which metrics alone are known count where no outlines are
    needed."""
    found: list[Font] = []
    for family in request.families:
        name = family.casefold()
        if entries := _installed().get(name):
            found.append(_best(entries, request))
        elif name in _GENERIC:
            found.append(_stand_in(_GENERIC[name], request, needs_outlines=needs_outlines))
        elif not needs_outlines and _SAME_METRICS.get(name, name) in _METRICS:
            files, ascent, descent = _METRICS[_SAME_METRICS.get(name, name)]
            found.append(_metrics_file(files[(request.weight >= 600) + 2 * request.is_italic], ascent, descent))
    if not found:
        found.append(_stand_in(request.kind, request, needs_outlines=needs_outlines))
    return (*found, _stand_in("sans", request, needs_outlines=True))


def _stand_in(kind: Kind, request: Request, *, needs_outlines: bool) -> Font:
    if kind == "script" and not needs_outlines:
        return FaceMetrics(load_face(FACES["script"]))
    return _best(_installed()[_DEJAVU[kind].casefold()], request)


@dataclass(frozen=True, slots=True)
class Installed:
    """A font that is installed."""

    path: Path
    index: int
    weight: int
    is_italic: bool
    stretch: str


@cache
def _installed() -> dict[str, list[Installed]]:
    """By family, as Matplotlib finds them; its own among them."""
    from matplotlib.font_manager import fontManager, weight_dict

    found: dict[str, list[Installed]] = defaultdict(list)
    for entry in fontManager.ttflist:
        weight = weight_dict.get(entry.weight, 400) if isinstance(entry.weight, str) else int(entry.weight)
        is_italic = entry.style in ("italic", "oblique")
        index = int(getattr(entry, "index", 0))
        found[entry.name.casefold()].append(Installed(Path(entry.fname), index, weight, is_italic, str(entry.stretch)))
    return found


def _best(entries: Sequence[Installed], request: Request) -> Font:
    def distance(entry: Installed) -> tuple[float, bool, float, str]:
        order = [_STRETCHES.index(name) if name in _STRETCHES else 4 for name in (entry.stretch, request.stretch)]
        weight = abs(entry.weight - request.weight)
        is_wrong_way = (entry.weight < request.weight) != (request.weight > 500)
        return (
            abs(order[0] - order[1]),
            entry.is_italic != request.is_italic,
            weight + 0.5 * is_wrong_way,
            str(entry.path),
        )

    best = min(entries, key=distance)
    return font_file(best.path, best.index, is_slanted=request.is_italic and not best.is_italic)


@cache
def font_file(path: Path, index: int = 0, *, is_slanted: bool = False) -> FontFile:
    """Errors: DrawingError."""
    return FontFile(path, index, is_slanted=is_slanted)


@cache
def _metrics_file(stem: str, ascent: float, descent: float) -> MetricsFile:
    import matplotlib

    return MetricsFile(Path(matplotlib.get_data_path()) / "fonts" / "afm" / f"{stem}.afm", ascent, descent)


@cache
def any_font_with(character: str) -> Font | None:
    """The first installed font, by its name, that has a character; None where there is none."""
    return next((font for font in _all_fonts() if font.has(character)), None)


def _all_fonts() -> Iterator[Font]:
    from planner.errors import DrawingError

    for family, entries in sorted(_installed().items()):
        if "last resort" not in family:
            plain = Request((), 400.0, False, "normal")
            try:
                yield _best(entries, plain)
            except DrawingError:  # listed, and gone or damaged since
                continue
