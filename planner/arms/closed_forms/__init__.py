"""Closed-form inverse kinematics, one file a family of arms, found through one table."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from planner.arms.arm import Arm
from planner.arms.closed_forms import drawing_arm
from planner.arrays import FloatArray
from planner.errors import UsageError

References = Callable[[Arm, FloatArray], FloatArray]
"""Arm and tips (n, 3) in mm to free joints (n, n_free), NaN where no posture exists."""

_FAMILIES: Mapping[str, tuple[Callable[[Arm], bool], References]] = {
    "drawing_arm": (drawing_arm.fits, drawing_arm.centred_postures)}


def closed_form_postures(arm: Arm) -> References:
    """The closed form of the arm's family. Errors: UsageError where it has none, or where its chain is another."""
    if arm.closed_form is None:
        raise UsageError(f"arm {arm.name} names no closed form; use --method path, nlp or dls")
    fits, references = _FAMILIES[arm.closed_form]
    if not fits(arm):
        raise UsageError(f"arm {arm.name}: its joints and couplings are not those of closed form '{arm.closed_form}';"
                         " use --method path, nlp or dls")
    return references
