"""Couplings in an arm file: joints that follow others, in the units of the file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from planner.arms.arm import Coupling, Joint, JointKind
from planner.arms.file_section import Length, Number, Section


class CouplingSection(Section):
    """joint = constant + sum of coefficient * other: constant_deg where the joint turns, constant_mm where it slides;
    a coefficient is deg or mm of the joint for each deg or mm of the other."""

    joint: str
    constant_deg: Number | None = None
    constant_mm: Length | None = None
    coefficients: dict[str, Number]

    def coupling(self, joints: Sequence[Joint]) -> Coupling:
        """In rad and mm. The section has to have no faults."""
        place = {joint.name: index for index, joint in enumerate(joints)}
        per = joints[place[self.joint]].per_file_unit
        constant = self.constant_deg if self.constant_mm is None else self.constant_mm
        return Coupling(
            place[self.joint],
            (constant or 0.0) * per,
            tuple(
                (place[name], value * (per / joints[place[name]].per_file_unit))
                for name, value in self.coefficients.items()
            ),
        )


def coupling_faults(sections: Sequence[CouplingSection], kinds: Mapping[str, JointKind]) -> list[str]:
    """What is wrong with the couplings of joints of these kinds."""
    faults = []
    driven = [section.joint for section in sections]
    for index, section in enumerate(sections):
        key = f"coupling[{index}]"
        faults += [
            f"{key}: there is no joint '{name}' (joints: {', '.join(kinds)})"
            for name in (section.joint, *section.coefficients)
            if name not in kinds
        ]
        if section.joint in kinds:
            slides = kinds[section.joint] is JointKind.PRISMATIC
            unit, other = ("mm", "deg") if slides else ("deg", "mm")
            if getattr(section, f"constant_{other}") is not None:
                does = "slides" if slides else "turns"
                faults.append(f"{key}.constant_{other}: joint '{section.joint}' {does}; give constant_{unit}")
            elif getattr(section, f"constant_{unit}") is None:
                faults.append(f"{key}.constant_{unit}: missing")
        if driven.index(section.joint) != index:
            faults.append(f"{key}.joint: '{section.joint}' is driven by two couplings")
        faults += [
            f"{key}.coefficients: '{name}' is itself driven by a coupling"
            for name in section.coefficients
            if name in driven
        ]
    return faults


def coupling_values(coupling: Coupling, joints: Sequence[Joint]) -> dict[str, object]:
    """A coupling as the section of a file says it."""
    driven = joints[coupling.joint]
    return {
        "joint": driven.name,
        f"constant_{driven.file_unit}": coupling.constant / driven.per_file_unit,
        "coefficients": {
            joints[other].name: value * joints[other].per_file_unit / driven.per_file_unit
            for other, value in coupling.coefficients
        },
    }
