"""A page that holds all that it shows and asks nothing of any network, and how it is written."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import IO, cast

from planner.errors import OutputError
from planner.files import written_aside
from planner.report.markup import Markup, element

_POLICY = "default-src 'none'; img-src data:; style-src 'unsafe-inline'"


def page(title: str, *body: str, script: str = "") -> Markup:
    """The page as text. It loads nothing, and a browser is told not to even if something in it asked. script: the hash
    of the only one that runs."""
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element(
            "meta",
            http_equiv="Content-Security-Policy",
            content=f"{_POLICY}; script-src {script}" if script else _POLICY,
        ),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("title", title),
        element("style", Markup(files(__package__).joinpath("page.css").read_text(encoding="utf-8"))),
    )
    return Markup(f"<!doctype html>\n{element('html', head, element('body', *body), lang='en')}\n")


def write_page(text: Markup, target: Path) -> None:
    """Whole or not at all, in the place of one that is there; missing folders are made. Errors: OutputError."""
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(str(target.parent), error.strerror or str(error)) from error
    with written_aside(target) as file:
        cast("IO[str]", file).write(text)
