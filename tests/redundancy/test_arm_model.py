"""One model of an arm is built once and handed down: no function looks for it anywhere else."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

import planner
from planner.arms.arm_file import load_arm
from planner.redundancy.arm_model import ArmModel
from planner.settings import ConfigurationWeights
from tests.arms.chains import load_once

KEPT = {
    "drawing/style/cascade.py": "what the names of attributes mean",
    "drawing/style/colour.py": "what texts mean as colours",
    "drawing/style/declarations.py": "what texts mean as declarations",
    "drawing/text/faces.py": "the faces of the package",
    "drawing/text/families.py": "the fonts of this machine",
    "execution/context.py": "the context that chunks of one plan share in a process",
    "kept.py": "which version of the package this is",
    "spline.py": "constants",
}


def test_arms_are_equal_where_their_files_say_the_same() -> None:
    one, other = load_arm("so101"), load_arm("so101")
    assert one is not other and one == other and hash(one) == hash(other)
    assert one.minimum.shape == (one.n_joints,)  # what is derived from an arm, and kept, is no part of it
    assert one == other and hash(one) == hash(other)
    quicker = replace(one.joints[1], max_jerk=2 * one.joints[1].max_jerk)
    assert replace(one, joints=(one.joints[0], quicker, *one.joints[2:])) != one
    assert load_arm("scara") != one


def test_a_model_builds_each_part_once() -> None:
    model, weights = ArmModel(load_once("scara")), ConfigurationWeights(time=2.0)
    assert model.kinematics is model.kinematics and model.clearance is model.kinematics.clearance
    assert model.branches(weights) is model.branches(ConfigurationWeights(time=2.0))
    assert model.configuration_map(weights) is model.branches(weights)[0] is not model.configuration_map()
    assert model.configuration_map().kinematics is model.kinematics
    np.testing.assert_allclose(model.limits.velocity, model.arm.max_velocity, rtol=2e-6)


def test_nothing_is_kept_behind_the_back_of_a_caller() -> None:
    root = Path(planner.__file__).parent
    cached = re.compile(r"^\s*@(functools\.)?(lru_)?cache\b", re.MULTILINE)
    found = {
        file.relative_to(root).as_posix()
        for file in root.rglob("*.py")
        if cached.search(file.read_text(encoding="utf-8"))
    }
    assert found == set(KEPT)
