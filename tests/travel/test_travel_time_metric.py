"""Distances between mapped points tell how long the arm travels between them."""

from __future__ import annotations

import numpy as np
import pytest

from planner.travel.travel_time_metric import travel_time_metric
from tests.arms.chains import DRAWING_ARMS, load_once, model_of


@pytest.mark.parametrize("name", DRAWING_ARMS)
def test_points_are_joined_by_the_joints_motion_over_its_jerk(name: str) -> None:
    arm = load_once(name)
    points = np.array([[100.0, 0.0], [100.0 * np.cos(0.3), 100.0 * np.sin(0.3)], [105.0, 0.0]])
    configurations, good = model_of(arm).configuration_map().configurations_at(np.column_stack((points, np.zeros(3))))
    assert good.all()
    mapped = travel_time_metric(model_of(arm))(points)
    np.testing.assert_allclose(
        np.diff(mapped, axis=0) * arm.max_jerk, np.diff(arm.complete(configurations), axis=0), atol=1e-4
    )
    turn = np.zeros(arm.n_joints)
    turn[0] = 0.3 / arm.max_jerk[0]
    np.testing.assert_allclose(mapped[1] - mapped[0], turn, atol=1e-12)
