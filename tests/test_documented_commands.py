"""The commands in README and docs are run as they stand there, and the files that they name have to come of it."""

from __future__ import annotations

import hashlib
import os
import re
import shlex
import shutil
from contextlib import suppress
from itertools import pairwise
from pathlib import Path

import pytest

from planner.cli import main

ROOT = Path(__file__).resolve().parent.parent
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
NOT_RUN = "<!-- not run:"
WRITTEN = {"-o", "--output", "--report", "--json", "--plot", "--picture"}
"""Options that name what a command writes."""

_FENCE = re.compile(r"^( *)```sh\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)


def commands_of(page: Path) -> list[list[str]]:
    """The commands of a page that are to be run, split into words. A block is passed over where the line above it
    says so, and why."""
    text = page.read_text(encoding="utf-8")
    blocks = [
        match[2].replace("\\\n", " ")
        for match in _FENCE.finditer(text)
        if not text[: match.start()].rstrip().splitlines()[-1].lstrip().startswith(NOT_RUN)
    ]
    return [words for block in blocks for line in block.splitlines() if (words := shlex.split(line, comments=True))]


def at_hand(words: list[str]) -> list[str]:
    """What a machine without an arm can run: played on the simulated arm and without waiting."""
    if words[1:2] != ["run"] or "--dry-run" in words:
        return words
    kept = [
        word for before, word in zip(["", *words], words, strict=False) if not {before, word} & {"--driver", "--port"}
    ]
    return kept if "--fast" in kept else [*kept, "--fast"]


def written_by(words: list[str]) -> list[Path]:
    return [
        Path(named) / "index.html" if option == "--report" else Path(named)
        for option, named in pairwise(words)
        if option in WRITTEN
    ]


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where all processes of a session find what plans have written: one that several pages begin with is made once."""
    folder = tmp_path_factory.getbasetemp()
    return (folder.parent if "PYTEST_XDIST_WORKER" in os.environ else folder) / "documented"


def kept(planned: Path, words: list[str]) -> Path:
    """The folder of what a plan has written, by its words."""
    return planned / hashlib.sha256(shlex.join(words).encode()).hexdigest()


def keep(results: list[Path], folder: Path) -> None:
    """Whole, or not at all: others look for it meanwhile."""
    aside = folder.with_name(f"{folder.name}-{os.getpid()}")
    for path in results:
        (aside / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, aside / path)
    with suppress(OSError):  # another process was first
        aside.rename(folder)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_of_a_page_do_what_it_says(
    page: Path, planned: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    monkeypatch.chdir(tmp_path)
    for words in commands_of(page):
        command = at_hand(words)
        told = f"{page.name}: {shlex.join(command)}"
        assert command[0] == "plan", f"{told} is to be marked with '{NOT_RUN} why -->'"
        results = written_by(command)
        folder = kept(planned, command)
        for path in results:
            if path.is_file():
                path.unlink()
        if folder.exists():
            shutil.copytree(folder, Path(), dirs_exist_ok=True)
        else:
            assert main(command[1:]) == 0, told
            if command[1].endswith(".svg"):
                keep(results, folder)
        for path in results:
            assert path.is_dir() or path.stat().st_size > 0, f"{told}: {path}"


def test_pages_have_commands_and_every_block_that_is_not_run_says_why() -> None:
    assert sum(len(commands_of(page)) for page in PAGES) >= 20
    for page in PAGES:
        for line in page.read_text(encoding="utf-8").splitlines():
            assert not line.startswith(NOT_RUN) or re.fullmatch(rf"{NOT_RUN} \S.* -->", line), f"{page.name}: {line}"


def test_every_page_is_linked_from_the_front_page() -> None:
    front = (ROOT / "README.md").read_text(encoding="utf-8")
    linked = set(re.findall(r"\]\(docs/(\w+)\.md\)", front))
    assert linked == {page.stem for page in (ROOT / "docs").glob("*.md")} - {"index"}
