"""Ruckig's community edition plans from state to state on this machine, and asks a cloud service over the
network as soon as waypoints or limits per section are set. No code of ours may name them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
from ruckig import InputParameter

ROOT = Path(__file__).parents[1]
SOURCES = sorted(path for folder in ("planner", "hardware", "benchmarks") for path in (ROOT / folder).rglob("*.py"))


def is_cloud_name(name: str) -> bool:
    return name.endswith("intermediate_positions") or name.startswith("per_section_")


def cloud_names(code: str) -> Iterator[str]:
    """Every mention in `code`: as attribute, keyword or variable, or as text handed to setattr."""
    for node in ast.walk(ast.parse(code)):
        mentioned = {
            ast.Attribute: "attr",
            ast.keyword: "arg",
            ast.Name: "id",
            ast.Constant: "value",
        }.get(type(node))
        name = getattr(node, mentioned) if mentioned else None
        if isinstance(name, str) and is_cloud_name(name):
            yield name


def test_the_sources_name_none_of_them() -> None:
    found = {str(path.relative_to(ROOT)): list(cloud_names(path.read_text("utf-8"))) for path in SOURCES}
    assert found
    assert {path: names for path, names in found.items() if names} == {}


@pytest.mark.parametrize(
    "code",
    [
        "problem.intermediate_positions = points",
        "problem.per_section_max_velocity = limits",
        "setattr(problem, 'intermediate_positions', points)",
        "make(per_section_max_jerk=3.0)",
        "otg.filter_intermediate_positions(problem, 0.1)",
    ],
)
def test_each_way_of_naming_them_is_seen(code: str) -> None:
    assert list(cloud_names(code))


def test_the_names_are_still_those_of_ruckig() -> None:
    known = [name for name in dir(InputParameter) if is_cloud_name(name)]
    assert "intermediate_positions" in known
    assert "per_section_max_velocity" in known
