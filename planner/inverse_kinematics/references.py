"""How a method uses the arm's redundancy: a reference configuration for every knot of a path.

A method is built once for an arm, with all that it needs of it, and then asked stroke by stroke.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol

import numpy as np

from planner.arrays import FloatArray, IntArray
from planner.redundancy.arm_model import ArmModel
from planner.redundancy.configuration_map import ConfigurationMap, branch_references
from planner.settings import ConfigurationWeights, Method

if TYPE_CHECKING:
    from planner.inverse_kinematics.closed_forms import ClosedForm

_HOME = ConfigurationWeights(time=0.1, sensitivity=0.0, reversals=0.0, limits=1.0)
"""Sequential methods start from a home that is well inside the joint limits."""

TARGET_SPACING_MM = 1.0
"""Distance between the targets that sequential methods solve for; splines carry their configurations between."""


class References(Protocol):
    """A method, ready for one arm. What it gives need be neither exact nor finite."""

    def along(self, tips_mm: FloatArray, starts: IntArray) -> FloatArray:
        """(n, n_independent) at the tips (n, 3) of paths that begin at `starts` (n_paths,), each path by itself."""
        ...

    def surely_along(self, tips_mm: FloatArray, starts: IntArray) -> FloatArray | None:
        """The same by a method that keeps to the joints' ranges and to a branch, for paths where this one does not;
        None where there is no other."""
        ...

    def at(self, tips_mm: FloatArray) -> FloatArray:
        """(n, n_independent) at single tips (n, 3), each by itself."""
        ...


def references_of(model: ArmModel, method: Method, weights: ConfigurationWeights | None = None) -> References:
    """The method for an arm, with the arm's own weights where none are given; no other one is loaded. Errors:
    PlannerError where the arm has no such method."""
    if method is Method.PATH:
        return _FromMap(model.branches(weights))
    if method is Method.CLOSED_FORM:
        from planner.inverse_kinematics.closed_forms import closed_form_of

        return _FromClosedForm(closed_form_of(model.arm))
    home, branches = home_of(model), partial(model.branches, weights)
    if method is Method.NLP:
        from planner.inverse_kinematics.nlp import NlpSolver

        nlp = NlpSolver(model.kinematics)
        return _InSequence(lambda tips_mm: nlp.solve_sequence(tips_mm, home).configurations, len(home), branches)
    from planner.inverse_kinematics.dls import FOR_DRAWING, DlsSolver

    dls, start = DlsSolver(model.kinematics), model.arm.complete(home)
    return _InSequence(
        lambda tips_mm: dls.solve_sequence(tips_mm, start, FOR_DRAWING).configurations, len(home), branches
    )


def home_of(model: ArmModel) -> FloatArray:
    """(n_independent,) the configuration that sequential methods start each stroke from. Errors: as
    `ArmModel.branches`."""
    return model.configuration_map(_HOME).home


@dataclass(frozen=True, eq=False, slots=True)
class _FromMap:
    """Those of the configuration map: the whole stroke in the branch that holds most of it."""

    branches: Sequence[ConfigurationMap]

    def along(self, tips_mm: FloatArray, starts: IntArray) -> FloatArray:
        return branch_references(self.branches, tips_mm, starts)

    def surely_along(self, tips_mm: FloatArray, starts: IntArray) -> None:
        return None

    def at(self, tips_mm: FloatArray) -> FloatArray:
        return branch_references(self.branches, tips_mm, np.arange(len(tips_mm)))


@dataclass(frozen=True, eq=False, slots=True)
class _FromClosedForm:
    """Those of the closed form, which looks at no neighbour."""

    configurations: ClosedForm

    def along(self, tips_mm: FloatArray, starts: IntArray) -> FloatArray:
        return self.configurations(tips_mm)

    def surely_along(self, tips_mm: FloatArray, starts: IntArray) -> None:
        return None

    def at(self, tips_mm: FloatArray) -> FloatArray:
        return self.configurations(tips_mm)


@dataclass(frozen=True, eq=False, slots=True)
class _InSequence:
    """Targets solved one after the other, the first of each path from the arm's home."""

    solve: Callable[[FloatArray], FloatArray]
    n_independent: int
    branches: Callable[[], Sequence[ConfigurationMap]]

    def along(self, tips_mm: FloatArray, starts: IntArray) -> FloatArray:
        ends = np.append(starts, len(tips_mm))
        return np.concatenate([self._along_one(tips_mm[first:last]) for first, last in pairwise(ends)])

    def surely_along(self, tips_mm: FloatArray, starts: IntArray) -> FloatArray:
        return branch_references(self.branches(), tips_mm, starts)

    def at(self, tips_mm: FloatArray) -> FloatArray:
        if len(tips_mm) == 0:
            return np.empty((0, self.n_independent))
        return np.concatenate([self.solve(tip[None]) for tip in tips_mm])

    def _along_one(self, tips_mm: FloatArray) -> FloatArray:
        """(n_knots, n_independent): targets about a millimetre apart are solved in turn and joined by a spline."""
        from scipy.interpolate import make_interp_spline  # heavy, and only these methods need it

        travelled = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(tips_mm, axis=0), axis=1))))
        count = max(int(np.ceil(travelled[-1] / TARGET_SPACING_MM)), 1) + 1
        wanted = np.searchsorted(travelled, np.linspace(0.0, travelled[-1], count))
        chosen = np.unique(np.concatenate(([0], np.minimum(wanted, len(tips_mm) - 1), [len(tips_mm) - 1])))
        configurations = np.nan_to_num(self.solve(tips_mm[chosen]))
        spline = make_interp_spline(chosen, configurations, k=min(5, 2 * ((len(chosen) - 2) // 2) + 1))
        references: FloatArray = np.ascontiguousarray(spline(np.arange(len(tips_mm))))
        return references
