"""Where Chromium puts the characters of the texts in tests/drawing/text/chromium.json: measures all of them anew.

    python benchmarks/text_positions.py [CHROMIUM]

Each text stands in a page of 1000 by 1000 user units, in DejaVu Sans of size 100; measured are the cells of its
characters: x, y, width, height; None where a character is not shown. Fonts of the system take part, so DejaVu Sans has
to be installed.
"""

from __future__ import annotations

import html
import json
import subprocess
import sys
import tempfile
from pathlib import Path

GOLDEN = Path(__file__).parents[1] / "tests" / "drawing" / "text" / "chromium.json"
PAGE = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 1000" width="1000" height="1000"'
    ' font-family="DejaVu Sans" font-size="100">{}</svg>'
)
_SCRIPT = """<script>
const found = {};
for (const frame of document.querySelectorAll("div")) {
  const text = frame.querySelector("text"), cells = [];
  for (let i = 0; i < text.getNumberOfChars(); i++) {
    const cell = text.getExtentOfChar(i);
    cells.push(cell.height ? [cell.x, cell.y, cell.width, cell.height].map(value => +value.toFixed(2)) : null);
  }
  found[frame.id] = cells;
}
const result = document.createElement("pre");
result.textContent = JSON.stringify(found);
document.body.replaceChildren(result);
</script>"""


def main() -> None:
    browser = sys.argv[1] if len(sys.argv) > 1 else "chromium"
    golden = json.loads(GOLDEN.read_text(encoding="utf-8"))
    frames = []
    for name, case in golden.items():
        own = case["svg"].replace('id="p"', f'id="p-{name}"').replace('"#p"', f'"#p-{name}"')
        frames.append(f'<div id="{name}">{PAGE.format(own)}</div>')
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "page.html"
        page.write_text("<!doctype html><meta charset=utf-8><body>" + "".join(frames) + _SCRIPT, encoding="utf-8")
        command = [browser, "--headless", "--no-sandbox", "--dump-dom", page.as_uri()]
        shown = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    found = json.loads(html.unescape(shown[shown.index("<pre>") + 5 : shown.index("</pre>")]))
    lines = [
        f"{json.dumps(name)}: {json.dumps({'svg': case['svg'], 'cells': found[name]})}" for name, case in golden.items()
    ]
    GOLDEN.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
