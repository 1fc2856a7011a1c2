"""Whether all files are there and as they were installed.

Other distributions have packages of the same names: installed beside this one they overwrite its files, and uninstalled
they take them away.
"""

from __future__ import annotations

import base64
import hashlib
from importlib.metadata import Distribution, PackageNotFoundError, distribution, packages_distributions
from pathlib import Path

from .foreign import ADVICE, HOME, NAME, PACKAGES, foreign

_SHOWN = 3


def damage(error: Exception | None = None) -> str | None:
    """What to tell where files of ours are gone or another's, or where that error says that a dependency is; None where
    nothing is wrong with the installation."""
    return foreign() or _of_our_files() or _of_dependencies(error)


def _of_our_files() -> str | None:
    try:
        installed = distribution(NAME)
    except PackageNotFoundError:  # run from its source
        return None
    if Path(str(installed.locate_file(""))).resolve() != HOME:  # what runs is not what is installed
        return None
    missing, changed = _faults(installed)
    if not missing and not changed:
        return None
    states = ((missing, "missing"), (changed, "replaced or edited"))
    told = "; ".join(f"{state}: {_some(files)}" for files, state in states if files)
    others = _others()
    shared = f" {' and '.join(others)} brings packages of the same names." if others else ""
    return f"the installation is damaged; {told}.{shared} Mend it by pip install --force-reinstall {NAME}, or {ADVICE}"


def _faults(installed: Distribution) -> tuple[list[str], list[str]]:
    """Modules that are missing, and those that are not as installed."""
    missing, changed = [], []
    for file in installed.files or ():
        if file.parts[0] not in PACKAGES or file.suffix != ".py":
            continue
        path = Path(str(file.locate()))
        if not path.is_file():
            missing.append(file.as_posix())
        elif file.hash is not None and file.hash.mode == "sha256" and _sha256(path) != file.hash.value:
            changed.append(file.as_posix())
    return missing, changed


def _sha256(path: Path) -> str:
    """As in a wheel's RECORD."""
    return base64.urlsafe_b64encode(hashlib.sha256(path.read_bytes()).digest()).rstrip(b"=").decode()


def _some(files: list[str]) -> str:
    more = len(files) - _SHOWN
    return ", ".join(files[:_SHOWN]) + (f" and {more} more" if more > 0 else "")


def _others() -> list[str]:
    """Other distributions that are installed with packages of the same names."""
    owners = packages_distributions()
    names = {owner for package in PACKAGES for owner in owners.get(package, [])}
    return sorted(name for name in names if name.lower().replace("_", "-") != NAME)


def _of_dependencies(error: Exception | None) -> str | None:
    if not isinstance(error, ModuleNotFoundError) or error.name is None:
        return None
    return f"the installation is incomplete: there is no module '{error.name}'; pip install --force-reinstall {NAME}"
