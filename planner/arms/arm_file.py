"""Arm files: `configs/NAME.toml`, found, read, and checked whole before use."""

from __future__ import annotations

import tomllib
from functools import partial
from pathlib import Path

from planner.arms.arm import Arm
from planner.arms.kept_arm import kept_arm
from planner.errors import ArmFileError, UnknownArm

DEFAULT_ARM = "drawing_arm"

_ROBOT_DESCRIPTIONS = (".urdf", ".xacro", ".sdf", ".mjcf", ".xml")
_MOST_BYTES = 1_000_000


def arms_folder() -> Path:
    """Where the arm files live: inside the installed package, or at the top of a checkout."""
    package = Path(__file__).resolve().parent.parent
    installed = package / "configs"
    return installed if installed.is_dir() else package.parent / "configs"


def known_arms() -> tuple[str, ...]:
    """Names of the arms that come with the planner, sorted."""
    return tuple(sorted(path.stem for path in arms_folder().glob("*.toml")))


def load_arm(name_or_file: str, *, cache: bool = True) -> Arm:
    """The arm of that name, or of that file if it ends in `.toml`. cache: a file that an earlier process has checked is
    not checked again.

    Errors: UnknownArm, ArmFileError (which lists every fault in the file).
    """
    if name_or_file.lower().endswith(_ROBOT_DESCRIPTIONS):
        raise ArmFileError(
            name_or_file,
            [
                f"is a robot description, which an arm file is made of first: plan arm --urdf {name_or_file}"
                " -o my_arm.toml, then --arm my_arm.toml"
            ],
        )
    if not name_or_file.endswith(".toml") and name_or_file not in known_arms():
        raise UnknownArm(name_or_file, known_arms())
    file = _file(name_or_file)
    text = _text(file)
    checked = partial(arm_of_text, text, str(file))
    return kept_arm(text, checked) if cache else checked()


def arm_file_text(name_or_file: str) -> str:
    """The text that `load_arm` reads. Errors: ArmFileError where there is none."""
    return _text(_file(name_or_file))


def read_arm_file(path: Path) -> Arm:
    """Read, check and convert one arm file. Errors: ArmFileError with all faults."""
    return arm_of_text(_text(path), str(path))


def arm_of_text(text: str, source: str) -> Arm:
    """The arm of a file's text; `source` is what messages call it. Errors: as `read_arm_file`."""
    from planner.arms.arm_section import arm_of_content  # brings pydantic, which a kept arm does without

    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ArmFileError(source, [f"is not TOML: {error}"]) from error
    except RecursionError as error:
        raise ArmFileError(source, ["is not an arm: its values are nested too deeply"]) from error
    return arm_of_content(content, source)


def _file(name_or_file: str) -> Path:
    return Path(name_or_file) if name_or_file.endswith(".toml") else arms_folder() / f"{name_or_file}.toml"


def _text(path: Path) -> str:
    """Errors: ArmFileError where it cannot be an arm file, whatever it says."""
    try:
        if path.exists() and not (path.is_file() or path.is_dir()):  # a pipe would be waited for
            raise ArmFileError(str(path), ["is not a regular file"])
        if path.is_file() and path.stat().st_size > _MOST_BYTES:
            raise ArmFileError(str(path), [f"is not an arm: it has more than {_MOST_BYTES} bytes"])
        return path.read_text(encoding="utf-8")
    except OSError as error:
        raise ArmFileError(str(path), [f"cannot be read: {error.strerror}"]) from error
    except UnicodeDecodeError as error:
        raise ArmFileError(str(path), [f"is not TOML: {error}"]) from error
