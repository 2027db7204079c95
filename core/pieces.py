"""Sets of points that stand for a piece of the attractor, at any size from a fraction of a pixel to many pixels.

A picture is drawn by putting such a set under each word of a coarse cut. The set for one size is made of those for
smaller sizes, put under the words of a short cut and thinned out on a grid of cells, so that it never holds more points
than its cells need, however much the pieces overlap. Sizes are half an octave apart. All points are in the unit disc
that holds the attractor. Pieces of a recurrent IFS differ by the state after their word (`grammar`), so each has sets
of its own.

There are two ways of thinning. *Outlines* keep the points of a cell that reach furthest in four directions: they tell
best which pixels a piece touches, and they truly belong to the attractor. *Measures* keep one point a cell, at the
centre of its mass and with all of it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .grammar import Grammar, state_count
from .kernels import njit
from .words import MASS, SIZE, STATE, WORD_MASS, cut_words, grown, state_points

SIZES_PER_OCTAVE = 2

LARGEST_GRID = 512
"""Cells along each side of a piece at most; a larger piece gets larger cells."""

HULL_DIRECTIONS = 24
HULL_ROUNDS = 24
"""Of `hull_points`. The maps turn directions into others, so more are followed than are wanted; what one more round
adds shrinks as the maps do."""

INSET = 0.005
"""How far the points of the smallest outline are drawn in, as a share of its size. A piece that ends where a pixel does
then stays out of the next pixel, rather than get there by rounding."""

TIE = 1e-3
"""A point must reach this share of a cell further to replace another: rounding must not decide between the two."""


class PointSets(NamedTuple):
    """Sets of points for pieces of all sizes.

    Attributes
    ----------
    smallest : float
        Size of set 0 in pixels; with S states, set ``k S + s`` is that of state s for the size
        ``smallest * 2 ** (k / SIZES_PER_OCTAVE)``.
    states : int
        S.
    start : (K S + 1,)
        Set k has the points from start[k] to start[k + 1].
    x, y : (P,) float32
    masses : (P,)
        Of measures: those of a set add up to 1.
    """

    smallest: float
    states: int
    start: np.ndarray
    x: np.ndarray
    y: np.ndarray
    masses: np.ndarray

    def nearest(self, words: np.ndarray) -> np.ndarray:
        """Index (M,) of the set for each of `words` (M, 10) in pixels."""
        return nearest_sets(words, 1.0, self.smallest, (len(self.start) - 1) // self.states, self.states)


def outlines(
    maps: np.ndarray, norms: np.ndarray, grammar: Grammar, cell: float, smallest: float, largest: float, ratio: float
) -> PointSets:
    """Sets of points of the attractor that tell which pixels a piece touches.

    Parameters
    ----------
    maps, norms, grammar
        As `words.cut_words` takes them.
    cell : float
        Side of a cell, in pixels.
    smallest, largest : float
        Sizes of the first set and, about, of the last, in pixels.
    ratio : float
        Each set is made of ones that are smaller by this ratio at least; the square root of 2 or more.
    """
    hull = hull_points(maps, grammar, state_points(maps, grammar, grammar.allowed.argmax(axis=1)))
    hull += INSET * (hull.mean(axis=1, keepdims=True) - hull)
    return _sets(maps, norms, grammar, cell, smallest, largest, ratio, hull, False)


def measures(
    maps: np.ndarray, norms: np.ndarray, grammar: Grammar, cell: float, smallest: float, largest: float, ratio: float
) -> PointSets:
    """Sets of points with masses that stand for the measure that a grammar gives; otherwise as `outlines`."""
    centers = mean_points(maps, grammar)
    seeds = np.concatenate([centers, np.ones((len(centers), 1))], axis=1)[:, None]
    return _sets(maps, norms, grammar, cell, smallest, largest, ratio, seeds, True)


def mean_points(maps: np.ndarray, grammar: Grammar) -> np.ndarray:
    """Centre of mass (S, 2) of what may come after each state.

    It is the mean of those of its parts: ``m_s = sum of p_si w_i(m_t)``, t being the state after i.
    """
    states = state_count(grammar)
    system, right = np.eye(2 * states), np.empty(2 * states)
    for s in range(states):
        rows = slice(2 * s, 2 * s + 2)
        shares = grammar.shares[s]
        for t in range(states):
            mean = (shares * (grammar.state == t) @ maps).reshape(2, 3)
            system[rows, 2 * t : 2 * t + 2] -= mean[:, :2]
        right[rows] = (shares @ maps)[[2, 5]]
    return np.linalg.solve(system, right).reshape(-1, 2)


def _sets(maps, norms, grammar, cell, smallest, largest, ratio, seeds, measure) -> PointSets:
    count = max(round(SIZES_PER_OCTAVE * math.log2(largest / smallest)), 0) + 1
    start, points = fill_sets(maps, norms, grammar, cell, smallest, count, ratio, seeds, measure)
    x, y = (np.ascontiguousarray(points[:, k], dtype=np.float32) for k in (0, 1))
    return PointSets(smallest, state_count(grammar), start, x, y, points[:, 2])


@njit(nogil=True, cache=True)
def nearest_sets(words, scale, smallest, count, states):
    """Index (M,) of the set of each word's state that is nearest by ratio, among `count`, to its size times `scale`."""
    nearest = np.zeros(words.shape[0], np.int64)
    for w in range(words.shape[0]):
        size = scale * words[w, SIZE]
        if size > smallest:
            nearest[w] = min(int(SIZES_PER_OCTAVE * math.log2(size / smallest) + 0.5), count - 1)
        nearest[w] = nearest[w] * states + int(words[w, STATE])
    return nearest


@njit(nogil=True, cache=True)
def hull_points(maps, grammar, seeds):
    """Points of what may come after each state that nearly reach furthest in eight directions.

    The images of the furthest points of the attractor hold its furthest points. So start with one point of it for
    each of `HULL_DIRECTIONS`, and replace each by the furthest image of any, again and again.

    Parameters
    ----------
    maps : (N, 6)
    grammar : Grammar
    seeds : (S, 2)
        A point for each state, such as a map's fixed point.

    Returns
    -------
    (S, 8, 3)
        x, y and a mass of one eighth.
    """
    # Columns: the point, the direction, and how far the point reaches in it.
    states = seeds.shape[0]
    points, previous = np.empty((states, HULL_DIRECTIONS, 5)), np.empty((states, HULL_DIRECTIONS, 2))
    for s in range(states):
        for k in range(HULL_DIRECTIONS):
            angle = 2 * math.pi * k / HULL_DIRECTIONS
            points[s, k, 0], points[s, k, 1] = seeds[s, 0], seeds[s, 1]
            points[s, k, 2], points[s, k, 3] = math.cos(angle), math.sin(angle)
            points[s, k, 4] = points[s, k, 0] * points[s, k, 2] + points[s, k, 1] * points[s, k, 3]
    for _ in range(HULL_ROUNDS):
        for s in range(states):
            for k in range(HULL_DIRECTIONS):
                previous[s, k, 0], previous[s, k, 1] = points[s, k, 0], points[s, k, 1]
        for s in range(states):
            for i in range(maps.shape[0]):
                if grammar.allowed[s, i]:
                    reach_further(points[s], previous[grammar.state[i]], maps[i])
    kept = np.empty((states, 8, 3))
    for s in range(states):
        for k in range(8):
            kept[s, k, 0] = points[s, k * HULL_DIRECTIONS // 8, 0]
            kept[s, k, 1] = points[s, k * HULL_DIRECTIONS // 8, 1]
            kept[s, k, 2] = 1 / 8
    return kept


@njit(nogil=True, cache=True)
def reach_further(points, previous, entries):
    """Replace points (D, 5) of `hull_points` by the images of previous ones (D, 2) that reach further."""
    for j in range(previous.shape[0]):
        x = entries[0] * previous[j, 0] + entries[1] * previous[j, 1] + entries[2]
        y = entries[3] * previous[j, 0] + entries[4] * previous[j, 1] + entries[5]
        for k in range(points.shape[0]):
            reach = points[k, 2] * x + points[k, 3] * y
            if reach > points[k, 4] + TIE:
                points[k, 0], points[k, 1], points[k, 4] = x, y, reach


@njit(nogil=True, cache=True)
def fill_sets(maps, norms, grammar, cell, smallest, count, ratio, seeds, measure):
    """`PointSets.start`, and a table (P, 3) of x, y and mass, made from the sets of size 0, `seeds`, upwards."""
    identity = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
    everywhere = np.array([-np.inf, -np.inf, np.inf, np.inf])
    states, each = seeds.shape[0], seeds.shape[1]
    start = np.zeros(count * states + 1, np.int64)
    points = np.empty((max(states * each, 4096), 3))
    for s in range(states):
        start[s + 1] = start[s] + each
        points[start[s] : start[s + 1]] = seeds[s]
    for k in range(1, count):
        size = smallest * 2 ** (k / SIZES_PER_OCTAVE)
        limit = max(2 / ratio, 2 * smallest / size)
        sides = min(max(math.ceil(size / cell), 1), LARGEST_GRID)
        for s in range(states):
            n = k * states + s
            words = cut_words(identity, maps, norms, 2.0, limit, grammar, s, everywhere, np.iinfo(np.int64).max)
            room = start[n] + sides * sides * (1 if measure else 4)
            if room > points.shape[0]:
                points = grown(points, 2 * room)
            kinds = nearest_sets(words, size / 2, smallest, k, states)
            if measure:
                start[n + 1] = _thin_measure(words, kinds, start, points, start[n], sides)
            else:
                start[n + 1] = _thin_outline(words, kinds, start, points, start[n], sides)
    return start, points[: start[count * states]]


@njit(nogil=True, cache=True)
def _thin_measure(words, kinds, start, points, end, sides):
    """Append one point for each cell: the centre of mass of what falls into it. Returns the new end of `points`."""
    member = np.zeros(sides * sides, np.int64)  # Zero for none: the first point of all is in set 0.
    for w in range(words.shape[0]):
        a, b, e, c, d, f = words[w, 0], words[w, 1], words[w, 2], words[w, 3], words[w, 4], words[w, 5]
        share = words[w, MASS] / WORD_MASS
        for j in range(start[kinds[w]], start[kinds[w] + 1]):
            x, y = a * points[j, 0] + b * points[j, 1] + e, c * points[j, 0] + d * points[j, 1] + f
            mass = share * points[j, 2]
            cell = _cell(x, y, sides)
            if member[cell] == 0:
                member[cell] = end
                points[end, 0], points[end, 1], points[end, 2] = x, y, mass
                end += 1
            elif mass > 0:
                m = member[cell]
                points[m, 2] += mass
                points[m, 0] += (x - points[m, 0]) * mass / points[m, 2]
                points[m, 1] += (y - points[m, 1]) * mass / points[m, 2]
    return end


@njit(nogil=True, cache=True)
def _thin_outline(words, kinds, start, points, end, sides):
    """Append up to four points for each cell, those furthest left, right, down and up. Returns the new end.

    A cell that is surrounded by others gets the first only: there, a point a cell is as good as four.
    """
    count = sides * sides
    furthest = np.empty((count, 4), np.float32)
    spots = np.empty((count, 4, 2), np.float32)
    tie = TIE * 2 / sides
    for cell in range(count):
        for k in range(4):
            furthest[cell, k] = -np.inf
    for w in range(words.shape[0]):
        a, b, e, c, d, f = words[w, 0], words[w, 1], words[w, 2], words[w, 3], words[w, 4], words[w, 5]
        for j in range(start[kinds[w]], start[kinds[w] + 1]):
            x, y = a * points[j, 0] + b * points[j, 1] + e, c * points[j, 0] + d * points[j, 1] + f
            cell = _cell(x, y, sides)
            for k in range(4):
                reach = (-x, x, -y, y)[k]
                if reach > furthest[cell, k] + tie:
                    furthest[cell, k] = reach
                    spots[cell, k, 0], spots[cell, k, 1] = x, y
    for cell in range(count):
        if furthest[cell, 0] == -np.inf:
            continue
        for k in range(1 if _surrounded(furthest, cell, sides) else 4):
            x, y = spots[cell, k, 0], spots[cell, k, 1]
            known = False
            for m in range(k):
                known |= x == spots[cell, m, 0] and y == spots[cell, m, 1]
            if not known:
                points[end, 0], points[end, 1], points[end, 2] = x, y, 0.0
                end += 1
    return end


@njit(nogil=True, cache=True)
def _surrounded(furthest, cell, sides):
    """Whether the eight cells about one all have points."""
    row, column = cell // sides, cell % sides
    if row == 0 or row == sides - 1 or column == 0 or column == sides - 1:
        return False
    for down in range(-1, 2):
        for left in range(-1, 2):
            if furthest[cell + down * sides + left, 0] == -np.inf:
                return False
    return True


@njit(nogil=True, cache=True)
def _cell(x, y, sides):
    """Index of the cell of the square about the unit disc that holds a point."""
    column = min(max(int((x + 1) / 2 * sides), 0), sides - 1)
    row = min(max(int((y + 1) / 2 * sides), 0), sides - 1)
    return row * sides + column
