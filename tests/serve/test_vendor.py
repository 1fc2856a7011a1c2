"""What the page has of others is what was built: .ci/three builds it anew."""

from __future__ import annotations

import hashlib
import json

from planner.serve.app import STATIC

_SOURCE = STATIC.parent / "three"


def test_three_js_is_the_one_that_was_built() -> None:
    built = dict(line.split()[::-1] for line in (_SOURCE / "built.sha256").read_text().splitlines())
    kept = {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in (STATIC / "vendor").iterdir()}
    assert kept == built


def test_its_versions_are_pinned_with_what_they_are_made_of() -> None:
    wanted = json.loads((_SOURCE / "package.json").read_text())["devDependencies"]
    packages = json.loads((_SOURCE / "package-lock.json").read_text())["packages"]
    for name, version in wanted.items():
        assert packages[f"node_modules/{name}"]["version"] == version
    assert all(package["integrity"].startswith("sha512-") for name, package in packages.items() if name)


def test_the_page_names_no_other_server() -> None:
    for file in STATIC.glob("*.*"):
        text = file.read_text(encoding="utf-8").replace("http://www.w3.org/", "")
        assert "http://" not in text and "https://" not in text, file.name
