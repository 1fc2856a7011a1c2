"""Makes the pictures of these pages by the commands that the pages are about.

    python docs/make_figures.py [NAME ...]

`configurations_tradeoff.png` is of `benchmarks/tradeoff.py`. Those of the first hour, of symptoms and of the page need
the extra `test`, and Chromium.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from planner.cli import main  # noqa: E402

IMAGES = ROOT / "docs" / "images"
GARDEN = ROOT / "examples" / "garden.svg"
PLOTS = {
    "garden.png": ["traj.csv", "--kind", "drawing", "--drawing", str(GARDEN)],
    "ink.png": ["traj.csv", "--kind", "sheet"],
    "speed.png": ["traj.csv", "--kind", "speed"],
    "error.png": ["traj.csv", "--kind", "error", "--drawing", str(GARDEN)],
    "phase.png": ["traj.csv", "--kind", "phase"],
    "timeline.png": ["traj.csv", "--kind", "timeline"],
    "profiles.png": ["traj.csv", "--from", "0", "--to", "10"],
    "workspace.png": ["--kind", "workspace"],
    "film.gif": ["traj.csv", "--speed-factor", "5", "--fps", "8", "--quiet", "--dpi", "50"],
}
"""What follows `plan plot` for each."""
COMPARISONS = {
    "compare_target.png": ["--target", "53", "47.8", "0"],
    "compare_drawing.png": [str(ROOT / "examples" / "harbour.svg")],
    "compare_random.png": ["--random", "100", "--seed", "7"],
}
"""What follows `plan compare`."""
FIRST_HOUR = {
    "sheet.png": "sheet.pdf",
    "pattern.png": "pattern.png",
    "reading.jpg": "reading.png",
    "predicted.png": "predicted_after.png",
    "before.png": "before.png",
    "after.png": "after.png",
}
"""What each is made of, of what the first hour leaves."""
SYMPTOMS = "symptoms.png"
PAGE = tuple(f"page-{view}.png" for view in ("sheet", "map", "arm", "phone", "jog", "calibrate"))
ARMS = tuple(f"arm-{path.stem}.png" for path in sorted((ROOT / "configs").glob("*.toml")))
LANTERN = ROOT / "examples" / "lantern.svg"
FILLS = {
    "fills.png": [
        ["--fill", "hatch"],
        ["--fill", "cross", "--fill-angle", "30"],
        ["--fill", "zigzag"],
        ["--fill", "contour"],
        ["--fill", "spiral", "--stroke-width", "passes"],
        ["--fill", "hatch", "--fill-by", "lightness", "--fill-spacing", "0.6mm"],
    ],
}
"""What follows `plan examples/lantern.svg` for each part of a picture."""
_WIDTH_PX, _COLOURS, _QUALITY = 1000, 256, 70


def make(names: list[str]) -> None:
    """Figures by name, or all of them, in the folder of images."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        _run([str(GARDEN), "-o", "traj.csv", "--quiet"])
        wanted = names or [*PLOTS, *COMPARISONS, *FIRST_HOUR, *FILLS, SYMPTOMS, *PAGE, *ARMS]
        if any(name in FIRST_HOUR for name in wanted):
            from first_hour import first_hour

            first_hour(GARDEN)
            _run(["plot", "pattern.csv", "--kind", "drawing", "-o", "pattern.png"])
        if any(name in ARMS for name in wanted):
            from arm_pictures import arm_pictures

            arm_pictures(Path(folder))
        if any(name in PAGE for name in wanted):
            from page_pictures import page_pictures

            page_pictures(Path(folder), GARDEN)
        for name in wanted:
            if name in PLOTS:
                _run(["plot", "--dpi", "100", *PLOTS[name], "-o", str(IMAGES / name)])
            elif name in COMPARISONS:
                _run(["compare", *COMPARISONS[name], "--plot", str(IMAGES / name)])
            elif name in FIRST_HOUR:
                _small(Path(FIRST_HOUR[name]), IMAGES / name)
            elif name in (*PAGE, *ARMS):
                _small(Path(name), IMAGES / name)
            elif name in FILLS:
                _fills(FILLS[name], IMAGES / name)
            else:
                _symptoms(IMAGES / name)


def _fills(parts: list[list[str]], target: Path) -> None:
    """What each part draws, two beside each other."""
    from PIL import Image

    sheets = []
    for number, options in enumerate(parts):
        _run([str(LANTERN), "-o", "fill.csv", "--quiet", "--fill-spacing", "1.2mm", *options])
        _run(["plot", "fill.csv", "--kind", "sheet", "--dpi", "100", "-o", f"fill{number}.png"])
        sheets.append(Image.open(f"fill{number}.png").convert("RGB"))
    width, height = sheets[0].size
    together = Image.new("RGB", (2 * width, height * ((len(sheets) + 1) // 2)), "white")
    for number, sheet in enumerate(sheets):
        together.paste(sheet, (width * (number % 2), height * (number // 2)))
    together.save("fills.png")
    _small(Path("fills.png"), target)


def _symptoms(target: Path) -> None:
    from symptoms import plot_symptoms

    from planner.plots.figure_file import save_figure

    save_figure(plot_symptoms(), Path("symptoms.png"))
    _small(Path("symptoms.png"), target)


def _small(source: Path, target: Path) -> None:
    """A picture or a page of a PDF, as wide as the text of these pages and with few colours, or as JPEG."""
    import pypdfium2
    from PIL import Image, ImageOps

    if source.suffix == ".pdf":
        with pypdfium2.PdfDocument(source) as document:
            picture = ImageOps.expand(document[0].render(scale=2).to_pil().convert("RGB"), 2, "#B5B5AE")
    else:
        picture = Image.open(source).convert("RGB")
    height_px = round(picture.height * _WIDTH_PX / picture.width)
    picture = picture.resize((_WIDTH_PX, height_px), Image.Resampling.LANCZOS)
    if target.suffix == ".jpg":
        picture.save(target, quality=_QUALITY, optimize=True)
    else:
        picture.quantize(_COLOURS, dither=Image.Dither.NONE).save(target, optimize=True)


def _run(arguments: list[str]) -> None:
    if main(arguments):
        sys.exit(1)


if __name__ == "__main__":
    make(sys.argv[1:])
