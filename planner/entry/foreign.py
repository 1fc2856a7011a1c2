"""Whose packages Python finds under the names `planner` and `hardware`: ours, or those of strangers."""

from __future__ import annotations

import importlib.util
from pathlib import Path

NAME = "drawing-arm-planner"
PACKAGES = ("planner", "hardware")
_HERE = Path(__file__).resolve().parent
HOME = _HERE.parent.parent if _HERE.parent.name == "planner" else _HERE.parent
"""The folder that all our packages are in."""
ADVICE = f"install it in a virtual environment of its own: python -m venv drawing, then drawing/bin/pip install {NAME}"


def foreign() -> str | None:
    """What to tell where Python finds another `planner` or `hardware` before ours; None where it does not."""
    for name in PACKAGES:
        spec = importlib.util.find_spec(name)
        places = [] if spec is None else [*(spec.submodule_search_locations or ()), *filter(None, [spec.origin])]
        if places and not _are_ours(places):
            return f"Python finds another package '{name}' in place of that of {NAME}, at {places[0]}; {ADVICE}"
    return None


def _are_ours(places: list[str]) -> bool:
    inside = [set(Path(place).resolve().parents) for place in places]
    if any(HOME in parents for parents in inside):
        return True
    checkout = _checkout()
    return any(checkout in parents for parents in inside)


def _checkout() -> Path | None:
    """The folder that an editable installation is of; None where it is no such."""
    import json
    from importlib.metadata import PackageNotFoundError, distribution
    from urllib.parse import urlsplit
    from urllib.request import url2pathname

    try:
        told = json.loads(distribution(NAME).read_text("direct_url.json") or "{}")
    except (PackageNotFoundError, ValueError):
        return None
    if not told.get("dir_info", {}).get("editable"):
        return None
    return Path(url2pathname(urlsplit(told["url"]).path)).resolve()
