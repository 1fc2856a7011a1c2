"""The matrices that the documents' worked example of damped least squares prints for its first iteration, in
centimetres and radians; `planner.comparison.worked_example` holds its iterations."""

from __future__ import annotations

JACOBIAN = (
    (0.0, 1.4598, 5.7899, 7.5, 5.0),
    (11.5286, 0.0, 0.0, 0.0, 0.0),
    (0.0, 11.5286, 9.0286, 4.3301, 0.0),
    (0.0, 0.0, 0.0, 0.0, 0.0),
    (0.0, -1.0, -1.0, -1.0, -1.0),
    (1.0, 0.0, 0.0, 0.0, 0.0),
)
"""At the start: linear rows in cm, then angular ones."""

J_JT = (
    (116.9039, 0.0, 101.5797, 0.0, -19.7497, 0.0),
    (0.0, 132.9084, 0.0, 0.0, 0.0, 11.5286),
    (101.5797, 0.0, 233.1738, 0.0, -24.8873, 0.0),
    (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    (-19.7497, 0.0, -24.8873, 0.0, 4.0, 0.0),
    (0.0, 11.5286, 0.0, 0.0, 0.0, 1.0),
)

DAMPED_PSEUDOINVERSE = (
    (0.0, 0.0627, 0.0, 0.0, 0.0, 0.0054),
    (-0.0208, 0.0, 0.0478, 0.0, -0.0041, 0.0),
    (0.0196, 0.0, 0.0249, 0.0, 0.0001, 0.0),
    (0.0454, 0.0, -0.0012, 0.0, -0.0025, 0.0),
    (0.0374, 0.0, -0.0144, 0.0, -0.0115, 0.0),
)
