"""What of a picture is dark."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from planner.drawing.raster import Darkness

_BINS = 256
_ALIKE = 0.1
"""Where the dark and the light of a picture differ by less, it is all of one tone."""
_EVEN = 0.5


def threshold(darkness: Darkness) -> float:
    """Midway between the mean of what is dark and the mean of what is light, which are told apart where their variance
    is largest (Otsu, 1979)."""
    counts, edges = np.histogram(darkness, bins=_BINS, range=(0.0, 1.0))
    middles = (edges[:-1] + edges[1:]) / 2.0
    n_light, sum_light = np.cumsum(counts)[:-1], np.cumsum(counts * middles)[:-1]
    n_dark, sum_dark = darkness.size - n_light, (counts * middles).sum() - sum_light
    is_split = (n_light > 0) & (n_dark > 0)
    if not is_split.any():
        return _EVEN
    light, dark = (sums[is_split] / n[is_split] for sums, n in ((sum_light, n_light), (sum_dark, n_dark)))
    best = int(np.argmax(n_light[is_split] * n_dark[is_split] * (dark - light) ** 2))
    return float((light[best] + dark[best]) / 2.0) if dark[best] - light[best] >= _ALIKE else _EVEN


def blurred(darkness: Darkness, sigma_px: float) -> NDArray[np.float32]:
    """White paper lies around it, a pixel at least: edges of the picture are edges of what is dark there."""
    from scipy.ndimage import gaussian_filter

    inside = gaussian_filter(darkness, sigma_px, mode="nearest", truncate=3.0)
    return np.pad(inside, 1)
