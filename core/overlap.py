"""Kernels that decide, with certainty, which attractorlets meet.

Maps are given so that the unit disc about the origin holds the attractor (`normalize`). A *piece* is the image of the
attractor under a word, held as a row (a, b, c, d, e, f, s): it lies in the disc of radius s, the word's norm, about
(e, f). Distances are in units of the enclosing radius.
"""

from __future__ import annotations

import math

import numpy as np

from .enclosure import norm
from .kernels import njit

MEET, APART, UNKNOWN = 0, 1, 2
"""Outcomes of a pair test."""

SLACK = 1e-12
"""Rounding allowed in a distance, so that pieces are called apart only when they are."""

POLYGON_STEPS = 4
"""Of Gilbert's algorithm."""


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
