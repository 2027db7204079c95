"""How far apart attractorlets are that do not meet: the gap of an attractor, in brackets."""

from __future__ import annotations

import math
from collections import namedtuple

import numpy as np

from .heap import sift_down, sift_up
from .kernels import njit
from .overlap import join
from .polygon import furthest, polygon_distance
from .tree import NORM, A, B, C, D, center, children

PRECISION = 0.05
"""Relative width of the bracket of a distance at which it is known well enough."""

PAIRS, PAIRS_A_MAP = 3000, 20
"""Pairs of pieces held at once, beside those that the search starts with; and so many more for each map."""

TIE = 1e-9
"""Weight of a pair's size in the order of the search."""

POLYGON_STEPS = 1
"""Of Gilbert's algorithm; where it leaves much to gain, the next parts gain more for less."""

Search = namedtuple("Search", "word end tried key order")
"""Work space: pairs of words (M, 2), the attractorlets that they are parts of (M, 2), whether the polygon was tried
(M,), the lower bounds (M,), and the heap of places of pairs (M,)."""


@njit(nogil=True, cache=True)
def empty_search(count):
    """Work space for N maps."""
    pairs = PAIRS + PAIRS_A_MAP * count + count * (count - 1) // 2
    return Search(
        np.empty((pairs, 2), np.int32),
        np.empty((pairs, 2), np.int32),
        np.empty(pairs, np.bool_),
        np.empty(pairs),
        np.empty(pairs, np.int64),
    )


@njit(nogil=True, cache=True)
def measure_gap(tree, follows, view, tolerance, corners, points, labels, search):
    """Bracket of the gap: the longest edge of the minimum spanning tree over the distances of components.

    Kruskal's algorithm on edges that are known by bounds only: one heap holds pairs of pieces of all pairs of
    attractorlets, the least lower bound on top; that pair is split until its distance is known, and then is an edge.
    Discs bound a pair when it enters the heap, the outer polygon when it first comes out.

    Parameters
    ----------
    tree, follows, view, tolerance, corners
        As in `pair_test`.
    points : (P, 2)
        Such that their images lie in every piece, about the centre of the disc; there may be none.
    labels : (N,)
        Components of attractorlets that are known to meet, -1 for those that do not count; written over.
    search : Search

    Returns
    -------
    low, high : float
    """
    word = tree.word
    count = follows.shape[0]
    used = length = components = np.int64(0)
    for i in range(count):
        components += labels[i] == i
        for j in range(i + 1, count):
            if labels[i] != labels[j] and min(labels[i], labels[j]) >= 0:
                search.word[used, 0], search.word[used, 1] = i, j
                search.end[used, 0], search.end[used, 1] = i, j
                length = push_pair(tree, view, search, used, length, 0.0)
                used += 1
    low = high = 0.0
    while components > 1:
        tree.used[1] += 2
        pair = search.order[0]
        length -= 1
        search.order[0] = search.order[length]
        sift_down(search.order, search.key, length)
        i, j = search.end[pair, 0], search.end[pair, 1]
        if labels[i] == labels[j]:
            continue
        large, small = search.word[pair, 0], search.word[pair, 1]
        if word[large, NORM] < word[small, NORM]:
            large, small = small, large
        large_x, large_y = center(tree, large, view)
        small_x, small_y = center(tree, small, view)
        apart_x, apart_y = small_x - large_x, small_y - large_y
        tie = TIE * view.radius * (word[large, NORM] + word[small, NORM])
        if corners.shape[0] > 0 and not search.tried[pair]:
            search.tried[pair] = True
            bound = polygon_distance(word, large, small, apart_x, apart_y, corners, np.inf, np.int64(POLYGON_STEPS))
            if bound + tie > search.key[pair]:
                search.key[pair] = bound + tie
                search.order[length] = pair
                length += 1
                sift_up(search.order, search.key, length - 1)
                continue
        bound = max(0.0, search.key[pair] - tie)
        most = math.sqrt(apart_x * apart_x + apart_y * apart_y)
        most += view.radius * (word[large, NORM] + word[small, NORM])
        if points.shape[0] > 0:
            most = min(most, points_distance(word, large, small, apart_x, apart_y, points))
        known = most - bound <= max(tolerance * view.radius, PRECISION * most)
        child = end = -1
        if not known and used + count <= search.key.shape[0]:
            child, end = children(tree, follows, large)
        if child < 0:
            join(labels, i, j)
            components -= 1
            # The order of the search is by bounds and, a little, by sizes.
            low = max(low, bound - view.slack - 2 * TIE * view.radius)
            high = max(high, most + view.slack)
            continue
        for k in range(child, end):
            # The first part takes the place of the whole.
            at = pair if k == child else used
            used += k > child
            search.word[at, 0], search.word[at, 1] = k, small
            search.end[at, 0], search.end[at, 1] = i, j
            length = push_pair(tree, view, search, at, length, bound)
    return low, high


@njit(nogil=True, cache=True)
def push_pair(tree, view, search, pair, length, at_least):
    """Put a pair of pieces into the heap, by its discs; the heap's new length.

    Among pairs that may meet the small ones come first: else all large ones would be split before any is decided.
    """
    one, other = search.word[pair, 0], search.word[pair, 1]
    one_x, one_y = center(tree, one, view)
    other_x, other_y = center(tree, other, view)
    reach = view.radius * (tree.word[one, NORM] + tree.word[other, NORM])
    apart = math.sqrt((one_x - other_x) * (one_x - other_x) + (one_y - other_y) * (one_y - other_y))
    search.key[pair] = max(apart - reach, at_least) + TIE * reach
    search.tried[pair] = False
    search.order[length] = pair
    sift_up(search.order, search.key, length)
    return length + 1


@njit(nogil=True, cache=True)
def points_distance(word, one, other, apart_x, apart_y, points):
    """Upper bound of the distance of two pieces: from one point of each, those that reach furthest to the other."""
    a, b, c, d = word[one, A], word[one, B], word[one, C], word[one, D]
    p, q, r, s = word[other, A], word[other, B], word[other, C], word[other, D]
    at_one, _ = furthest(points, a * apart_x + c * apart_y, b * apart_x + d * apart_y)
    at_other, _ = furthest(points, -p * apart_x - r * apart_y, -q * apart_x - s * apart_y)
    x = apart_x + p * points[at_other, 0] + q * points[at_other, 1] - a * points[at_one, 0] - b * points[at_one, 1]
    y = apart_y + r * points[at_other, 0] + s * points[at_other, 1] - c * points[at_one, 0] - d * points[at_one, 1]
    return math.sqrt(x * x + y * y)
