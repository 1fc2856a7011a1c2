"""What every work chunk of a plan needs: the arm's model, the method, the settings."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

from planner.arms.arm import Arm
from planner.inverse_kinematics.references import References, references_of
from planner.redundancy.arm_model import ArmModel
from planner.settings import PlanSettings


@dataclass(frozen=True, eq=False)
class PlanContext:
    """Goes to another process as arm and settings: the models, which cannot travel, are built there, once."""

    model: ArmModel
    settings: PlanSettings

    @staticmethod
    def of(arm: Arm, settings: PlanSettings) -> PlanContext:
        return PlanContext(ArmModel(arm, cache=settings.cache), settings)

    @cached_property
    def references(self) -> References:
        """The method of the settings. Errors: PlannerError where the arm has no such method."""
        return references_of(self.model, self.settings.method, self.settings.weights)

    def make_ready(self) -> None:
        """Build what the first work chunk would have to wait for. Errors: as `ArmModel.branches`."""
        self.model.branches(self.settings.weights)

    def __reduce__(self) -> tuple[Any, ...]:
        return _of_this_process, (self.model.arm, self.settings)


@lru_cache(maxsize=4)
def _of_this_process(arm: Arm, settings: PlanSettings) -> PlanContext:
    """The context that chunks from another process share here."""
    return PlanContext.of(arm, settings)
