"""Words: compositions of maps, cut where the piece of the attractor that they stand for is small.

The *word* ``w_i w_j w_k ...`` stands for the *piece* ``w_i(w_j(w_k(...(A))))`` of the attractor A. A *cut* is a set of
words of which every infinite word starts with exactly one, so that their pieces make up all of A.

Kernels take maps as rows ``a, b, e, c, d, f``, in coordinates in which the unit disc holds the attractor. The image of
that disc then bounds a word's piece, and its largest diameter is the word's size.
"""

from __future__ import annotations

import math

import numpy as np

from .enclosure import norm
from .ifs import IFS
from .kernels import njit

SIZE, MASS, LETTER = 6, 7, 8
"""Columns of a table of words, after the six of the map."""

WORD_MASS = 2.0**40
"""Mass of the empty word in a cut; the words of a cut have whole numbers of units that add up to it."""

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
"""The empty word."""

EVERYWHERE = np.array([-np.inf, -np.inf, np.inf, np.inf])
"""A window that shows all words."""

DIMENSION_SIZE = 0.5
DIMENSION_BUDGET = 20_000
"""How small, relative to the attractor, and how many are the words that the dimension is estimated from."""

DIMENSION_PRECISION = 1e-3


def unit_maps(ifs: IFS, least_radius: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Maps of an IFS in coordinates in which the unit disc holds its attractor.

    Parameters
    ----------
    ifs : IFS
        Must have an attractor.
    least_radius : float
        Radius of the disc at least, since an attractor can be a single point.

    Returns
    -------
    maps : (N, 6)
    center : (2,)
        Of the disc, in the coordinates of `ifs`.
    radius : float
    """
    center, radius = ifs.enclosing_disc
    radius = max(radius, least_radius)
    shift = (ifs.translation + ifs.linear @ center - center) / radius
    return np.concatenate([ifs.linear, shift[..., None]], axis=-1).reshape(-1, 6), center, radius


def fixed_point(entries: np.ndarray) -> np.ndarray:
    """The point (2,) that a map (6,) leaves where it is; of a map of an IFS it belongs to the attractor."""
    a, b, e, c, d, f = entries
    return np.linalg.solve([[1 - a, -b], [-c, 1 - d]], [e, f])


def cumulated(weights: np.ndarray) -> np.ndarray:
    """Borders (N + 1,) of the parts, 0 to 1, that the maps have in an address."""
    borders = np.concatenate([[0.0], np.minimum(np.cumsum(weights / weights.sum()), 1.0)])
    borders[np.flatnonzero(weights)[-1] + 1 :] = 1.0
    return borders


@njit(nogil=True, cache=True)
def cut_words(root, maps, norms, extent, limit, borders, window, budget):
    """Cut words where their size is at most `limit`, leaving out those that the window does not show.

    Parameters
    ----------
    root : (6,)
        Map that is applied after every word, such as the one to pixels.
    maps : (N, 6)
    norms : (N,) or (0,)
        Upper bounds of the norms of the maps, below 1. The size of a word is then `extent` times their product,
        whatever the maps themselves are. Without norms it is measured, as the largest diameter of the disc's image.
    extent : float
        Size of the empty word, where there are norms.
    limit : float
        Every word of the cut has at least one letter, however large the limit.
    borders : (N + 1,)
        Parts of the maps in a word's mass, see `cumulated`.
    window : (4,)
        Least x and y, largest x and y.
    budget : int
        Give up when there are more words than this.

    Returns
    -------
    words : (M, 9)
        In the order of their letters: the map, and in the columns SIZE, MASS and LETTER the size, the mass and the
        first letter. The masses are whole and add up to `WORD_MASS` where the window shows all words. One row more
        than `budget` if the cut was given up.
    """
    count = maps.shape[0]
    words, found = np.empty((256, 9)), 0
    stack, top = np.empty((64 + count, 9)), 1
    for k in range(6):
        stack[0, k] = root[k]
    stack[0, SIZE], stack[0, MASS], stack[0, LETTER] = extent, WORD_MASS, -1
    while top > 0 and found <= budget:
        top -= 1
        a, b, e = stack[top, 0], stack[top, 1], stack[top, 2]
        c, d, f = stack[top, 3], stack[top, 4], stack[top, 5]
        size, mass, letter = stack[top, SIZE], stack[top, MASS], stack[top, LETTER]
        # The image of the unit disc reaches hypot(a, b) to either side of (e, f), and hypot(c, d) up and down.
        across, along = math.sqrt(a * a + b * b), math.sqrt(c * c + d * d)
        if e + across < window[0] or f + along < window[1] or e - across > window[2] or f - along > window[3]:
            continue
        if norms.shape[0] == 0:
            size = 2 * norm(a, b, c, d)
        if size <= limit and letter >= 0:
            if found == words.shape[0]:
                words = grown(words, 2 * found)
            for k in range(9):
                words[found, k] = stack[top, k]
            words[found, SIZE] = size
            found += 1
            continue
        if top + count > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + count)
        for i in range(count - 1, -1, -1):
            p, q, r, s, t, u = maps[i, 0], maps[i, 1], maps[i, 2], maps[i, 3], maps[i, 4], maps[i, 5]
            stack[top, 0], stack[top, 1], stack[top, 2] = a * p + b * s, a * q + b * t, a * r + b * u + e
            stack[top, 3], stack[top, 4], stack[top, 5] = c * p + d * s, c * q + d * t, c * r + d * u + f
            stack[top, SIZE] = size * norms[i] if norms.shape[0] > 0 else 0.0
            stack[top, MASS] = math.floor(mass * borders[i + 1]) - math.floor(mass * borders[i])
            stack[top, LETTER] = letter if letter >= 0 else i
            top += 1
    return words[:found]


@njit(nogil=True, cache=True)
def grown(table, length):
    """A copy of a table with room for `length` rows."""
    longer = np.empty((length, table.shape[1]))
    for row in range(table.shape[0]):
        for column in range(table.shape[1]):
            longer[row, column] = table[row, column]
    return longer


def dimension(large: np.ndarray, small: np.ndarray) -> float:
    """Dimension of an attractor whose parts have these singular values (M,), relative to all of it (Falconer 1988).

    It is the d, up to 2, with ``sum(large * small ** (d - 1)) = 1``, or below 1 with ``sum(large ** d) = 1``. For
    similarities that is ``sum(ratio ** d) = 1`` (Moran 1946): there are 2 ** d times as many parts of half the size,
    which may be more than the plane has room for; the equation is used for any d where `large` is `small`.
    """
    low, high = 0.0, 1.0
    while high < 1000 and _total(large, small, high) > 1:
        low, high = high, 2 * high
    while high - low > DIMENSION_PRECISION * max(high, 1.0):
        middle = (low + high) / 2
        low, high = (middle, high) if _total(large, small, middle) > 1 else (low, middle)
    return high


def _total(large: np.ndarray, small: np.ndarray, d: float) -> float:
    return float((large ** min(d, 1.0) * small ** max(d - 1.0, 0.0)).sum())


def cut_dimensions(maps: np.ndarray, norms: np.ndarray) -> tuple[float, float]:
    """Exponents by which words multiply in a cut as it gets finer, and by which the attractor fills the plane.

    Both are `dimension`; the first is that of parts as wide as they are long. They are infinite where half the size of
    the attractor already takes more than `DIMENSION_BUDGET` words.
    """
    if len(norms):
        growth = dimension(norms, norms)
        return growth, growth
    words = cut_words(
        IDENTITY, maps, norms, 2.0, 2 * DIMENSION_SIZE, np.zeros(len(maps) + 1), EVERYWHERE, DIMENSION_BUDGET
    )
    if len(words) > DIMENSION_BUDGET:
        return np.inf, np.inf
    large = words[:, SIZE] / 2
    area = np.abs(words[:, 0] * words[:, 4] - words[:, 1] * words[:, 3])
    small = np.divide(area, large, out=np.zeros_like(area), where=large > 0)
    growth = dimension(large, large)
    similar = (small >= (1 - DIMENSION_PRECISION) * large).all()
    return growth, growth if similar else dimension(large, small)
