"""How far apart attractorlets are that do not meet: the gap of an attractor, in brackets."""

from __future__ import annotations

import numpy as np

from .enclosure import DIRECTIONS, outer_polygon
from .heap import sift_down, sift_up
from .kernels import njit
from .overlap import SLACK, distance, join, polygon_distance, set_child, set_piece

PRECISION = 0.05
"""The gap is measured until pieces are this small beside their distance."""

TIE = 1e-9
"""Weight of a pair's size in the order of the search."""


@njit(nogil=True, cache=True)
def measure_gap(linear, unit, tolerance, labels, first, second, ends, key, order):
    """Bracket of the gap: the longest edge of the minimum spanning tree over the distances of attractorlets.

    Kruskal's algorithm on edges that are known by bounds only: one heap holds pairs of pieces of all pairs of
    attractorlets, the least lower bound on top; that pair is split until it is small, and then is an edge. Discs
    bound a pair when it enters the heap, the outer polygon when it first comes out.

    Parameters
    ----------
    linear, unit, tolerance
        As in `pair_test`.
    labels : (N,)
        Components; written over.
    first, second, ends, key, order : (M, 7) twice, (M, 3), (M,) twice
        Work space, with room for more than all pairs of attractorlets.

    Returns
    -------
    low, high : float
        In units of the enclosing radius.
    """
    count = linear.shape[0]
    one, other = np.empty(7), np.empty(7)
    _, corners = outer_polygon(linear, unit, 1.0, DIRECTIONS, 1e-3)
    for i in range(count):
        labels[i] = i
    used = length = 0
    for i in range(count):
        for j in range(i + 1, count):
            set_piece(linear, unit, i, first[used])
            set_piece(linear, unit, j, second[used])
            ends[used, 0], ends[used, 1] = i, j
            length = push_pair(first, second, ends, key, order, used, length, 0.0)
            used += 1
    low = high = 0.0
    components = count
    while components > 1:
        pair = order[0]
        length -= 1
        order[0] = order[length]
        sift_down(order, key, length)
        i, j = ends[pair, 0], ends[pair, 1]
        if labels[i] == labels[j]:
            continue
        apart = distance(first[pair], second[pair])
        room = first[pair, 6] + second[pair, 6]
        bound = max(apart - room, 0.0)
        if ends[pair, 2] == 0:
            bound = max(bound, polygon_distance(first[pair], second[pair], corners, np.inf))
            ends[pair, 2] = 1
            if bound + TIE * room > key[pair]:
                key[pair] = bound + TIE * room
                order[length] = pair
                length += 1
                sift_up(order, key, length - 1)
                continue
        bound = max(bound, key[pair] - TIE * room)
        if room <= max(tolerance, PRECISION * apart) or used + count > first.shape[0]:
            join(labels, i, j)
            components -= 1
            low, high = max(low, bound - SLACK), max(high, apart + room)
            continue
        one[:] = first[pair]
        other[:] = second[pair]
        for k in range(count):
            # The first part takes the place of the whole.
            at = pair if k == 0 else used
            used += k > 0
            first[at], second[at] = one, other
            if one[6] >= other[6]:
                set_child(linear, unit, k, one, first[at])
            else:
                set_child(linear, unit, k, other, second[at])
            ends[at, 0], ends[at, 1] = i, j
            length = push_pair(first, second, ends, key, order, at, length, bound)
    return low, high


@njit(nogil=True, cache=True)
def push_pair(first, second, ends, key, order, pair, length, at_least):
    """Put a pair of pieces into the heap of `measure_gap`, by its discs; the heap's new length.

    Among pairs that may meet the small ones come first: else all large ones would be split before any is decided.
    """
    room = first[pair, 6] + second[pair, 6]
    key[pair] = max(distance(first[pair], second[pair]) - room, at_least) + TIE * room
    ends[pair, 2] = 0
    order[length] = pair
    sift_up(order, key, length)
    return length + 1
