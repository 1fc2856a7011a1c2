"""The routines of LAPACK for banded systems, without the rest of SciPy.

`scipy.linalg` loads all of its own, and much of NumPy that nobody here asks for: a fifth of the time that a small
drawing takes. The routines are in one extension module of it, which is loaded by itself where it is found.
"""

from __future__ import annotations

import importlib.util
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path
from types import ModuleType

_NAME = "scipy.linalg._flapack"
_ROUTINES = ("dgbsv", "dpbtrf", "dpbtrs")


def _routines() -> ModuleType:
    if _NAME in sys.modules:
        return sys.modules[_NAME]
    if sys.platform == "win32":
        importlib.import_module("scipy")  # says where the libraries are that the module needs; elsewhere it knows
    found = importlib.util.find_spec("scipy")
    folders = [] if found is None else found.submodule_search_locations or []
    stem = _NAME.rsplit(".", 1)[1]
    for file in (Path(one, "linalg", f"{stem}{suffix}") for one in folders for suffix in EXTENSION_SUFFIXES):
        spec = importlib.util.spec_from_file_location(_NAME, file)
        if spec is None or spec.loader is None or not file.is_file():
            continue
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        if all(hasattr(module, name) for name in _ROUTINES):
            return module
    from scipy.linalg import lapack  # a SciPy that keeps them elsewhere

    return lapack


_module = _routines()
dgbsv, dpbtrf, dpbtrs = (getattr(_module, name) for name in _ROUTINES)
