"""The commands in README and docs are run as they stand there, and the files that they name have to come of it."""

from __future__ import annotations

import re
import shlex
import shutil
from functools import cache
from itertools import pairwise
from pathlib import Path

import pytest

from planner.cli import main

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
NOT_RUN = "<!-- not run:"
WRITTEN = {"-o", "--output", "--report", "--json", "--plot", "--picture"}
"""Options that name what a command writes."""

_FENCE = re.compile(r"^```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def commands_of(page: Path) -> list[list[str]]:
    """The commands of a page that are to be run, split into words. A block is passed over where the line above it
    says so, and why."""
    text = page.read_text(encoding="utf-8")
    blocks = [match[1].replace("\\\n", " ") for match in _FENCE.finditer(text)
              if not text[:match.start()].rstrip().splitlines()[-1].startswith(NOT_RUN)]
    return [words for block in blocks for line in block.splitlines() if (words := shlex.split(line, comments=True))]


def at_hand(words: list[str]) -> list[str]:
    """What a machine without an arm can run: played on the simulated arm and without waiting."""
    if words[1:2] != ["run"] or "--dry-run" in words:
        return words
    kept = [word for before, word in zip(["", *words], words, strict=False)
            if not {before, word} & {"--driver", "--port"}]
    return kept if "--fast" in kept else [*kept, "--fast"]


def written_by(words: list[str]) -> list[Path]:
    return [Path(named) / "index.html" if option == "--report" else Path(named)
            for option, named in pairwise(words) if option in WRITTEN]


@cache
def planned(words: tuple[str, ...]) -> dict[Path, bytes]:
    """What a plan writes into the current folder; several pages begin with the same one."""
    assert main(words[1:]) == 0, shlex.join(words)
    return {path: path.read_bytes() for path in written_by(list(words))}


@pytest.mark.parametrize("page", [page for page in PAGES if commands_of(page)], ids=lambda page: page.stem)
def test_commands_of_a_page_do_what_it_says(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copytree(ROOT / "examples", "examples")
    for words in commands_of(page):
        command = at_hand(words)
        assert command[0] == "plan", f"{shlex.join(command)}: is to be marked with '{NOT_RUN} why -->'"
        results = written_by(command)
        for path in results:
            if path.is_file():
                path.unlink()
        if command[1].endswith(".svg"):
            for path, content in planned(tuple(command)).items():
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
        else:
            assert main(command[1:]) == 0, shlex.join(command)
        for path in results:
            assert path.is_dir() or path.stat().st_size > 0, f"{shlex.join(command)}: {path}"


def test_pages_have_commands_and_every_block_that_is_not_run_says_why() -> None:
    assert sum(len(commands_of(page)) for page in PAGES) >= 20
    for page in PAGES:
        for line in page.read_text(encoding="utf-8").splitlines():
            assert not line.startswith(NOT_RUN) or re.fullmatch(rf"{NOT_RUN} \S.* -->", line), f"{page.name}: {line}"


def test_every_page_is_linked_from_the_front_page() -> None:
    front = (ROOT / "README.md").read_text(encoding="utf-8")
    linked = set(re.findall(r"\]\(docs/(\w+)\.md\)", front))
    assert linked == {page.stem for page in (ROOT / "docs").glob("*.md")} - {"index"}
