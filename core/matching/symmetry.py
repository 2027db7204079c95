"""Symmetries of an attractor: the turns and mirrorings that map it onto itself, in the plane or in space.

If g is one, ``w o g`` may take the place of any map w: the attractor stays, but the morph becomes another.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from ..affine import compose, determinant
from ..ifs import IFS
from ..kernels import njit
from ..space.affine import axis_and_angle

DEGREE = {2: 12, 3: 6}
"""Of the moments compared, for each number of dimensions."""

EXACT = 1e-6
"""Moments in units of the enclosing radius that differ by less are equal."""

SPREAD = 1e-6
"""An attractor this thin, or this small, has no use for symmetries."""

POINTS = {2: 1500, 3: 600}
"""Of the cut by which a symmetry is checked."""

TIED = 1e-6
"""Distances, in units of the enclosing radius, that differ by less are equal: maps may be given in single precision."""

SAME = 1e-4
"""Points this close to each other are one: the one that is furthest."""

PRECISE, ROUNDING = 1e-12, 1e-14
"""How precisely such a point is found, and the rounding of the maps for that."""

MOST_PIECES = 4000
"""Pieces that may be furthest from the mean, beyond which there is no telling."""


def symmetries(ifs: IFS) -> np.ndarray:
    """The symmetries of an attractor, the identity first.

    A symmetry takes the mean to itself, and the points furthest from it to each other. So the candidates are what takes
    one or two of these points to others as far from each other. A symmetry of a shape that is made in a symmetric way
    also keeps its measure, the one with weights by area or volume, and the moments of that, which linear equations give
    exactly, tell. Each candidate that does is checked by the Hausdorff distance of a cut of the attractor to its image.

    Parameters
    ----------
    ifs : IFS
        With an attractor.

    Returns
    -------
    (G, 2, 3), or (G, 3, 4) in space
        Maps: turns by ascending angle, then mirrorings.
    """
    dimension = ifs.DIMENSION
    identity = np.eye(dimension, dimension + 1)[None]
    center, radius = ifs.enclosing_disc
    if radius == 0 or ifs.count == 1 or ifs.is_recurrent:
        return identity
    sizes = np.abs(determinant(ifs.linear))
    weights = np.maximum(sizes, 0.01 * sizes.sum())
    if weights.sum() == 0:
        return identity
    weights = weights / weights.sum()
    mean = np.linalg.solve(
        np.eye(dimension) - np.einsum("i,ijk->jk", weights, ifs.linear), np.einsum("i,ij->j", weights, ifs.translation)
    )
    # About the mean, in units of the radius.
    shift = (ifs.translation + ifs.linear @ mean - mean) / radius
    maps = np.concatenate([ifs.linear, shift[..., None]], axis=-1)
    powers = _Powers(dimension, DEGREE[dimension])
    moments = powers.moments(maps, weights)
    if powers.spread(moments) < SPREAD**2:
        return identity
    orthogonal = _candidates(maps, (center - mean) / radius)
    at_rest = np.concatenate([orthogonal, np.zeros((*orthogonal.shape[:2], 1))], axis=-1)
    orthogonal = orthogonal[np.abs(powers.images(at_rest) @ moments - moments).max(axis=1) < EXACT]
    orthogonal = orthogonal[np.lexsort(_order(orthogonal)[::-1])]
    if len(orthogonal) < 2:
        return identity
    orthogonal[0] = np.eye(dimension)
    points, spacing = _cut(ifs, mean)
    close = [_furthest(points @ turned.T, points, (2 * spacing) ** 2) <= (2 * spacing) ** 2 for turned in orthogonal]
    orthogonal = orthogonal[np.array(close)]
    return np.concatenate([orthogonal, (mean - orthogonal @ mean)[..., None]], axis=-1)


class _Powers:
    """Products of powers of the coordinates, such as ``x^2 y``, up to a degree: what moments are the means of."""

    def __init__(self, dimension: int, degree: int) -> None:
        exponents = [each for each in product(range(degree + 1), repeat=dimension) if sum(each) <= degree]
        self.exponents = np.array(sorted(exponents, key=lambda each: (sum(each), each)))
        place = {tuple(each): k for k, each in enumerate(self.exponents.tolist())}
        # What each becomes when it is multiplied by a coordinate; -1 beyond the degree.
        steps = np.eye(dimension, dtype=int)
        self.times = np.array([[place.get(tuple(each), -1) for each in self.exponents + step] for step in steps])

    def images(self, maps: np.ndarray) -> np.ndarray:
        """Coefficients (M, P, P) of the products of the coordinates of w(x), a row each, for maps (M, D, D + 1)."""
        count = len(self.exponents)
        found = np.zeros((len(maps), count, count))
        found[:, 0, 0] = 1
        for k in range(1, count):
            # A product is the one without its first coordinate, times that.
            axis = int(np.argmax(self.exponents[k] > 0))
            before = found[:, np.flatnonzero(self.times[axis] == k)[0]]
            found[:, k] = maps[:, axis, -1, None] * before
            for other, places in enumerate(self.times):
                within = places >= 0
                found[:, k, places[within]] += maps[:, axis, other, None] * before[:, within]
        return found

    def moments(self, maps: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Means (P,) of the products over the invariant measure; it is the fixed point of what the maps do to it."""
        matrix = np.einsum("i,ijk->jk", weights, self.images(maps))
        rest = np.linalg.solve(np.eye(len(matrix) - 1) - matrix[1:, 1:], matrix[1:, 0])
        return np.append(1.0, rest)

    def spread(self, moments: np.ndarray) -> float:
        """The mean square of the distance from the mean."""
        return float(moments[(self.exponents.sum(axis=1) == 2) & (self.exponents.max(axis=1) == 2)].sum())


def _candidates(maps: np.ndarray, center: np.ndarray) -> np.ndarray:
    """Orthogonal matrices (C, D, D) that take points furthest from the mean to such points."""
    dimension = len(center)
    start = np.linalg.solve(np.eye(dimension) - maps[0, :, :-1], maps[0, :, -1])
    ends = [_furthest_points(maps, center, start, np.eye(dimension))]
    if len(ends[0]) == 0:
        return np.eye(dimension)[None]
    chosen = ends[0][0]
    if dimension == 3:
        # A second point aside from the axis through the first one: of the same kind, or else furthest from that axis.
        direction = chosen / np.linalg.norm(chosen)
        across = np.eye(3) - np.outer(direction, direction)
        aside = np.linalg.norm(ends[0] @ across, axis=1)
        ends.append(ends[0] if aside.max() > SPREAD else _furthest_points(maps, center, start, across))
        if len(ends[1]) == 0:
            return np.eye(3)[None]
        chosen = np.stack([chosen, ends[1][np.argmax(np.linalg.norm(ends[1] @ across, axis=1))]])
        if np.linalg.norm(chosen[1] @ across) < SPREAD:
            return np.eye(3)[None]
    chosen = np.atleast_2d(chosen)
    images = np.array(list(product(*ends)))
    alike = np.abs(images @ images.swapaxes(-1, -2) - chosen @ chosen.T).max(axis=(1, 2)) < 10 * TIED
    before, after = _frame(chosen[None])[0], _frame(images[alike])
    mirror = np.ones(dimension)
    mirror[-1] = -1
    return np.concatenate([after @ before.T, (after * mirror) @ before.T])


def _frame(points: np.ndarray) -> np.ndarray:
    """Orthonormal columns (C, D, D) by D - 1 points each (C, D - 1, D), and the last one square to them all."""
    dimension = points.shape[-1]
    columns = np.concatenate([points.swapaxes(-1, -2), np.zeros((len(points), dimension, 1))], axis=-1)
    for k in range(dimension - 1):
        for j in range(k):
            columns[:, :, k] -= (columns[:, :, j] * columns[:, :, k]).sum(axis=1, keepdims=True) * columns[:, :, j]
        columns[:, :, k] /= np.linalg.norm(columns[:, :, k], axis=1, keepdims=True)
    if dimension == 2:
        columns[:, 0, 1], columns[:, 1, 1] = -columns[:, 1, 0], columns[:, 0, 0]
    else:
        columns[:, :, 2] = np.cross(columns[:, :, 0], columns[:, :, 1])
    return columns


def _furthest_points(maps: np.ndarray, center: np.ndarray, start: np.ndarray, across: np.ndarray) -> np.ndarray:
    """Points (F, D) of the attractor that are furthest from the origin, of what a projection (D, D) leaves of them.

    None if they are too many.
    """
    known = maps, center, start, across
    words = _reaching(np.eye(len(center), len(center) + 1)[None], *known, TIED, TIED)
    places = words[:, :, :-1] @ start + words[:, :, -1]
    found = []
    while len(words):
        near = np.linalg.norm(places - places[0], axis=1) < SAME
        best = _reaching(words[near], *known, PRECISE, ROUNDING)
        found += (best[:, :, :-1] @ start + best[:, :, -1])[:1].tolist()
        words, places = words[~near], places[~near]
    return np.array(found).reshape(-1, len(center))


def _reaching(
    words: np.ndarray,
    maps: np.ndarray,
    center: np.ndarray,
    start: np.ndarray,
    across: np.ndarray,
    small: float,
    tied: float,
) -> np.ndarray:
    """Pieces (P, D, D + 1) of norms up to `small` that may reach as far as the furthest point known, less `tied`.

    The point of the first is the furthest. None if they are too many.
    """
    size = np.linalg.norm(words[:, :, :-1], axis=(1, 2))
    while (coarse := size > small).any():
        parts = compose(words[coarse][:, None], maps[None]).reshape(-1, *words.shape[1:])
        words = np.concatenate([words[~coarse], parts])
        # Pieces that lie on one another count once.
        _, first = np.unique(np.round(words / ROUNDING).reshape(len(words), -1), axis=0, return_index=True)
        words = words[first]
        # A bound of the norm, and a quick one.
        size = np.linalg.norm(words[:, :, :-1], axis=(1, 2))
        most = np.linalg.norm((words[:, :, :-1] @ center + words[:, :, -1]) @ across, axis=1) + size
        reached = np.linalg.norm((words[:, :, :-1] @ start + words[:, :, -1]) @ across, axis=1)
        order = np.argsort(-reached, kind="stable")
        order = order[most[order] >= reached.max() - tied]
        words, size = words[order], size[order]
        if len(words) > MOST_PIECES:
            return words[:0]
    return words


def _order(orthogonal: np.ndarray) -> list[np.ndarray]:
    """Keys by which symmetries are sorted: turns before mirrorings, by ascending angle, in space then by axis."""
    reflects = determinant(orthogonal) < 0
    if orthogonal.shape[-1] == 2:
        angle, axes = np.arctan2(orthogonal[:, 1, 0], orthogonal[:, 0, 0]), ()
    else:
        axis, angle = axis_and_angle(np.where(reflects[:, None, None], -orthogonal, orthogonal))
        axes = np.round(axis, 6).T
    # A hair below a full turn is none.
    return [reflects, np.round(np.remainder(angle + 1e-9, 2 * np.pi), 6), *axes]


def _cut(ifs: IFS, mean: np.ndarray) -> tuple[np.ndarray, float]:
    """Points (P, D) of the attractor about its mean, and how far from them the attractor reaches at most."""
    center, radius = ifs.enclosing_disc
    words = np.eye(ifs.DIMENSION, ifs.DIMENSION + 1)[None]
    sizes = np.array([1.0])
    start = ifs.fixed_points[0]
    while True:
        # The largest piece is split until there are enough.
        cut = sizes > sizes.max() * 0.7
        if len(words) + np.count_nonzero(cut) * (ifs.count - 1) > POINTS[ifs.DIMENSION]:
            break
        children = compose(words[cut][:, None], ifs.maps[None]).reshape(-1, *words.shape[1:])
        words = np.concatenate([words[~cut], children])
        sizes = np.linalg.norm(words[:, :, :-1], 2, axis=(1, 2))
        if sizes.max() < 1e-4:
            break
    reach = radius + np.linalg.norm(start - center)
    return words[:, :, :-1] @ start + words[:, :, -1] - mean, float(sizes.max() * reach)


@njit(nogil=True, cache=True)
def _furthest(points, others, enough):
    """Square of the longest distance of a point to the nearest of the others; ends above `enough`."""
    furthest = 0.0
    for i in range(points.shape[0]):
        nearest = np.inf
        for j in range(others.shape[0]):
            apart = 0.0
            for axis in range(points.shape[1]):
                apart += (points[i, axis] - others[j, axis]) ** 2
            nearest = min(nearest, apart)
        furthest = max(furthest, nearest)
        if furthest > enough:
            break
    return furthest
