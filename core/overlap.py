"""Kernels that decide, with certainty, which attractorlets meet.

A *piece* is the image of the attractor under a word. It lies in the image of the attractor's disc, whose centre moves
with the word and whose radius shrinks by the word's norm; and in the image of the outer polygon.
"""

from __future__ import annotations

import numpy as np

from .kernels import njit
from .polygon import polygon_distance
from .tree import DRIFT_X, DRIFT_Y, NORM, START_X, START_Y, A, B, C, D, center, children

MEET, APART, UNKNOWN = 0, 1, 2
"""Outcomes of a pair test."""

SLACK = 1e-12
"""Rounding allowed, relative to the size of the shape and its distance from the origin."""

ROUNDING = 2e-15
"""Rounding allowed, relative to the largest of the numbers that are added up and may cancel."""

BUDGET = 4000
"""Pairs of pieces looked at before a pair is given up."""

STACK = 4096
"""Pairs of pieces held at once by the pair test."""

POLYGON_STEPS = 4
"""Of Gilbert's algorithm."""


@njit(nogil=True, cache=True)
def pair_test(tree, follows, view, i, j, tolerance, corners, budget, first, second, key):
    """Whether attractorlets i and j meet.

    Splits the larger of two pieces into its parts, nearest first, drops pairs that are certainly apart, and stops at a
    pair so small that it meets at the tolerance.

    Parameters
    ----------
    tree : Tree
    follows : (N, N) bool
        See `tree.children`.
    view : View
    i, j : int
    tolerance : float
        Pieces that are surely no further apart than this share of the disc's diameter meet.
    corners : (K, 2)
        Of the outer polygon; with K = 0 only discs are tried.
    budget : int
        Pairs looked at before giving up.
    first, second, key : (M,)
        Work space: a stack of pairs of words, and the squares of the distances of their centres.

    Returns
    -------
    int
        MEET, APART or UNKNOWN.
    """
    word = tree.word
    x, y, along = view.x, view.y, view.along
    first[0], second[0], key[0] = i, j, np.inf
    top = 1
    for _ in range(budget):
        if top == 0:
            return APART
        top -= 1
        tree.used[1] += 1
        large, small = first[top], second[top]
        if word[large, NORM] < word[small, NORM]:
            large, small = small, large
        small_x, small_y = center(tree, small, view)
        small_norm = word[small, NORM]
        if corners.shape[0] > 0:
            large_x, large_y = center(tree, large, view)
            apart_x, apart_y = small_x - large_x, small_y - large_y
            slack = view.slack
            if polygon_distance(word, large, small, apart_x, apart_y, corners, slack, np.int64(POLYGON_STEPS)) > slack:
                continue
        # No two points of the pieces are further apart than their centres and both radii together.
        room = view.radius * (2 * tolerance - word[large, NORM] - small_norm)
        if room >= 0 and key[top] <= room * room:
            return MEET
        child, end = children(tree, follows, large)
        if child < 0 or top + end - child > key.shape[0]:
            return UNKNOWN
        base = top
        for k in range(child, end):
            # As `center`, written out: this is where the time goes.
            dx = word[k, A] * x + word[k, B] * y + word[k, START_X] + along * word[k, DRIFT_X] - small_x
            dy = word[k, C] * x + word[k, D] * y + word[k, START_Y] + along * word[k, DRIFT_Y] - small_y
            reach = view.radius * (word[k, NORM] + small_norm) + view.slack
            apart = dx * dx + dy * dy
            if apart > reach * reach:
                continue
            place = top
            while place > base and key[place - 1] < apart:
                key[place], first[place], second[place] = key[place - 1], first[place - 1], second[place - 1]
                place -= 1
            key[place], first[place], second[place] = apart, k, small
            top += 1
    return UNKNOWN if top > 0 else APART


@njit(nogil=True, cache=True)
def join(labels, i, j):
    """Put the components of i and j together, under the lower of their labels."""
    low, high = min(labels[i], labels[j]), max(labels[i], labels[j])
    for k in range(labels.shape[0]):
        if labels[k] == high:
            labels[k] = low


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
