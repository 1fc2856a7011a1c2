"""The door to OpenCV, which comes with the extra `vision`. Importing this raises UsageError where it is missing."""

from __future__ import annotations

from planner.errors import UsageError

try:
    import cv2
except ImportError as error:
    raise UsageError("tags on paper need the extra 'vision': pip install 'drawing-arm-planner[vision]'") from error

__all__ = ["cv2"]
