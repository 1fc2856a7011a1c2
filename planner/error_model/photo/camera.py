"""Where a page lies in a picture: a homography, and a lens that bends lines a little.

With p = H (u, v, 1), in half diagonals from the picture's middle, a point is seen at p plus Brown's radial and
decentering distortion of it (Brown, "Decentering distortion of lenses", 1966); the optical axis is taken to be in the
middle, what it is off by looks like decentering.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from planner.arrays import FloatArray
from planner.error_model.photo.errors import PhotoError
from planner.error_model.photo.tags import SeenTags

_CORNER_PX = 0.1  # sd of a corner's place, at best
_PRIOR_SD = np.array([0.1, 0.05, 0.005, 0.005])  # of the lens; those of phones are well within
_SPREAD_SD = 0.2  # mm, how far black looks to reach into white, by ink or by light
_ASTRAY = 0.03  # of half a picture's diagonal: corners that are usually farther off belong to no page
_N_SHAPE = 12


@dataclass(frozen=True, eq=False, slots=True)
class Camera:
    """shape: (12,): H but its last element, 1, for page coordinates in half extents from its middle; radial k1 and k2,
    decentering p1 and p2.

    covariance: (12, 12) of it. centre_px (2,), half_px: the picture's middle and half its diagonal. middle_mm (2,),
    half_mm: the page's. residual_px: rms distance of the tags' corners from where they should be.
    """

    shape: FloatArray
    covariance: FloatArray
    centre_px: FloatArray
    half_px: float
    middle_mm: FloatArray
    half_mm: float
    residual_px: float

    def to_picture_px(self, page_mm: FloatArray) -> FloatArray:
        """(..., 2) pixels, from the middle of the upper left one, of points (..., 2) on the page."""
        return self._seen_px(self.shape, page_mm)

    def px_per_mm(self, page_mm: FloatArray) -> FloatArray:
        """(..., 2): pixels in a millimetre at points (..., 2) of the page, in the direction that has least and in the
        one that has most."""
        most_first = np.asarray(np.linalg.svd(self._jacobian(page_mm), compute_uv=False), dtype=np.float64)
        return most_first[..., ::-1]

    def sd_mm(self, page_mm: FloatArray) -> FloatArray:
        """(...,): how far points of the page may be from where they are taken to be, along each axis, by the fit
        alone."""
        steps = 1e-6 * np.eye(_N_SHAPE)
        px_by_shape = np.stack(
            [
                (self._seen_px(self.shape + step, page_mm) - self._seen_px(self.shape - step, page_mm)) / 2e-6
                for step in steps
            ],
            axis=-1,
        )
        by_shape = np.asarray(np.linalg.solve(self._jacobian(page_mm), px_by_shape), dtype=np.float64)
        sd: FloatArray = np.sqrt(np.einsum("...ij,jk,...ik->...i", by_shape, self.covariance, by_shape).mean(axis=-1))
        return sd

    def _seen_px(self, shape: FloatArray, page_mm: FloatArray) -> FloatArray:
        return self.centre_px + self.half_px * _seen(shape, (page_mm - self.middle_mm) / self.half_mm)

    def _jacobian(self, page_mm: FloatArray) -> FloatArray:
        """(..., 2, 2): px by mm."""
        steps = 1e-3 * np.eye(2)
        return np.stack(
            [(self.to_picture_px(page_mm + step) - self.to_picture_px(page_mm - step)) / 2e-3 for step in steps],
            axis=-1,
        )


def fit_camera(source: str, tags: SeenTags, picture_shape: tuple[int, ...]) -> Camera:
    """Least squares over the corners of all tags, robust against a few that are wrong. Errors: PhotoError where they
    cannot be those of a flat page."""
    rows, columns = picture_shape[:2]
    centre, half = np.array([columns - 1, rows - 1]) / 2, float(np.hypot(columns, rows)) / 2
    extent = np.array(tags.layout.page.extent_mm)
    middle, half_mm = extent / 2, float(extent.max()) / 2
    page = ((tags.page_mm - middle) / half_mm).reshape(-1, 2)
    outward = np.sign(tags.page_mm - tags.page_mm.mean(axis=1, keepdims=True)).reshape(-1, 2) / half_mm
    seen = ((tags.picture_px - centre) / half).reshape(-1, 2)

    def residuals(parameters: FloatArray) -> FloatArray:
        """In standard deviations. The last parameter is how far black reaches into white."""
        off = _seen(parameters[:_N_SHAPE], page + parameters[-1] * outward) - seen
        return np.concatenate(
            (off.ravel() * half / _CORNER_PX, parameters[8:_N_SHAPE] / _PRIOR_SD, parameters[-1:] / _SPREAD_SD)
        )

    start = _homography(page, seen)
    found = least_squares(
        residuals,
        np.concatenate((np.where(np.isfinite(start), start, 0.0), np.zeros(5))),
        loss="soft_l1",
        f_scale=2.0,
        x_scale="jac",
    )
    off = residuals(found.x)[: seen.size].reshape(-1, 2)
    if not found.success or float(np.median(np.abs(off))) * _CORNER_PX > _ASTRAY * half:
        raise PhotoError(
            source,
            "its tags are not where those of a flat sheet would be seen; lay the sheet flat, and photograph all of it, "
            "sharp and in even light",
        )
    excess = max(1.0, float(np.square(off).mean()))
    jacobian: FloatArray = np.asarray(found.jac)
    covariance = np.asarray(excess * np.linalg.inv(jacobian.T @ jacobian), dtype=np.float64)[:_N_SHAPE, :_N_SHAPE]
    return Camera(
        found.x[:_N_SHAPE],
        covariance,
        centre,
        half,
        middle,
        half_mm,
        _CORNER_PX * float(np.sqrt(np.square(off).sum(axis=-1).mean())),
    )


def _seen(shape: FloatArray, page: FloatArray) -> FloatArray:
    """(..., 2) points of the picture, in half diagonals from its middle."""
    h = np.append(shape[:8], 1.0).reshape(3, 3)
    k1, k2, p1, p2 = shape[8:]
    depth = page @ h[2, :2] + h[2, 2]
    straight = (page @ h[:2, :2].T + h[:2, 2]) / depth[..., None]
    x, y = straight[..., 0], straight[..., 1]
    r2 = x * x + y * y
    grown = 1 + r2 * (k1 + k2 * r2)
    bent: FloatArray = np.stack(
        (x * grown + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * grown + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y),
        axis=-1,
    )
    return bent


def _homography(page: FloatArray, seen: FloatArray) -> FloatArray:
    """(8,): by the direct linear transformation, from which the fit sets out."""
    one, nil = np.ones((len(page), 1)), np.zeros((len(page), 3))
    p = np.hstack((page, one))
    rows = np.vstack((np.hstack((p, nil, -seen[:, :1] * p)), np.hstack((nil, p, -seen[:, 1:] * p))))
    h = np.linalg.svd(rows)[2][-1]
    scaled: FloatArray = h[:8] / h[8]
    return scaled
