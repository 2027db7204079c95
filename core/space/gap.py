"""How far apart attractorlets in space are that do not meet: the gap of an attractor, in brackets (see `core.gap`)."""

from __future__ import annotations

import math
from collections import namedtuple

import numpy as np

from ..gap import PRECISION, TIE
from ..heap import sift_down, sift_up
from ..kernels import njit
from ..overlap import join
from .tree import NORM, center, first_child

PAIRS = 20_000
"""Pairs of pieces held at once, beside those that the search starts with."""

Search = namedtuple("Search", "word end key order")
"""Work space: pairs of words (M, 2), the attractorlets that they are parts of (M, 2), the lower bounds (M,), and the
heap of places of pairs (M,)."""


@njit(nogil=True, cache=True)
def empty_search(count):
    """Work space for N maps."""
    pairs = PAIRS + count * (count - 1) // 2
    return Search(
        np.empty((pairs, 2), np.int32), np.empty((pairs, 2), np.int32), np.empty(pairs), np.empty(pairs, np.int64)
    )


@njit(nogil=True, cache=True)
def measure_gap(tree, view, tolerance, points, labels, search):
    """Bracket of the gap: the longest edge of the minimum spanning tree over the distances of components.

    Kruskal's algorithm on edges that are known by bounds only, as `core.gap.measure_gap`, by balls.

    Parameters
    ----------
    tree, view, tolerance
        As in `pair_test`.
    points : (P, 3)
        On the attractor, about the centre of the ball.
    labels : (N,)
        Components of attractorlets that are known to meet, -1 for those that do not count; written over.
    search : Search

    Returns
    -------
    low, high : float
    """
    word = tree.word
    count = labels.shape[0]
    used = length = components = 0
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
        tree.used[1] += 1
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
        reach = view.radius * (word[large, NORM] + word[small, NORM])
        bound = max(0.0, search.key[pair] - TIE * reach)
        most = points_distance(tree, view, large, small, points)
        known = most - bound <= max(tolerance * view.radius, PRECISION * most)
        child = -1
        if not known and used + count <= search.key.shape[0]:
            child = first_child(tree, count, large)
        if child < 0:
            join(labels, i, j)
            components -= 1
            # The order of the search is by bounds and, a little, by sizes.
            low = max(low, bound - view.slack - 2 * TIE * view.radius)
            high = max(high, most + view.slack)
            continue
        for k in range(child, child + count):
            # The first part takes the place of the whole.
            at = pair if k == child else used
            used += k > child
            search.word[at, 0], search.word[at, 1] = k, small
            search.end[at, 0], search.end[at, 1] = i, j
            length = push_pair(tree, view, search, at, length, bound)
    return low, high


@njit(nogil=True, cache=True)
def push_pair(tree, view, search, pair, length, at_least):
    """Put a pair of pieces into the heap, by its balls; the heap's new length.

    Among pairs that may meet the small ones come first: else all large ones would be split before any is decided.
    """
    one, other = search.word[pair, 0], search.word[pair, 1]
    x, y, z = center(tree, one, view)
    p, q, r = center(tree, other, view)
    reach = view.radius * (tree.word[one, NORM] + tree.word[other, NORM])
    apart = math.sqrt((x - p) * (x - p) + (y - q) * (y - q) + (z - r) * (z - r))
    search.key[pair] = max(apart - reach, at_least) + TIE * reach
    search.order[length] = pair
    sift_up(search.order, search.key, length)
    return length + 1


@njit(nogil=True, cache=True)
def points_distance(tree, view, one, other, points):
    """Upper bound of the distance of two pieces: from one point of each, those that reach furthest to the other."""
    x, y, z = center(tree, one, view)
    p, q, r = center(tree, other, view)
    ax, ay, az = p - x, q - y, r - z
    one_x, one_y, one_z = furthest(tree.word[one], points, ax, ay, az)
    other_x, other_y, other_z = furthest(tree.word[other], points, -ax, -ay, -az)
    ax, ay, az = ax + other_x - one_x, ay + other_y - one_y, az + other_z - one_z
    return math.sqrt(ax * ax + ay * ay + az * az)


@njit(nogil=True, cache=True)
def furthest(w, points, ax, ay, az):
    """The image, about its centre, of that of some points (P, 3) that a word (16,) takes furthest in a direction."""
    best, best_x, best_y, best_z = -np.inf, 0.0, 0.0, 0.0
    for k in range(points.shape[0]):
        x = w[0] * points[k, 0] + w[1] * points[k, 1] + w[2] * points[k, 2]
        y = w[3] * points[k, 0] + w[4] * points[k, 1] + w[5] * points[k, 2]
        z = w[6] * points[k, 0] + w[7] * points[k, 1] + w[8] * points[k, 2]
        reach = x * ax + y * ay + z * az
        if reach > best:
            best, best_x, best_y, best_z = reach, x, y, z
    return best_x, best_y, best_z
