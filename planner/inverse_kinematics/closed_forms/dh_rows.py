"""Whether an arm's Denavit-Hartenberg rows have the form that a family's closed form is made for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from planner.arms.arm import Arm, Joint, JointKind
from planner.errors import ArmFileError


@dataclass(frozen=True, slots=True)
class Row:
    """What a row of a family may be: its twist in degrees (None: any), and which lengths it may have.
    `a` is "zero", "any" or "link", which is above zero."""

    alpha_deg: tuple[float, ...] | None
    d: Literal["zero", "any"] = "zero"
    a: Literal["zero", "any", "link"] = "zero"
    kind: JointKind = JointKind.REVOLUTE


def require_rows(arm: Arm, family: str, rows: Sequence[Row], *, coupled: bool = False) -> None:
    """Refuse an arm whose rows are not those of the family, naming every value that differs. Errors: ArmFileError."""
    needs = f"the closed form '{family}' needs"
    faults = []
    if arm.n_joints != len(rows):
        faults.append(f"joints: {needs} {len(rows)} of them (value: {arm.n_joints})")
    for index, (joint, row) in enumerate(zip(arm.joints, rows, strict=False)):
        faults += [f"joints[{index}].{fault}" for fault in _faults(joint, row, needs)]
    faults += [
        f"joints[{index}].origin: {needs} rows without one"
        for index, joint in enumerate(arm.joints)
        if not joint.origin.is_identity
    ]
    if not arm.tool.is_identity:
        faults.append(f"tool: {needs} the tip at the end of the last row, without [tool]")
    if arm.couplings and not coupled:
        faults.append(f"coupling: {needs} joints that move by themselves")
    if faults:
        raise ArmFileError(f"arm {arm.name}", faults)


def _faults(joint: Joint, row: Row, needs: str) -> list[str]:
    faults = []
    if joint.kind is not row.kind:
        faults.append(f"kind: {needs} '{row.kind}' (value: '{joint.kind}')")
    if row.alpha_deg is not None and not any(
        np.isclose(joint.alpha_rad, np.radians(alpha), rtol=0, atol=1e-12) for alpha in row.alpha_deg
    ):
        wanted = " or ".join(f"{alpha:g}" for alpha in row.alpha_deg)
        faults.append(f"alpha_deg: {needs} {wanted} (value: {np.degrees(joint.alpha_rad):g})")
    if row.d == "zero" and joint.d_mm != 0:
        faults.append(f"d_mm: {needs} 0 (value: {joint.d_mm:g})")
    if row.a == "zero" and joint.a_mm != 0:
        faults.append(f"a_mm: {needs} 0 (value: {joint.a_mm:g})")
    if row.a == "link" and joint.a_mm <= 0:
        faults.append(f"a_mm: {needs} a length above 0 (value: {joint.a_mm:g})")
    return faults


def sign_of_twist(joint: Joint) -> float:
    """sin(alpha) of a joint that is twisted by a right angle: 1 or -1, without rounding."""
    return float(np.sign(joint.alpha_rad))
