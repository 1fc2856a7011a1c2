"""All that is computed of an arm before anything is drawn with it: one value, built once and handed down."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial

from planner.arms.arm import Arm
from planner.kept import Arrays, kept
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits
from planner.kinematics.link_clearance import LinkClearance
from planner.redundancy.configuration_map import ConfigurationMap, configuration_branches, levelled
from planner.settings import ConfigurationWeights


class ArmModel:
    """An arm with its kinematics, clearances, limits of motion and configuration maps. Each part is built when it is
    first asked for, and kept: whoever needs one of an arm takes the model, and asks no one else. cache: what takes a
    while is looked for on disk too, and kept there."""

    def __init__(self, arm: Arm, *, cache: bool = True) -> None:
        self.arm = arm
        self._cache = cache
        self._branches: dict[ConfigurationWeights, tuple[ConfigurationMap, ...]] = {}

    @cached_property
    def kinematics(self) -> Kinematics:
        return Kinematics(self.arm)

    @property
    def clearance(self) -> LinkClearance:
        return self.kinematics.clearance

    @cached_property
    def limits(self) -> Limits:
        """Those that motions are timed within."""
        return Limits.of(self.arm)

    @cached_property
    def level(self) -> Kinematics:
        """Those of the arm on a level paper, which configuration maps are made for. Errors: as `levelled`."""
        level = levelled(self.arm)
        return self.kinematics if level is self.arm else Kinematics(level)

    def branches(self, weights: ConfigurationWeights | None = None) -> tuple[ConfigurationMap, ...]:
        """The configuration maps for these weights, or the arm's own, that of most radii first: see
        `configuration_branches`. Errors: PlanError where the arm cannot have one, ArmFileError where its file
        contradicts itself."""
        weights = weights or self.arm.weights
        if weights not in self._branches:
            arrays = self.kept(f"configuration branches, {weights!r}", partial(self._computed, weights))
            self._branches[weights] = tuple(
                ConfigurationMap(self.kinematics, self.level, arrays[f"radii {k}"], arrays[f"configurations {k}"])
                for k in range(len(arrays) // 2)
            )
        return self._branches[weights]

    def kept(self, question: str, answer: Callable[[], Arrays]) -> Arrays:
        """What `answer` says to a question about the arm: see `planner.kept`. Errors: those of `answer`."""
        return kept(f"{question} of {self.arm!r}", answer) if self._cache else answer()

    def _computed(self, weights: ConfigurationWeights) -> Arrays:
        branches = configuration_branches(self.kinematics, self.level, weights)
        return {f"radii {k}": branch.radii_mm for k, branch in enumerate(branches)} | {
            f"configurations {k}": branch.configurations for k, branch in enumerate(branches)
        }

    def configuration_map(self, weights: ConfigurationWeights | None = None) -> ConfigurationMap:
        """The first of the branches. Errors: as `branches`."""
        return self.branches(weights)[0]
