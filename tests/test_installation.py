"""The console script in an environment where other distributions have packages of the same names: an installed copy is
made in a folder of its own, and what others do to it is done to it."""

from __future__ import annotations

import base64
import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import planner
from tests.drawn_shapes import lines_svg

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("planner", "hardware", "drawing_arm_planner")
ALONE = """
import os, sys
from importlib.machinery import PathFinder

class Alone:
    find_distributions = PathFinder.find_distributions

    def find_spec(name, path=None, target=None):
        folders = os.environ["PYTHONPATH"].split(os.pathsep) if name in ("planner", "hardware") else path
        return PathFinder.find_spec(name, folders, target)

sys.meta_path[sys.meta_path.index(PathFinder)] = Alone
"""
"""The environment that runs the tests has the packages too: they are looked for in the folders of the test alone."""
START = f"{ALONE}\nfrom drawing_arm_planner.command import main\nsys.exit(main())"
BESIDE = {name: value for name, value in os.environ.items() if name != "PYTHONPYCACHEPREFIX"}
SVG = lines_svg('<path d="M2 2 5 4"/>', 'viewBox="0 0 9 9"')


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder as pip leaves it: the packages, the record of what belongs to the distribution, and compiled what
    commands need, which would take longer than all else that they do here."""
    site = tmp_path_factory.mktemp("site")
    for package, source in zip(PACKAGES, ("planner", "hardware", "planner/entry"), strict=True):
        shutil.copytree(ROOT / source, site / package, ignore=shutil.ignore_patterns("__pycache__", "configs"))
    shutil.copytree(ROOT / "configs", site / "planner/configs")
    record(site, "drawing_arm_planner", PACKAGES)
    for command in ("--help", "arm", "ports"):
        run(site, command, compiled="")
    return site


@pytest.fixture
def site(sound: Path, tmp_path: Path) -> Path:
    copy = tmp_path / "site"
    shutil.copytree(sound, copy)
    return copy


def record(site: Path, name: str, packages: tuple[str, ...]) -> None:
    """The `.dist-info` of a distribution with these packages."""
    info = site / f"{name}-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name.replace('_', '-')}\nVersion: 1\n")
    (info / "top_level.txt").write_text("\n".join(packages))
    rows = []
    for file in sorted(path for package in packages for path in (site / package).rglob("*") if path.is_file()):
        digest = base64.urlsafe_b64encode(hashlib.sha256(file.read_bytes()).digest()).rstrip(b"=").decode()
        rows.append(f"{file.relative_to(site).as_posix()},sha256={digest},{file.stat().st_size}\n")
    (info / "RECORD").write_text("".join(rows))


def run(
    site: Path, *arguments: str, first: Path | None = None, compiled: str = "1"
) -> subprocess.CompletedProcess[str]:
    """The console script of that folder. first: a folder that Python searches before it. compiled: empty where modules
    are to be kept compiled, beside their sources."""
    path = os.pathsep.join(str(folder) for folder in (first, site) if folder)
    return subprocess.run(
        [sys.executable, "-c", START, *arguments],
        env={**BESIDE, "PYTHONPATH": path, "PYTHONDONTWRITEBYTECODE": compiled},
        cwd=site.parent,
        capture_output=True,
        text=True,
        check=False,
    )


def told(ended: subprocess.CompletedProcess[str]) -> str:
    """The one line that a damaged installation ends with."""
    assert ended.returncode == 70, ended
    assert ended.stdout == ""
    (line,) = ended.stderr.splitlines()
    assert line.startswith("plan: error: ")
    assert "virtual environment" in line and "pip install" in line
    return line


def stranger(site: Path, name: str, content: str = "VERSION = 3\n") -> None:
    """Another distribution of that name, installed over what is there."""
    (site / name).mkdir(exist_ok=True)
    (site / name / "__init__.py").write_text(content, encoding="utf-8")
    (site / f"{name}-3.dist-info").mkdir()
    (site / f"{name}-3.dist-info/METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 3\n")
    (site / f"{name}-3.dist-info/top_level.txt").write_text(name)
    (site / f"{name}-3.dist-info/RECORD").write_text(f"{name}/__init__.py,,\n")


def test_a_sound_installation_says_nothing_of_itself(site: Path) -> None:
    ended = run(site, "--version")
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, f"drawing-arm-planner {planner.__version__}\n", "")
    ended = run(site, "nowhere.svg")
    assert ended.returncode == 2 and "no such file" in ended.stderr


def remove(*names: str) -> Callable[[Path], None]:
    def removed(site: Path) -> None:
        for name in names:
            path = site / name
            shutil.rmtree(path) if path.is_dir() else path.unlink()

    return removed


@pytest.mark.parametrize(
    ("done", "names"),
    [
        (remove("planner"), "missing: planner/__init__.py"),
        (remove("planner/__init__.py"), "missing: planner/__init__.py"),
        (remove("planner/cli"), "missing: planner/cli/__init__.py"),
        (remove("planner/errors.py"), "missing: planner/errors.py"),
        (lambda site: stranger(site, "planner"), "replaced or edited: planner/__init__.py"),
        (lambda site: stranger(site, "planner", "import no_such_module_of_theirs\n"), "replaced or edited"),
        (lambda site: stranger(site, "planner", "1 / 0\n"), "planner brings packages of the same names"),
        (
            lambda site: (site / "planner/errors.py").write_text("class Oops(Exception): ...\n"),
            "replaced or edited: planner/errors.py",
        ),
    ],
)
def test_a_planner_that_is_damaged_is_named_by_every_command(
    site: Path, done: Callable[[Path], None], names: str
) -> None:
    done(site)
    for arguments in (("--help",), ("arm",)):
        assert names in told(run(site, *arguments))


def test_a_hardware_that_was_uninstalled_is_named_by_the_commands_that_need_it(site: Path) -> None:
    (site.parent / "line.svg").write_text(SVG, encoding="utf-8")
    remove("hardware")(site)
    assert "missing: hardware/__init__.py" in told(run(site, "run", "traj.csv"))
    assert "missing: hardware/__init__.py" in told(run(site, "ports"))
    assert run(site, "arm").returncode == 0


def test_a_module_that_a_stranger_replaced_is_named_where_it_fails(site: Path) -> None:
    stranger(site, "hardware")
    (site / "hardware/port.py").write_text("PORT = 1\n", encoding="utf-8")
    line = told(run(site, "ports"))
    assert "hardware/port.py" in line and "hardware brings packages of the same names" in line


@pytest.mark.parametrize("as_module", [False, True])
@pytest.mark.parametrize("name", ["planner", "hardware"])
def test_a_package_that_python_finds_first_is_named(site: Path, tmp_path: Path, name: str, as_module: bool) -> None:
    first = tmp_path / "first"
    first.mkdir()
    place = first / f"{name}.py" if as_module else first / name / "__init__.py"
    place.parent.mkdir(exist_ok=True)
    place.write_text("raise SystemExit('strangers')\n", encoding="utf-8")
    line = told(run(site, "--help", first=first))
    assert f"another package '{name}'" in line and str(first) in line


def test_a_checkout_that_is_installed_editable_is_ours(site: Path, tmp_path: Path) -> None:
    checkout = tmp_path / "a checkout"
    checkout.mkdir()
    for package in ("planner", "hardware"):
        shutil.move(site / package, checkout / package)
    assert "another package 'planner'" in told(run(site, "--version", first=checkout))
    (info,) = site.glob("*.dist-info")
    (info / "direct_url.json").write_text(json.dumps({"dir_info": {"editable": True}, "url": checkout.as_uri()}))
    ended = run(site, "--version", first=checkout)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, f"drawing-arm-planner {planner.__version__}\n", "")


def test_a_dependency_that_is_gone_is_named(site: Path) -> None:
    (site.parent / "line.svg").write_text(SVG, encoding="utf-8")
    (site / "casadi.py").write_text("raise ModuleNotFoundError('none', name='casadi')\n", encoding="utf-8")
    ended = run(site, "line.svg")
    assert ended.returncode == 70
    assert "no module 'casadi'" in ended.stderr and "pip install" in ended.stderr
    assert not (site.parent / "line.csv").exists()


def test_an_import_from_a_damaged_installation_says_so_too(site: Path) -> None:
    remove("planner/api")(site)
    ended = subprocess.run(
        [sys.executable, "-c", f"{ALONE}\nfrom planner import plan"],
        env={**BESIDE, "PYTHONPATH": str(site)},
        cwd=site.parent,
        capture_output=True,
        text=True,
        check=False,
    )
    assert "ImportError: the installation is damaged; missing: planner/api/__init__.py" in ended.stderr


def test_the_program_is_a_module_too() -> None:
    for module in ("planner", "planner.cli"):
        ended = subprocess.run([sys.executable, "-m", module, "--version"], capture_output=True, text=True, check=True)
        assert ended.stdout == f"drawing-arm-planner {planner.__version__}\n"
