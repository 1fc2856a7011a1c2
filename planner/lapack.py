"""The routines of LAPACK for banded systems, without the rest of `scipy.linalg`.

That package loads all of its own, and much of NumPy that nobody here asks for: a fifth of the time that a small drawing
takes. The routines are in one extension module of it, which is loaded by itself where it is found.
"""

from __future__ import annotations

import importlib.machinery
import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import scipy

_NAME = "scipy.linalg._flapack"
_ROUTINES = ("dgbsv", "dpbtrf", "dpbtrs")


def _routines() -> ModuleType:
    if _NAME in sys.modules:
        return sys.modules[_NAME]
    folder, stem = Path(scipy.__file__).parent / "linalg", _NAME.rsplit(".", 1)[1]
    for suffix in importlib.machinery.EXTENSION_SUFFIXES:
        spec = importlib.util.spec_from_file_location(_NAME, folder / f"{stem}{suffix}")
        if spec is None or spec.loader is None or not (folder / f"{stem}{suffix}").is_file():
            continue
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        if all(hasattr(module, name) for name in _ROUTINES):
            return module
    from scipy.linalg import lapack  # a SciPy that keeps them elsewhere

    return lapack


_module = _routines()
dgbsv, dpbtrf, dpbtrs = (getattr(_module, name) for name in _ROUTINES)
