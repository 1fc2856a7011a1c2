"""All that is computed of an arm before anything is drawn with it: one value, built once and handed down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from planner.arms.arm import Arm
from planner.arrays import FloatArray
from planner.kept import Arrays, kept
from planner.kinematics.chain import Kinematics
from planner.kinematics.limits import Limits
from planner.kinematics.link_clearance import LinkClearance
from planner.redundancy.configuration_map import ConfigurationMap
from planner.redundancy.ring_map import RingMap, levelled, ray_of, ring_branches
from planner.settings import ConfigurationWeights

if TYPE_CHECKING:
    from planner.redundancy.plane_map import PlaneMap


class ArmModel:
    """An arm with its kinematics, clearances, limits of motion and configuration maps. Each part is built when it is
    first asked for, and kept: whoever needs one of an arm takes the model, and asks no one else. cache: what takes a
    while is looked for on disk too, and kept there."""

    def __init__(self, arm: Arm, *, cache: bool = True) -> None:
        self.arm = arm
        self._cache = cache
        self._rings: dict[ConfigurationWeights, tuple[RingMap, ...]] = {}
        self._plane_maps: dict[ConfigurationWeights, tuple[PlaneMap, ...]] = {}

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
        """Those of the arm on a level paper, which the maps of an arm that turns over its paper are made for;
        of the arm as it is where it does not."""
        if not self.kinematics.turns_over_paper:
            return self.kinematics
        ray = self.kept("ray", lambda: {"rad": np.array(ray_of(self.kinematics))})
        return levelled(self.kinematics, float(ray["rad"]))

    def branches(self, weights: ConfigurationWeights | None = None) -> tuple[ConfigurationMap, ...]:
        """The configuration maps for these weights, or the arm's own, that of most of the paper first: rings where the
        arm turns over its paper. Errors: PlanError where the arm cannot have one, ArmFileError where its file
        contradicts itself."""
        return self.rings(weights) if self.kinematics.turns_over_paper else self.planes(weights)

    def rings(self, weights: ConfigurationWeights | None = None) -> tuple[RingMap, ...]:
        """The branches of an arm that turns over its paper; none for others. Errors: as `branches`."""
        if not self.kinematics.turns_over_paper:
            return ()
        weights = weights or self.arm.weights
        if weights not in self._rings:
            arrays = self._maps(weights, lambda: ring_branches(self.kinematics, self.level, weights))
            self._rings[weights] = tuple(RingMap.of(self.kinematics, self.level, of_one) for of_one in arrays)
        return self._rings[weights]

    def planes(self, weights: ConfigurationWeights | None = None) -> tuple[PlaneMap, ...]:
        """The branches of an arm that does not turn over its paper; none for others. Errors: as `branches`."""
        if self.kinematics.turns_over_paper:
            return ()
        weights = weights or self.arm.weights
        if weights not in self._plane_maps:
            from planner.redundancy.plane_map import PlaneMap, plane_branches  # most arms turn over their paper

            arrays = self._maps(weights, lambda: plane_branches(self.kinematics, weights))
            self._plane_maps[weights] = tuple(PlaneMap.of(self.kinematics, of_one) for of_one in arrays)
        return self._plane_maps[weights]

    def _maps(
        self, weights: ConfigurationWeights, made: Callable[[], Sequence[RingMap | PlaneMap]]
    ) -> list[dict[str, FloatArray]]:
        """The arrays of each map, in order."""

        def answer() -> Arrays:
            return {f"{k} {name}": array for k, one in enumerate(made()) for name, array in one.arrays.items()}

        each: dict[int, dict[str, FloatArray]] = {}
        for key, array in self.kept(f"configuration branches, {weights!r}", answer).items():
            number, name = key.split(" ", 1)
            each.setdefault(int(number), {})[name] = array
        return [each[k] for k in sorted(each)]

    def kept(self, question: str, answer: Callable[[], Arrays]) -> Arrays:
        """What `answer` says to a question about the arm: see `planner.kept`. Errors: those of `answer`."""
        return kept(f"{question} of {self.arm!r}", answer) if self._cache else answer()

    def configuration_map(self, weights: ConfigurationWeights | None = None) -> ConfigurationMap:
        """The first of the branches. Errors: as `branches`."""
        return self.branches(weights)[0]
