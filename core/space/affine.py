"""Linear maps of space taken apart: polar decomposition, and turns as an axis with an angle by way of quaternions."""

from __future__ import annotations

import numpy as np

SINGULAR = 1e-12
"""A singular value below this share of the largest is none."""

UPRIGHT = 1e-9
"""Components of an axis smaller than this do not decide which way it points."""


def polar(linear: np.ndarray, like: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Polar decomposition ``L = Q S``, defined for every L, singular ones included.

    Burch & Hart 1997, Section 3, who reach the factors by iteration; here they come from the singular values.

    Parameters
    ----------
    linear : (N, 3, 3)
    like : (N, 3, 3), optional
        Orthogonal matrices. A singular L leaves Q open, which then is as near to these as can be and of the same
        orientation; by default they are the identity.

    Returns
    -------
    orthogonal : (N, 3, 3)
        Q, a turn or, where det L < 0, a turn with a reflection.
    stretch : (N, 3, 3)
        S, symmetric and positive semidefinite.
    """
    linear = np.asarray(linear, dtype=float)
    left, values, right = np.linalg.svd(linear)
    orthogonal = left @ right
    like = np.broadcast_to(np.eye(3), linear.shape) if like is None else like
    for i in np.flatnonzero(values[:, 2] <= SINGULAR * values[:, 0]):
        rank = int(np.count_nonzero(values[i] > SINGULAR * values[i, 0]))
        orthogonal[i] = _completed(left[i], right[i], rank, like[i])
    stretch = np.swapaxes(right, -1, -2) @ (values[..., None] * right)
    return orthogonal, stretch


def _completed(left: np.ndarray, right: np.ndarray, rank: int, like: np.ndarray) -> np.ndarray:
    """The orthogonal matrix that agrees with ``left @ right`` on the first `rank` axes and is nearest to `like`."""
    inner, _, outer = np.linalg.svd(left[:, rank:].T @ like @ right[rank:].T)
    kept = left[:, :rank] @ right[:rank]
    turned = left[:, rank:] @ inner
    completed = kept + turned @ outer @ right[rank:]
    if np.linalg.det(completed) * np.linalg.det(like) < 0:
        turned[:, -1] *= -1
        completed = kept + turned @ outer @ right[rank:]
    return completed


def axis_and_angle(turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Axis and angle of turns (N, 3, 3), by their quaternions (Shepperd 1978).

    Returns
    -------
    axis : (N, 3)
        Unit vectors that point up: with z above 0, or if that is 0 then y, or x. A turn about an upright axis so has
        the same angle as the turn of the plane that it is.
    angle : (N,)
        Radians in [-pi, pi], counter-clockwise positive as seen from the tip of the axis.
    """
    m = turn
    trace = np.trace(m, axis1=-2, axis2=-1)
    # The squares of w, x, y, z times four; the largest is the best to divide by.
    squares = np.stack([1 + trace, *(1 + 2 * m[..., k, k] - trace for k in range(3))], axis=-1)
    products = np.empty((*m.shape[:-2], 4, 4))
    for k in range(4):
        products[..., k, k] = squares[..., k]
    for k, (i, j) in enumerate(((1, 2), (2, 0), (0, 1))):
        products[..., 0, k + 1] = products[..., k + 1, 0] = m[..., j, i] - m[..., i, j]
        products[..., i + 1, j + 1] = products[..., j + 1, i + 1] = m[..., i, j] + m[..., j, i]
    largest = np.argmax(squares, axis=-1)
    quaternion = np.take_along_axis(products, largest[..., None, None], axis=-2)[..., 0, :]
    quaternion = quaternion / np.linalg.norm(quaternion, axis=-1, keepdims=True)
    size = np.linalg.norm(quaternion[..., 1:], axis=-1)
    upright = np.broadcast_to([0.0, 0.0, 1.0], (*size.shape, 3))
    axis = np.where(size[..., None] > 0, quaternion[..., 1:] / np.where(size > 0, size, 1.0)[..., None], upright)
    x, y, z = np.moveaxis(axis, -1, 0)
    decides = np.where(np.abs(z) > UPRIGHT, z, np.where(np.abs(y) > UPRIGHT, y, x))
    sign = np.where(decides < 0, -1.0, 1.0)
    angle = np.remainder(2 * np.arctan2(sign * size, quaternion[..., 0]) + np.pi, 2 * np.pi) - np.pi
    return sign[..., None] * axis, angle


def turned(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Turns (..., 3, 3) about axes (..., 3) by angles (...), in radians (Rodrigues 1840)."""
    x, y, z = np.moveaxis(axis, -1, 0)
    none = np.zeros_like(x)
    cross = np.stack([none, -z, y, z, none, -x, -y, x, none], axis=-1).reshape(*x.shape, 3, 3)
    sin, cos = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    return np.eye(3) + sin * cross + (1 - cos) * (cross @ cross)


def of_eigenvalues(symmetric: np.ndarray, function) -> np.ndarray:
    """A function of symmetric matrices (..., 3, 3): of their eigenvalues, the eigenvectors kept."""
    values, vectors = np.linalg.eigh(symmetric)
    return (vectors * function(values)[..., None, :]) @ np.swapaxes(vectors, -1, -2)
