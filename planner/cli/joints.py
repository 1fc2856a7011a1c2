"""A configuration on the command line: a position for each joint, or for each that no coupling drives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from planner.errors import UsageError

if TYPE_CHECKING:
    from planner.arms.arm import Arm
    from planner.arrays import FloatArray


def all_joints(arm: Arm, positions: Sequence[float], option: str) -> FloatArray:
    """(n_joints,) rad or mm, of positions in the units of files; couplings fill in what is not given. Errors:
    UsageError, in the name of the option, for a number of positions that the arm has no use for."""
    independent = list(arm.independent_joints)
    if len(positions) == arm.n_joints:
        return arm.from_file_units(positions)
    if len(positions) == len(independent):
        return arm.complete(positions * arm.per_file_unit[independent])
    least = f"{len(independent)} or " if len(independent) < arm.n_joints else ""
    raise UsageError(
        f"{option}: arm '{arm.name}' has {least}{arm.n_joints} positions to give "
        f"({', '.join(joint.name for joint in arm.joints)}), not {len(positions)}"
    )
