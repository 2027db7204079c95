"""Kernels that decide, with certainty, which attractorlets meet, and how far apart those are that do not.

Maps are given so that the unit disc about the origin holds the attractor (`normalize`). A *piece* is the image of the
attractor under a word, held as a row (a, b, c, d, e, f, s): it lies in the disc of radius s, the word's norm, about
(e, f). Distances are in units of the enclosing radius.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from . import enclosure
from .enclosure import enclosing_disc, norm, outer_polygon, shrinking_words

CONNECTED, DISCONNECTED, UNDECIDED, NO_ATTRACTOR = 0, 1, 2, 3
"""States of an attractor, the values of `connectedness.Connectedness`."""

MEET, APART, UNKNOWN = 0, 1, 2
"""Outcomes of a pair test."""

SLACK = 1e-12
"""Rounding allowed in a distance, so that pieces are called apart only when they are."""

POINT = 1e-12
"""An attractor this small beside its distance from the origin is one point: what is left is rounding."""

DISC_BUDGET = 256
POLYGON_BUDGET = 4000
"""Pairs of pieces looked at in the first stage, which knows discs only, and in the second."""

STACK = 4096
GAP_PAIRS = 6000
"""Pairs of pieces held at once by the pair test, and by the gap search beside those it starts with."""

GAP_PRECISION = 0.05
"""The gap is measured until pieces are this small beside their distance."""

TIE = 1e-9
"""Weight of a pair's size in the order of the gap search."""

POLYGON_STEPS = 4


@njit(nogil=True, cache=True)
def normalize(linear, translation, x, y, radius, unit):
    """Write into `unit` (N, 2) the translations that put the disc (x, y, radius) at the origin, with radius 1."""
    for i in range(linear.shape[0]):
        e, f = translation[i, 0], translation[i, 1]
        unit[i, 0] = (linear[i, 0] * x + linear[i, 1] * y + e - x) / radius
        unit[i, 1] = (linear[i, 2] * x + linear[i, 3] * y + f - y) / radius


@njit(nogil=True, cache=True)
def set_piece(linear, unit, i, piece):
    """Attractorlet i as a piece."""
    piece[:4] = linear[i]
    piece[4:6] = unit[i]
    piece[6] = norm(linear[i, 0], linear[i, 1], linear[i, 2], linear[i, 3])


@njit(nogil=True, cache=True)
def set_child(linear, unit, k, parent, child):
    """Part k of a piece: its word with the letter k behind it."""
    a, b, c, d = parent[0], parent[1], parent[2], parent[3]
    p, q, r, s = linear[k, 0], linear[k, 1], linear[k, 2], linear[k, 3]
    child[0], child[1] = a * p + b * r, a * q + b * s
    child[2], child[3] = c * p + d * r, c * q + d * s
    child[4] = a * unit[k, 0] + b * unit[k, 1] + parent[4]
    child[5] = c * unit[k, 0] + d * unit[k, 1] + parent[5]
    child[6] = norm(child[0], child[1], child[2], child[3])


@njit(nogil=True, cache=True)
def distance(one, other):
    """Between the centres of the discs of two pieces."""
    dx, dy = one[4] - other[4], one[5] - other[5]
    return math.sqrt(dx * dx + dy * dy)


@njit(nogil=True, cache=True)
def polygon_distance(one, other, corners, enough):
    """Lower bound of the distance of the images of the outer polygon: a few steps of Gilbert's algorithm (1966).

    The point (x, y) of the difference of the two polygons walks towards the origin; the line across its direction
    through the furthest corner parts the origin from all of the difference, or does not. Stops at a bound above
    `enough`; negative where the polygons may meet.
    """
    x, y = other[4] - one[4], other[5] - one[5]
    bound = -np.inf
    for _ in range(POLYGON_STEPS):
        length = math.sqrt(x * x + y * y)
        if length <= SLACK:
            return bound
        p, q = one[0] * x + one[2] * y, one[1] * x + one[3] * y
        r, s = other[0] * x + other[2] * y, other[1] * x + other[3] * y
        furthest, nearest, at_one, at_other = -np.inf, np.inf, 0, 0
        for k in range(corners.shape[0]):
            value = p * corners[k, 0] + q * corners[k, 1]
            if value > furthest:
                furthest, at_one = value, k
            value = r * corners[k, 0] + s * corners[k, 1]
            if value < nearest:
                nearest, at_other = value, k
        separation = nearest - furthest + x * (other[4] - one[4]) + y * (other[5] - one[5])
        bound = max(bound, separation / length)
        if bound > enough:
            return bound
        u, v = corners[at_one, 0], corners[at_one, 1]
        g, h = corners[at_other, 0], corners[at_other, 1]
        corner_x = other[0] * g + other[1] * h + other[4] - one[0] * u - one[1] * v - one[4]
        corner_y = other[2] * g + other[3] * h + other[5] - one[2] * u - one[3] * v - one[5]
        # Nearest point to the origin on the segment from (x, y) to the corner.
        dx, dy = corner_x - x, corner_y - y
        squared = dx * dx + dy * dy
        if squared <= SLACK * SLACK:
            return bound
        along = -(x * dx + y * dy) / squared
        if along <= 0:
            return bound
        along = min(along, 1.0)
        x, y = x + along * dx, y + along * dy
    return bound


@njit(nogil=True, cache=True)
def pair_test(linear, unit, i, j, tolerance, corners, budget, first, second, key):
    """Whether attractorlets i and j meet.

    Splits the larger of two pieces into its parts, nearest first, drops pairs that are certainly apart, and stops at a
    pair so small that it meets at the tolerance.

    Parameters
    ----------
    linear, unit : (N, 4), (N, 2)
        Normalized maps.
    tolerance : float
        Two pieces that may meet, with radii of this sum, are taken to meet.
    corners : (K, 2)
        Of the outer polygon; with K = 0 only discs are tried.
    budget : int
        Pairs looked at before giving up.
    first, second, key : (STACK, 7) twice, (STACK,)
        Work space.

    Returns
    -------
    int
        MEET, APART or UNKNOWN.
    """
    count = linear.shape[0]
    one, other, child = np.empty(7), np.empty(7), np.empty(7)
    set_piece(linear, unit, i, first[0])
    set_piece(linear, unit, j, second[0])
    if distance(first[0], second[0]) > first[0, 6] + second[0, 6] + SLACK:
        return APART
    top = 1
    for _ in range(budget):
        if top == 0:
            return APART
        top -= 1
        one[:] = first[top]
        other[:] = second[top]
        if corners.shape[0] > 0 and polygon_distance(one, other, corners, SLACK) > SLACK:
            continue
        if one[6] + other[6] <= tolerance:
            return MEET
        if top + count > first.shape[0]:
            return UNKNOWN
        split_first = one[6] >= other[6]
        base = top
        for k in range(count):
            if split_first:
                set_child(linear, unit, k, one, child)
                apart = distance(child, other)
                room = child[6] + other[6]
            else:
                set_child(linear, unit, k, other, child)
                apart = distance(one, child)
                room = one[6] + child[6]
            if apart > room + SLACK:
                continue
            place = top
            while place > base and key[place - 1] < apart:
                key[place] = key[place - 1]
                first[place] = first[place - 1]
                second[place] = second[place - 1]
                place -= 1
            key[place] = apart
            first[place] = child if split_first else one
            second[place] = other if split_first else child
            top += 1
    return UNKNOWN if top > 0 else APART


@njit(nogil=True, cache=True)
def join(labels, i, j):
    """Give the component of j the label of the component of i."""
    new, old = labels[i], labels[j]
    for k in range(labels.shape[0]):
        if labels[k] == old:
            labels[k] = new


@njit(nogil=True, cache=True)
def surely_one_piece(labels, areas):
    """Whether the known components, or else the area certificate, show that the attractor is connected.

    If it were not, it would part into two sides, each a union of components. A small enough neighbourhood of it of
    size e then has room for the images of itself that it must hold, the largest on each side, only if the largest
    determinants of the two sides sum to less than 1. So it is connected if, however the components are put on two
    sides, they sum to 1 or more; the worst case has the smallest component alone.
    """
    largest, smallest = 0.0, np.inf
    components = 0
    for i in range(labels.shape[0]):
        if labels[i] != i:
            continue
        components += 1
        area = 0.0
        for k in range(labels.shape[0]):
            if labels[k] == i:
                area = max(area, areas[k])
        largest, smallest = max(largest, area), min(smallest, area)
    return components == 1 or largest + smallest >= 1 + SLACK


@njit(nogil=True, cache=True)
def decide(linear, unit, areas, tolerance, labels, first, second, key):
    """State of one attractor, and in `labels` (N,) the component that each attractorlet is known to belong to.

    An attractor is connected if and only if the overlap graph of its attractorlets is (Hata 1985; Burch & Hart 1997,
    Theorem 2). Discs first; the outer polygon only for pairs that discs leave open.
    """
    count = linear.shape[0]
    for i in range(count):
        labels[i] = i
    if surely_one_piece(labels, areas):
        return CONNECTED
    pairs = count * (count - 1) // 2
    left, right = np.empty(pairs, np.int64), np.empty(pairs, np.int64)
    between = np.empty(pairs)
    pieces = np.empty((count, 7))
    for i in range(count):
        set_piece(linear, unit, i, pieces[i])
    known = 0
    for i in range(count):
        for j in range(i + 1, count):
            apart = distance(pieces[i], pieces[j]) - pieces[i, 6] - pieces[j, 6]
            if apart > SLACK:
                continue
            place = known
            while place > 0 and between[place - 1] > apart:
                between[place] = between[place - 1]
                left[place], right[place] = left[place - 1], right[place - 1]
                place -= 1
            between[place], left[place], right[place] = apart, i, j
            known += 1
    corners = np.empty((0, 2))
    for stage in range(2):
        if stage == 1:
            _, corners = outer_polygon(linear, unit, 1.0, enclosure.DIRECTIONS, 1e-3)
        still_open = 0
        for pair in range(known):
            i, j = left[pair], right[pair]
            if labels[i] == labels[j]:
                continue
            budget = DISC_BUDGET if stage == 0 else POLYGON_BUDGET
            outcome = pair_test(linear, unit, i, j, tolerance, corners, budget, first, second, key)
            if outcome == MEET:
                join(labels, min(labels[i], labels[j]), max(labels[i], labels[j]))
                if surely_one_piece(labels, areas):
                    return CONNECTED
            elif outcome == UNKNOWN:
                left[still_open], right[still_open] = i, j
                still_open += 1
        known = still_open
        if known == 0:
            return DISCONNECTED
    for pair in range(known):
        if labels[left[pair]] != labels[right[pair]]:
            return UNDECIDED
    return DISCONNECTED


@njit(nogil=True, cache=True)
def sift_up(order, key, place):
    """Restore a heap of indices, least key on top, after its last entry changed."""
    while place > 0 and key[order[place]] < key[order[(place - 1) // 2]]:
        above = (place - 1) // 2
        order[place], order[above] = order[above], order[place]
        place = above


@njit(nogil=True, cache=True)
def sift_down(order, key, length):
    """Restore a heap of indices, least key on top, after its first entry changed."""
    place = 0
    while True:
        least = place
        for below in (2 * place + 1, 2 * place + 2):
            if below < length and key[order[below]] < key[order[least]]:
                least = below
        if least == place:
            return
        order[place], order[least] = order[least], order[place]
        place = least


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
    _, corners = outer_polygon(linear, unit, 1.0, enclosure.DIRECTIONS, 1e-3)
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
        if room <= max(tolerance, GAP_PRECISION * apart) or used + count > first.shape[0]:
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


@njit(nogil=True, cache=True)
def decide_column(linear, translations, tolerance, with_gap):
    """States of attractors that share their linear parts, as those of one u do.

    Parameters
    ----------
    linear : (N, 4)
    translations : (V, N, 2)
    tolerance : float
        Relative to the enclosing diameter.
    with_gap : bool
        Whether to measure the gaps.

    Returns
    -------
    state : (V,) uint8
    gap : (V, 2)
        Brackets relative to the enclosing diameter; NaN where there is no attractor or the gap was not asked for.
    labels : (V, N) int64
        Components of attractorlets that are known to meet.
    """
    nodes, count = translations.shape[0], linear.shape[0]
    state = np.empty(nodes, np.uint8)
    gap = np.full((nodes, 2), np.nan)
    labels = np.zeros((nodes, count), np.int64)
    outcome, parent, letter, product, size, limit = shrinking_words(linear)
    if outcome != enclosure.COVERED:
        state[:] = NO_ATTRACTOR if outcome == enclosure.NO_ATTRACTOR else UNDECIDED
        for i in range(count):
            labels[:, i] = i
        return state, gap, labels
    areas = np.abs(linear[:, 0] * linear[:, 3] - linear[:, 1] * linear[:, 2])
    if surely_one_piece(np.arange(count), areas):
        state[:] = CONNECTED
        gap[:] = 0.0
        return state, gap, labels
    room = GAP_PAIRS + count * (count - 1) // 2
    first, second = np.empty((room, 7)), np.empty((room, 7))
    ends, order = np.empty((room, 3), np.int64), np.empty(room, np.int64)
    key = np.empty(room)
    unit = np.empty((count, 2))
    scratch = np.empty(count, np.int64)
    for node in range(nodes):
        x, y, radius = enclosing_disc(linear, translations[node], parent, letter, product, size, limit)
        if radius <= POINT * (abs(x) + abs(y)):
            state[node], gap[node] = CONNECTED, 0.0
            continue
        normalize(linear, translations[node], x, y, radius, unit)
        state[node] = decide(linear, unit, areas, tolerance, labels[node], first[:STACK], second[:STACK], key)
        if state[node] == CONNECTED:
            labels[node] = 0
            gap[node, 0], gap[node, 1] = 0.0, tolerance
        elif with_gap:
            low, high = measure_gap(linear, unit, tolerance, scratch, first, second, ends, key, order)
            gap[node, 0] = max(low, SLACK) / 2 if state[node] == DISCONNECTED else 0.0
            gap[node, 1] = high / 2
    return state, gap, labels
