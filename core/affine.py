"""Affine maps of the plane: compose, invert, measure, and take apart by polar decomposition.

A map is an array (..., 2, 3), ``[[a, b, e], [c, d, f]]``, standing for ``w(x) = L x + t`` with the linear part
``L = [[a, b], [c, d]]`` and the translation ``t = (e, f)``. All functions work on stacks of maps at once. What composes
and measures maps takes those of space (..., 3, 4) as well.
"""

from __future__ import annotations

import numpy as np


def compose(outer: np.ndarray, inner: np.ndarray) -> np.ndarray:
    """Compose maps, the inner one applied first.

    Parameters
    ----------
    outer, inner : (..., 2, 3)
        Stacks of maps, broadcast against each other.

    Returns
    -------
    (..., 2, 3)
        ``outer(inner(x))``.
    """
    outer, inner = np.asarray(outer, dtype=float), np.asarray(inner, dtype=float)
    product = outer[..., :, :-1] @ inner
    product[..., :, -1] += outer[..., :, -1]
    return product


def transform(maps: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Apply maps (..., 2, 3) to points (..., 2), broadcast against each other."""
    maps, points = np.asarray(maps, dtype=float), np.asarray(points, dtype=float)
    return np.einsum("...ij,...j->...i", maps[..., :, :-1], points) + maps[..., :, -1]


def invert(maps: np.ndarray) -> np.ndarray:
    """Inverse of maps (..., 2, 3).

    Raises
    ------
    numpy.linalg.LinAlgError
        If a map is singular.
    """
    maps = np.asarray(maps, dtype=float)
    linear = np.linalg.inv(maps[..., :, :-1])
    translation = -np.einsum("...ij,...j->...i", linear, maps[..., :, -1])
    return np.concatenate([linear, translation[..., None]], axis=-1)


def through(points: np.ndarray, images: np.ndarray) -> np.ndarray:
    """Map (2, 3) that takes three points (3, 2), not on one line, to their images (3, 2).

    Raises
    ------
    numpy.linalg.LinAlgError
        If the points lie on one line.
    """
    points, images = np.asarray(points, dtype=float), np.asarray(images, dtype=float)
    return np.linalg.solve(np.column_stack([points, np.ones(3)]), images).T


def determinant(linear: np.ndarray) -> np.ndarray:
    """Determinant of linear parts (..., 2, 2) or (..., 3, 3): the signed factor by which areas or volumes grow."""
    if linear.shape[-1] == 3:
        return np.linalg.det(linear)
    return linear[..., 0, 0] * linear[..., 1, 1] - linear[..., 0, 1] * linear[..., 1, 0]


def singular_values(linear: np.ndarray) -> np.ndarray:
    """The largest and the smallest singular value of linear parts (..., 2, 2), in closed form, or (..., 3, 3).

    Returns
    -------
    (..., 2)
        The largest, which is the Lipschitz constant of the map, and the smallest, which is never negative.
    """
    if linear.shape[-1] == 3:
        return np.linalg.svd(linear, compute_uv=False)[..., ::2]
    a, b, c, d = (linear[..., i, j] for i in (0, 1) for j in (0, 1))
    turning = np.hypot(a + d, c - b)
    mirroring = np.hypot(a - d, b + c)
    return np.stack([(turning + mirroring) / 2, np.abs(turning - mirroring) / 2], axis=-1)


def spectral_radius(linear: np.ndarray) -> np.ndarray:
    """Largest absolute eigenvalue of linear parts (..., 2, 2)."""
    half_trace = (linear[..., 0, 0] + linear[..., 1, 1]) / 2
    det = determinant(linear)
    discriminant = half_trace**2 - det
    real = np.abs(half_trace) + np.sqrt(np.maximum(discriminant, 0))
    return np.where(discriminant >= 0, real, np.sqrt(np.maximum(det, 0)))


def rotation(angle: np.ndarray | float, reflects: np.ndarray | bool = False) -> np.ndarray:
    """Orthogonal matrices (..., 2, 2): a turn by `angle` radians, after a mirroring of y where `reflects`."""
    angle = np.asarray(angle, dtype=float)
    sign = np.where(reflects, -1.0, 1.0)
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([np.stack([cos, -sin * sign], axis=-1), np.stack([sin, cos * sign], axis=-1)], axis=-2)


def polar(linear: np.ndarray, reflects: np.ndarray | bool | None = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Polar decomposition ``L = Q S`` in closed form, defined for every L, singular ones included.

    Burch & Hart 1997, Section 3, reach the same factors by iteration (`polar_by_iteration`).

    Parameters
    ----------
    linear : (..., 2, 2)
    reflects : (...,) bool, optional
        Whether Q is to be a reflection; by default where det L < 0. A singular L can be taken either way. Elsewhere
        the wrong choice still gives ``L = Q S``, with an S that has one negative eigenvalue.

    Returns
    -------
    angle : (...,)
        Radians in [-pi, pi]; ``Q = rotation(angle, reflects)``.
    reflects : (...,) bool
    stretch : (..., 2, 2)
        S, symmetric and positive semidefinite.
    """
    linear = np.asarray(linear, dtype=float)
    a, b, c, d = (linear[..., i, j] for i in (0, 1) for j in (0, 1))
    if reflects is None:
        reflects = determinant(linear) < 0
    # Adding 0.0 turns -0.0 into 0.0, which arctan2 would tell apart: a map of no size has no angle.
    angle = np.where(reflects, np.arctan2(b + c + 0.0, a - d + 0.0), np.arctan2(c - b + 0.0, a + d + 0.0))
    orthogonal = rotation(angle, reflects)
    stretch = np.swapaxes(orthogonal, -1, -2) @ linear
    return angle, reflects, (stretch + np.swapaxes(stretch, -1, -2)) / 2


def polar_by_iteration(linear: np.ndarray, tolerance: float = 1e-15) -> tuple[np.ndarray, np.ndarray, int]:
    """Polar decomposition of one matrix as the paper computes it (Burch & Hart 1997, Eq. 2 and 3).

    Parameters
    ----------
    linear : (2, 2)
        Must not be singular; the iteration averages Q with its inverse transpose.
    tolerance
        Relative change of Q at which the iteration stops.

    Returns
    -------
    orthogonal : (2, 2)
    stretch : (2, 2)
    iterations : int
        Grows with the conditioning of `linear`.

    Raises
    ------
    numpy.linalg.LinAlgError
        If `linear` is singular.
    """
    orthogonal = np.array(linear, dtype=float)
    iterations, change = 0, np.inf
    while change > tolerance * np.abs(orthogonal).max() and iterations < 200:
        following = (orthogonal + np.linalg.inv(orthogonal).T) / 2
        change = np.abs(following - orthogonal).max()
        orthogonal = following
        iterations += 1
    return orthogonal, np.linalg.inv(orthogonal) @ linear, iterations


def to_parameters(maps: np.ndarray) -> np.ndarray:
    """Maps as the numbers that a person edits; nothing is lost, whatever the map.

    The linear part is a turn of an upper triangle, ``L = R(angle) [[scale_x, shear], [0, scale_y]]``: the x axis
    is stretched to `scale_x` and turned, the y axis is stretched to `scale_y` and leans over by `shear`. A negative
    `scale_y` is a reflection.

    Parameters
    ----------
    maps : (..., 2, 3)

    Returns
    -------
    (..., 6)
        Angle in radians, scale_x >= 0, scale_y, shear, and the translation e, f.
    """
    maps = np.asarray(maps, dtype=float)
    (a, b, e), (c, d, f) = (np.moveaxis(maps[..., row, :], -1, 0) for row in (0, 1))
    scale_x = np.hypot(a, c)
    # Without a first column the turn is read off the second, which points along +y at angle zero.
    angle = np.where(scale_x == 0, np.arctan2(-b + 0.0, d + 0.0), np.arctan2(c + 0.0, a + 0.0))
    cos, sin = np.cos(angle), np.sin(angle)
    return np.stack([angle, scale_x, cos * d - sin * b, cos * b + sin * d, e, f], axis=-1)


def from_parameters(parameters: np.ndarray) -> np.ndarray:
    """Maps (..., 2, 3) from the numbers of `to_parameters` (..., 6)."""
    angle, scale_x, scale_y, shear, e, f = np.moveaxis(np.asarray(parameters, dtype=float), -1, 0)
    cos, sin = np.cos(angle), np.sin(angle)
    rows = [
        [cos * scale_x, cos * shear - sin * scale_y, e],
        [sin * scale_x, sin * shear + cos * scale_y, f],
    ]
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
