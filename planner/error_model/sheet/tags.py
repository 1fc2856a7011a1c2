"""The tags of a sheet: AprilTag 36h11, whose ids differ in at least 11 of 36 bits."""

from __future__ import annotations

import numpy as np

from planner.arrays import FloatArray
from planner.error_model.vision import cv2

FAMILY = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
N_MODULES = 8
"""Along a side, black border and all."""


def tag_modules(number: int) -> FloatArray:
    """(8, 8): the modules of a tag, black border and all, from the upper left: 0 black, 1 white."""
    picture = cv2.aruco.generateImageMarker(FAMILY, number, N_MODULES)
    return np.asarray(picture, dtype=np.float64) / 255
