"""Symmetries of an attractor: the turns and mirrorings that map it onto itself.

If g is one, ``w o g`` may take the place of any map w: the attractor stays, but the morph becomes another.
"""

from __future__ import annotations

import numpy as np

from ..affine import determinant, rotation
from ..ifs import IFS
from ..kernels import njit

DEGREE = 12
"""Of the moments compared: those up to it tell turns of up to as many folds."""

EXACT = 1e-6
"""Moments in units of the enclosing radius that differ by less are equal."""

SPREAD = 1e-6
"""An attractor this thin, or this small, has no use for symmetries."""

POINTS = 1500
"""Of the cut by which a symmetry is checked."""


def symmetries(ifs: IFS) -> np.ndarray:
    """The symmetries of an attractor, the identity first.

    A symmetry of a shape that is made in a symmetric way keeps its measure too, the one with weights by area. So the
    candidates are those that keep the mean and the higher moments, which linear equations give exactly: with the mean
    at the origin, a turn by 360/n degrees must leave ``E[z^p conj(z)^q]`` as it is, and an axis of a mirroring shows in
    the phases. Each is then checked by the Hausdorff distance of a cut of the attractor to its image.

    Parameters
    ----------
    ifs : IFS
        With an attractor.

    Returns
    -------
    (G, 2, 3)
        Maps: turns by ascending angle, then mirrorings.
    """
    identity = np.array([[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]])
    _, radius = ifs.enclosing_disc
    if radius == 0 or ifs.count == 1 or ifs.is_recurrent:
        return identity
    areas = np.abs(determinant(ifs.linear))
    weights = np.maximum(areas, 0.01 * areas.sum())
    if weights.sum() == 0:
        return identity
    weights = weights / weights.sum()
    mean = np.linalg.solve(
        np.eye(2) - np.einsum("i,ijk->jk", weights, ifs.linear), np.einsum("i,ij->j", weights, ifs.translation)
    )
    shift = (ifs.translation + ifs.linear @ mean - mean) / radius
    moments = _moments(ifs.linear, shift, weights)
    if moments[1, 1].real < SPREAD**2:
        return identity
    order = np.subtract.outer(np.arange(DEGREE + 1), np.arange(DEGREE + 1))
    turns = [2 * np.pi * k / n for n in range(1, DEGREE + 1) for k in range(n) if np.gcd(k, n) == 1]
    kept = [
        (angle, False) for angle in sorted(turns) if np.abs(moments * (np.exp(1j * order * angle) - 1)).max() < EXACT
    ]
    axes = [
        (angle, True)
        for angle in _axes(moments, order)
        if np.abs(np.exp(1j * order * angle) * moments.conj() - moments).max() < EXACT
    ]
    if len(kept) + len(axes) == 1:
        return identity
    candidates = kept + axes
    orthogonal = rotation(np.array([angle for angle, _ in candidates]), np.array([flip for _, flip in candidates]))
    orthogonal[0] = np.eye(2)
    points, spacing = _cut(ifs, mean)
    close = [_furthest(points @ turned.T, points, (2 * spacing) ** 2) <= (2 * spacing) ** 2 for turned in orthogonal]
    orthogonal = orthogonal[np.array(close)]
    return np.concatenate([orthogonal, (mean - orthogonal @ mean)[..., None]], axis=-1)


def _moments(linear: np.ndarray, shift: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Moments ``E[z^p conj(z)^q]`` (DEGREE + 1, DEGREE + 1) of the invariant measure; zero beyond the degree.

    With ``w_i(z) = a z + b conj(z) + c`` those of one degree solve linear equations, whose right side has the lower
    degrees.
    """
    x, y = linear[:, :, 0], linear[:, :, 1]
    first, second = x[:, 0] + 1j * x[:, 1], y[:, 0] + 1j * y[:, 1]
    a, b, c = (first - 1j * second) / 2, (first + 1j * second) / 2, shift[:, 0] + 1j * shift[:, 1]
    size = DEGREE + 1
    # power[p][i, r, s] is the coefficient of z^r conj(z)^s in w_i(z)^p.
    power = np.zeros((size, len(a), size, size), dtype=complex)
    power[0, :, 0, 0] = 1
    for p in range(1, size):
        power[p] = c[:, None, None] * power[p - 1]
        power[p, :, 1:, :] += a[:, None, None] * power[p - 1, :, :-1, :]
        power[p, :, :, 1:] += b[:, None, None] * power[p - 1, :, :, :-1]
    conjugate = power.conj().swapaxes(-1, -2)
    moments = np.zeros((size, size), dtype=complex)
    moments[0, 0] = 1
    for degree in range(1, size):
        matrix, right = np.zeros((size, size), dtype=complex), np.zeros(size, dtype=complex)
        for p in range(degree + 1):
            product = np.zeros((size, size), dtype=complex)
            for r in range(p + 1):
                for s in range(p + 1 - r):
                    factor = weights * power[p, :, r, s]
                    product[r:, s:] += np.einsum("i,ijk->jk", factor, conjugate[degree - p, :, : size - r, : size - s])
            right[p] = (product * moments).sum()
            matrix[p, : degree + 1] = product[np.arange(degree + 1), degree - np.arange(degree + 1)]
        block = slice(0, degree + 1)
        solved = np.linalg.solve(np.eye(degree + 1) - matrix[block, block], right[block])
        moments[np.arange(degree + 1), degree - np.arange(degree + 1)] = solved
    return moments


def _axes(moments: np.ndarray, order: np.ndarray) -> list[float]:
    """Angles of the mirrorings ``z -> e^(i angle) conj(z)`` that the most telling moment allows."""
    telling = np.where(order > 0, np.abs(moments), 0.0)
    large = telling > max(1e3 * EXACT, 1e-3 * telling.max())
    if not large.any():
        return []
    # The lowest order has the fewest candidates.
    lowest = order[large].min()
    p, q = np.unravel_index(np.argmax(np.where(order == lowest, telling, 0.0)), telling.shape)
    angle = 2 * np.angle(moments[p, q]) / lowest
    found = np.remainder(angle + 2 * np.pi * np.arange(lowest) / lowest, 2 * np.pi)
    # A hair below a full turn is none.
    return sorted(np.where(found > 2 * np.pi - 1e-9, 0.0, found).tolist())


def _cut(ifs: IFS, mean: np.ndarray) -> tuple[np.ndarray, float]:
    """Points (P, 2) of the attractor about its mean, and how far from them the attractor reaches at most."""
    center, radius = ifs.enclosing_disc
    words = np.concatenate([np.eye(2), np.zeros((2, 1))], axis=1)[None]
    sizes = np.array([1.0])
    start = ifs.fixed_points[0]
    while True:
        # The largest piece is split until there are enough.
        cut = sizes > sizes.max() * 0.7
        if len(words) + np.count_nonzero(cut) * (ifs.count - 1) > POINTS:
            break
        parents = words[cut]
        linear = parents[:, None, :, :2] @ ifs.linear
        translation = np.einsum("pij,kj->pki", parents[:, :, :2], ifs.translation) + parents[:, None, :, 2]
        children = np.concatenate([linear, translation[..., None]], axis=-1).reshape(-1, 2, 3)
        words = np.concatenate([words[~cut], children])
        sizes = np.linalg.norm(words[:, :, :2], 2, axis=(1, 2))
        if sizes.max() < 1e-4:
            break
    reach = radius + np.hypot(*(start - center))
    return words[:, :, :2] @ start + words[:, :, 2] - mean, float(sizes.max() * reach)


@njit(nogil=True, cache=True)
def _furthest(points, others, enough):
    """Square of the longest distance of a point to the nearest of the others; ends above `enough`."""
    furthest = 0.0
    for i in range(points.shape[0]):
        nearest = np.inf
        for j in range(others.shape[0]):
            dx, dy = points[i, 0] - others[j, 0], points[i, 1] - others[j, 1]
            nearest = min(nearest, dx * dx + dy * dy)
        furthest = max(furthest, nearest)
        if furthest > enough:
            break
    return furthest
