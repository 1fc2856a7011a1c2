"""What the planner draws of SVGs, beside what Chromium shows of them.

    python benchmarks/fidelity.py FOLDER ... [--json FILE] [--pictures FOLDER] [--only WORD] [--workers 2]

The reference are the paths that Chromium paints (see browser/reference.py); what is drawn is what `plan lines` says.
Both are compared as sets of points on lines, both ways. Where text is, its boxes are compared: everything written
has to have ink, of its size and in its place, and there is no ink beside it. Needs Debian's `chromium`, and the
test extra.
"""

from __future__ import annotations

import argparse
import gzip
import io
import json
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import asdict, dataclass, field
from pathlib import Path

import numpy as np
from browser.chromium import Chromium
from browser.compare import Verdict, compare, without_background
from browser.reference import Reference, reference
from browser.text import compare_text
from PIL import Image, ImageDraw
from shapely.errors import ShapelyError

from planner.arrays import FloatArray

_MM_PER_PX = 25.4 / 96.0
_PICTURE_PIXELS = 600
_NOT_SURE_SLACK = 3.0
_WORDS = {"filter": {"filter"}, "image": {"image", "external reference"}}
"""What has to be said, and the words of the planner that say it."""


@dataclass(frozen=True, eq=False, slots=True)
class Drawn:
    """What the planner makes of a file. error: its sentence, where it draws nothing."""

    page_mm: tuple[float, float]
    lines: list[FloatArray]
    skipped: Mapping[str, int]
    error: str = ""


@dataclass(frozen=True, slots=True)
class Judgement:
    """kind: "agree", "less", "more", "moved", "refused" (Chromium shows something), "unread" (only the planner does),
    "page" (its size differs) or "unsaid" with what is neither lines nor counted. said: what the planner said it left
    out, or its error; "SILENT" where nothing."""

    file: str
    folder: str
    kind: str
    said: str
    text: str = ""
    less_mm: float = 0.0
    more_mm: float = 0.0
    reference_mm: float = 0.0
    drawn_mm: float = 0.0
    notes: list[str] = field(default_factory=list)


def drawn(file: Path, text: str) -> Drawn:
    """The product's lines in mm on the page."""
    from planner.cli import main

    said = io.StringIO()
    with tempfile.TemporaryDirectory() as folder, redirect_stdout(io.StringIO()), redirect_stderr(said):
        target = Path(folder) / "lines.json"
        code = main(["lines", str(file), "--json", str(target), "--text", text])
        found = json.loads(target.read_text()) if code == 0 else {}
    if code:
        return Drawn((0.0, 0.0), [], {}, said.getvalue().strip() or f"exit {code}")
    lines = [np.array(line["points"], float).reshape(-1, 2) for line in found["lines"]]
    width, height = found["page_mm"]
    return Drawn((width, height), lines, found["skipped"])


def judge(browser: Chromium, file: Path, pictures: Path | None) -> Judgement:
    """One file."""
    data = file.read_bytes()
    if data[:2] == b"\x1f\x8b":
        data = gzip.decompress(data)
    plain = drawn(file, "skip")
    with_text = drawn(file, "single")
    page_mm = plain.page_mm if not plain.error else with_text.page_mm
    size_px = tuple(side / _MM_PER_PX for side in page_mm) if max(page_mm) > 0.0 else (300.0, 150.0)
    shown = reference(browser, data, (size_px[0], size_px[1]))
    verdict = _verdict(shown, plain, with_text)
    text = (
        ""
        if shown.error or with_text.error
        else compare_text([box * _MM_PER_PX for box in shown.text_boxes], _only_text(plain, with_text))
    )
    kind, measured = verdict
    said = with_text.error or ", ".join(sorted(with_text.skipped)) or "SILENT"
    unsaid = [kind for kind in shown.has_to_be_said if not any(word in _WORDS[kind] for word in with_text.skipped)]
    if kind == "agree" and unsaid and not with_text.error:
        kind = "unsaid " + " and ".join(unsaid)
    figures = asdict(measured) if measured is not None else {"kind": kind}
    del figures["kind"]
    found = Judgement(str(file), file.parent.name, kind, said, text, notes=shown.notes, **figures)
    if pictures is not None:
        _picture(shown, with_text, pictures / f"{file.parent.name}_{file.stem}.png")
    return found


def _verdict(shown: Reference, plain: Drawn, with_text: Drawn) -> tuple[str, Verdict | None]:
    if shown.error:
        return ("agree" if with_text.error else "unread"), None
    lines = [line * _MM_PER_PX for line in shown.lines]
    if with_text.error or plain.error:
        is_seen = bool(lines) or (bool(with_text.error) and bool(shown.text_boxes))
        return ("refused" if is_seen else "agree"), None
    page_mm = plain.page_mm
    sure = [line * _MM_PER_PX for line in shown.sure]
    if "background" in plain.skipped:
        sure = without_background(sure, page_mm)
    shown_mm = tuple(side * _MM_PER_PX for side in shown.size_px)
    if max(abs(a - b) for a, b in zip(shown_mm, page_mm, strict=True)) > 0.005 * max(page_mm):
        return "page", None
    measured = compare(lines, sure, plain.lines, page_mm, _NOT_SURE_SLACK if shown.notes else 1.0)
    return measured.kind, measured


def _only_text(plain: Drawn, with_text: Drawn) -> list[FloatArray]:
    """Lines that are there only with text."""
    known = Counter(line.tobytes() for line in plain.lines)
    found = []
    for line in with_text.lines:
        key = line.tobytes()
        if known[key]:
            known[key] -= 1
        else:
            found.append(line)
    return found


def _picture(shown: Reference, planned: Drawn, target: Path) -> None:
    """Chromium's screenshot on the left; on the right our lines in black over the reference in red."""
    target.parent.mkdir(parents=True, exist_ok=True)
    scale = _PICTURE_PIXELS / max(*shown.size_px, 1e-6)
    size = tuple(max(1, round(side * scale)) for side in shown.size_px)
    both = Image.new("RGB", (2 * size[0] + 10, size[1]), "white")
    if shown.picture:
        left = Image.open(io.BytesIO(shown.picture)).convert("RGBA").resize(size)
        both.paste(left, (0, 0), left)
    draw = ImageDraw.Draw(both)
    for lines, colour, width, factor in (
        (shown.lines + shown.text_boxes, "red", 4, scale),
        (planned.lines, "black", 1, scale / _MM_PER_PX),
    ):
        for line in lines:
            points = [(x + size[0] + 10, y) for x, y in np.clip(line * factor, -1e4, 1e4)]
            if len(points) == 1 or np.ptp(line, axis=0).max() == 0.0:
                draw.ellipse((points[0][0] - 2, points[0][1] - 2, points[0][0] + 2, points[0][1] + 2), fill=colour)
            else:
                draw.line(points, fill=colour, width=width)
    both.save(target)


def judged(files: list[Path], pictures: Path | None) -> list[Judgement]:
    """Files by one browser; a new one after one that it does not survive."""
    found: list[Judgement] = []
    browser = Chromium()
    for file in files:
        try:
            found.append(judge(browser, file, pictures))
        except (OSError, RuntimeError, ValueError, ShapelyError) as error:
            found.append(Judgement(str(file), file.parent.name, "not judged", f"{type(error).__name__}: {error}"))
            browser.__exit__(None, None, None)
            browser = Chromium()
    browser.__exit__(None, None, None)
    return found


def _tables(found: list[Judgement]) -> Iterator[str]:
    folders: dict[str, list[Judgement]] = defaultdict(list)
    for one in found:
        folders[one.folder].append(one)
    kinds = sorted({one.kind for one in found})
    yield "| folder | files | " + " | ".join(kinds) + " | text wrong | silent |"
    yield "|---" * (len(kinds) + 4) + "|"
    for folder, ones in sorted(folders.items()):
        count = Counter(one.kind for one in ones)
        texts = sum(one.text not in ("", "agree") for one in ones)
        silent = sum(is_wrong(one) and one.said == "SILENT" for one in ones)
        yield (
            f"| {folder} | {len(ones)} | " + " | ".join(str(count[kind]) for kind in kinds) + f" | {texts} | {silent} |"
        )
    yield ""
    for (kind, said), ones in sorted(_by_cause(found).items(), key=lambda item: -len(item[1])):
        yield f"{len(ones)} {kind}: {said}"
        for one in ones:
            details = f"less {one.less_mm:.1f} more {one.more_mm:.1f} of {one.reference_mm:.1f} mm"
            words = [details, one.text and f"text {one.text}", *one.notes]
            yield f"    {one.folder}/{Path(one.file).name}: " + "; ".join(word for word in words if word)


def is_wrong(one: Judgement) -> bool:
    return one.kind != "agree" or one.text not in ("", "agree")


def _by_cause(found: list[Judgement]) -> dict[tuple[str, str], list[Judgement]]:
    causes: dict[tuple[str, str], list[Judgement]] = defaultdict(list)
    for one in found:
        if is_wrong(one):
            causes[one.kind if one.kind != "agree" else "text", one.said].append(one)
    return causes


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("paths", nargs="+", type=Path, help="folders of SVGs, or SVGs")
    parser.add_argument("--json", type=Path, help="every judgement, to this file")
    parser.add_argument("--pictures", type=Path, help="a picture of each file, into this folder")
    parser.add_argument("--only", default="", help="files with this in their name")
    parser.add_argument("--workers", type=int, default=2, help="browsers at a time (default: %(default)s)")
    options = parser.parse_args()
    files = [
        file
        for path in options.paths
        for file in ([path] if path.is_file() else sorted((*path.rglob("*.svg"), *path.rglob("*.svgz"))))
        if options.only in file.name
    ]
    chunks = [files[index :: options.workers] for index in range(options.workers)]
    with ProcessPoolExecutor(options.workers) as pool:
        shares = pool.map(judged, chunks, [options.pictures] * len(chunks))
        found = sorted((one for share in shares for one in share), key=lambda one: one.file)
    if options.json:
        options.json.write_text(json.dumps([asdict(one) for one in found], indent=1) + "\n")
    print("\n".join(_tables(found)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
