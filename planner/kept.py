"""Arrays and texts that took a while to compute, kept on disk for the next process.

A file holds the answer to one question. Its name is a digest of the question, of this package and of the libraries that
answer it, so that no file is ever wrong: it is found, or it is not. Whoever deletes or damages files, or cannot write
them, waits a little longer, and that is all.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from functools import cache
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import TypeVar

import numpy as np

from planner.arrays import FloatArray
from planner.errors import OutputError
from planner.files import written_aside

_FOLDER = "drawing-arm-planner"
FOLDER_VARIABLE = "PLAN_CACHE"
"""Names the folder, or says `off`."""
OFF = "off"
_MOST_FILES = 200
"""Those that nobody has asked for for the longest time make room for new ones."""
_CHECKSUM_BYTES = 16

Arrays = Mapping[str, FloatArray]
Answer = TypeVar("Answer")


def kept(question: str, answer: Callable[[], Arrays]) -> Arrays:
    """The arrays that `answer` gives, from disk where an earlier process has asked the same `question`, which has to
    name all that the answer depends on. Errors: those of `answer`; those of the disk are none."""
    return _kept(question, answer, _packed, _unpacked)


def kept_text(question: str, answer: Callable[[], str]) -> str:
    """As `kept`, where the answer is a text."""
    return _kept(question, answer, str.encode, bytes.decode)


def _kept(
    question: str, answer: Callable[[], Answer], packed: Callable[[Answer], bytes], unpacked: Callable[[bytes], Answer]
) -> Answer:
    folder = kept_folder()
    if folder is None:
        return answer()
    file = folder / f"{_digest(question)}.kept"
    found = _read(file)
    if found is not None:
        with suppress(OSError):
            os.utime(file)  # it goes after those that nobody has asked for as long
        return unpacked(found)
    answered = answer()
    with suppress(OSError, OutputError, ValueError):
        folder.mkdir(parents=True, exist_ok=True)
        _drop_oldest(folder)
        content = packed(answered)
        with written_aside(file, binary=True) as stream:
            stream.write(_checksum(content) + content)  # type: ignore[arg-type]
    return answered


def kept_folder() -> Path | None:
    """Where answers are kept, by the rule of the platform; PLAN_CACHE names another, or says `off`: None."""
    named = os.environ.get(FOLDER_VARIABLE)
    if named == OFF:
        return None
    if named:
        return Path(named)
    import platformdirs

    return platformdirs.user_cache_path(_FOLDER, appauthor=False)


def _digest(question: str) -> str:
    return _checksum(f"{_answering()}\n{question}".encode(errors="backslashreplace")).hex()


@cache
def _answering() -> str:
    """What answers: the libraries, and this package as it lies on disk, edited or not."""
    libraries = [_version(name) for name in ("numpy", "casadi", "pydantic")]
    return "\n".join([sys.version, *libraries, *sorted(_modules(str(Path(__file__).parent)))])


def _modules(folder: str) -> Iterator[str]:
    """Each module within, as it lies there."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.endswith(".py"):
                state = entry.stat()
                yield f"{entry.path} {state.st_size} {state.st_mtime_ns}"
            elif entry.is_dir(follow_symlinks=False) and entry.name != "__pycache__":
                yield from _modules(entry.path)


def _version(library: str) -> str:
    """By the folder beside an installed library that is named after it and its version; `importlib.metadata`, which
    would open that folder, loads a reader of e-mail for it, and is asked where there is none. The small machine at an
    arm may not have the library at all."""
    try:
        spec = find_spec(library)
    except ModuleNotFoundError:
        spec = None
    beside = [] if spec is None or spec.origin is None else list(os.scandir(Path(spec.origin).parent.parent))
    told = [one.name for one in beside if one.name.startswith(f"{library}-") and one.name.endswith(".dist-info")]
    if told:
        return " ".join(sorted(told))
    from importlib.metadata import PackageNotFoundError, version

    try:
        return f"{library} {version(library)}"
    except PackageNotFoundError:
        return f"no {library}"


def _read(file: Path) -> bytes | None:
    try:
        content = file.read_bytes()
    except OSError:
        return None
    checksum, packed = content[:_CHECKSUM_BYTES], content[_CHECKSUM_BYTES:]
    return packed if checksum == _checksum(packed) else None  # damaged: it is computed anew, and replaced


def _packed(arrays: Arrays) -> bytes:
    packed = BytesIO()
    np.savez(packed, **arrays)  # type: ignore[arg-type]
    return packed.getvalue()


def _unpacked(packed: bytes) -> Arrays:
    with np.load(BytesIO(packed), allow_pickle=False) as arrays:
        return {name: arrays[name] for name in arrays.files}


def _checksum(packed: bytes) -> bytes:
    return hashlib.blake2b(packed, digest_size=_CHECKSUM_BYTES).digest()


def _drop_oldest(folder: Path) -> None:
    files = sorted(folder.glob("*.kept"), key=lambda file: file.stat().st_mtime)
    for file in files[: max(0, len(files) + 1 - _MOST_FILES)]:
        file.unlink(missing_ok=True)
