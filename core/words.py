"""Words: compositions of maps, cut where the piece of the attractor that they stand for is small.

The *word* ``w_i w_j w_k ...`` stands for the *piece* ``w_i(w_j(w_k(...(A))))`` of the attractor A. A *cut* is a set of
words of which every infinite word starts with exactly one, so that their pieces make up all of A.

Kernels take maps as rows ``a, b, e, c, d, f``, in coordinates in which the unit disc holds the attractor. The image of
that disc then bounds a word's piece, and its largest diameter is the word's size.
"""

from __future__ import annotations

import math

import numpy as np

from .affine import compose, transform
from .enclosure import norm
from .grammar import Grammar, state_count
from .ifs import IFS
from .kernels import njit

SIZE, MASS, LETTER, STATE = 6, 7, 8, 9
"""Columns of a table of words, after the six of the map."""

WORD_MASS = 2.0**40
"""Mass of the empty word in a cut; the words of a cut have whole numbers of units that add up to it."""

FEW = 256
"""Points that a word and a small cloud have at most (see `cloud`)."""

INVISIBLE = 1e-9
"""A word of this size relative to the attractor is a point, however many addresses start with it."""

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


def state_points(maps: np.ndarray, grammar: Grammar, choice: np.ndarray) -> np.ndarray:
    """A point (S, 2) of what may come after each state, such as a map's fixed point.

    Parameters
    ----------
    maps : (N, 6)
    grammar : Grammar
    choice : (S,)
        An allowed letter for each state: the point's address takes it whenever it comes to that state.
    """
    points = np.empty((state_count(grammar), 2))
    for state in range(len(points)):
        letters, visits, at = [], {}, state
        while at not in visits:
            visits[at] = len(letters)
            letters.append(choice[at])
            at = grammar.state[letters[-1]]
        again = visits[at]
        around = maps[letters[again]].reshape(2, 3)
        for letter in letters[again + 1 :]:
            around = compose(around, maps[letter].reshape(2, 3))
        point = fixed_point(around.ravel())
        for letter in reversed(letters[:again]):
            point = transform(maps[letter].reshape(2, 3), point)
        points[state] = point
    return points


def origins(maps: np.ndarray, grammar: Grammar) -> np.ndarray:
    """Points of the attractor to start from: one (1, 2) of a plain IFS, else one (N, 2) of each attractorlet."""
    if len(grammar.allowed) == 1:
        return fixed_point(maps[0])[None]
    points = state_points(maps, grammar, grammar.allowed.argmax(axis=1))[grammar.state]
    return transform(maps.reshape(-1, 2, 3), points)


@njit(nogil=True, cache=True)
def cut_words(root, maps, norms, extent, limit, grammar, state, window, budget):
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
    grammar : Grammar
        Which letters may come next, and what parts of a word's mass they take.
    state : int
        Row of the grammar for the empty word: the last, or another state whose part of the attractor is wanted.
    window : (4,)
        Least x and y, largest x and y.
    budget : int
        Give up when there are more words than this.

    Returns
    -------
    words : (M, 10)
        In the order of their letters: the map, and in the columns SIZE, MASS, LETTER and STATE the size, the mass, the
        first letter and the state after the last. The masses are whole and add up to `WORD_MASS` where the window
        shows all words. One row more than `budget` if the cut was given up.
    """
    count = maps.shape[0]
    words, found = np.empty((256, 10)), 0
    stack, top = np.empty((64 + count, 10)), 1
    for k in range(6):
        stack[0, k] = root[k]
    stack[0, SIZE], stack[0, MASS], stack[0, LETTER] = extent, WORD_MASS, -1
    stack[0, STATE] = state
    while top > 0 and found <= budget:
        top -= 1
        a, b, e = stack[top, 0], stack[top, 1], stack[top, 2]
        c, d, f = stack[top, 3], stack[top, 4], stack[top, 5]
        size, mass, letter = stack[top, SIZE], stack[top, MASS], stack[top, LETTER]
        row = int(stack[top, STATE])
        # The image of the unit disc reaches hypot(a, b) to either side of (e, f), and hypot(c, d) up and down.
        across, along = math.sqrt(a * a + b * b), math.sqrt(c * c + d * d)
        if e + across < window[0] or f + along < window[1] or e - across > window[2] or f - along > window[3]:
            continue
        if norms.shape[0] == 0:
            size = 2 * norm(a, b, c, d)
        if size <= limit and letter >= 0:
            if found == words.shape[0]:
                words = grown(words, 2 * found)
            for k in range(10):
                words[found, k] = stack[top, k]
            words[found, SIZE] = size
            found += 1
            continue
        if top + count > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + count)
        allowed, borders = grammar.allowed[row], grammar.borders[row]
        for i in range(count - 1, -1, -1):
            if not allowed[i]:
                continue
            p, q, r, s, t, u = maps[i, 0], maps[i, 1], maps[i, 2], maps[i, 3], maps[i, 4], maps[i, 5]
            stack[top, 0], stack[top, 1], stack[top, 2] = a * p + b * s, a * q + b * t, a * r + b * u + e
            stack[top, 3], stack[top, 4], stack[top, 5] = c * p + d * s, c * q + d * t, c * r + d * u + f
            stack[top, SIZE] = size * norms[i] if norms.shape[0] > 0 else 0.0
            stack[top, MASS] = math.floor(mass * borders[i + 1]) - math.floor(mass * borders[i])
            stack[top, LETTER] = letter if letter >= 0 else i
            stack[top, STATE] = grammar.state[i]
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


def dimension(parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> float:
    """Dimension of an attractor by the singular values of its parts, relative to all of it (Falconer 1988).

    It is the d, up to 2, with ``sum(large * small ** (d - 1)) = 1``, or below 1 with ``sum(large ** d) = 1``. For
    similarities that is ``sum(ratio ** d) = 1`` (Moran 1946): there are 2 ** d times as many parts of half the size,
    which may be more than the plane has room for; the equation is used for any d where `large` is `small`. Where there
    are several states, the spectral radius of the sums from state to state takes the place of the sum (Mauldin &
    Williams 1988).

    Parameters
    ----------
    parts : list of (large (M,), small (M,), state (M,))
        For each state, what its part of the attractor is made of.
    """
    low, high = 0.0, 1.0
    while high < 1000 and _total(parts, high) > 1:
        low, high = high, 2 * high
    while high - low > DIMENSION_PRECISION * max(high, 1.0):
        middle = (low + high) / 2
        low, high = (middle, high) if _total(parts, middle) > 1 else (low, middle)
    return high


def _total(parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]], d: float) -> float:
    if len(parts) == 1:
        large, small, _ = parts[0]
        return float((large ** min(d, 1.0) * small ** max(d - 1.0, 0.0)).sum())
    sums = [
        np.bincount(state, large ** min(d, 1.0) * small ** max(d - 1.0, 0.0), len(parts))
        for large, small, state in parts
    ]
    return float(np.abs(np.linalg.eigvals(sums)).max())


def cut_dimensions(maps: np.ndarray, norms: np.ndarray, grammar: Grammar) -> tuple[float, float]:
    """Exponents by which words multiply in a cut as it gets finer, and by which the attractor fills the plane.

    Both are `dimension`; the first is that of parts as wide as they are long. They are infinite where half the size of
    the attractor already takes more than `DIMENSION_BUDGET` words.
    """
    states = range(state_count(grammar))
    if len(norms):
        parts = [(norms[allowed], grammar.state[allowed]) for allowed in grammar.allowed[: len(states)]]
        growth = dimension([(large, large, state) for large, state in parts])
        return growth, growth
    parts, similar = [], True
    for state in states:
        words = cut_words(IDENTITY, maps, norms, 2.0, 2 * DIMENSION_SIZE, grammar, state, EVERYWHERE, DIMENSION_BUDGET)
        if len(words) > DIMENSION_BUDGET:
            return np.inf, np.inf
        large = words[:, SIZE] / 2
        area = np.abs(words[:, 0] * words[:, 4] - words[:, 1] * words[:, 3])
        small = np.divide(area, large, out=np.zeros_like(area), where=large > 0)
        similar &= bool((small >= (1 - DIMENSION_PRECISION) * large).all())
        parts.append((large, small, words[:, STATE].astype(np.int64)))
    growth = dimension([(large, large, state) for large, _, state in parts])
    return growth, growth if similar else dimension(parts)
