"""The kernel that decides, with certainty, which attractorlets in space meet (see `core.overlap`): by balls."""

from __future__ import annotations

import numpy as np

from ..kernels import njit
from ..overlap import APART, MEET, UNKNOWN
from .tree import DRIFT, NORM, START, center, first_child

BUDGET = 20_000
"""Pairs of pieces looked at before a pair is given up."""


@njit(nogil=True, cache=True)
def pair_test(tree, count, view, i, j, tolerance, budget, first, second, key):
    """Whether attractorlets i and j of N meet.

    Splits the larger of two pieces into its parts, nearest first, drops pairs that are certainly apart, and stops at a
    pair so small that it meets at the tolerance.

    Parameters
    ----------
    tree : Tree
    count : int
        N.
    view : View
    i, j : int
    tolerance : float
        Pieces that are surely no further apart than this share of the ball's diameter meet.
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
    x, y, z, along = view.x, view.y, view.z, view.along
    first[0], second[0], key[0] = i, j, np.inf
    top = 1
    for _ in range(budget):
        if top == 0:
            return APART
        tree.used[1] += 1
        top -= 1
        large, small = first[top], second[top]
        if word[large, NORM] < word[small, NORM]:
            large, small = small, large
        small_norm = word[small, NORM]
        # No two points of the pieces are further apart than their centres and both radii together.
        room = view.radius * (2 * tolerance - word[large, NORM] - small_norm)
        if room >= 0 and key[top] <= room * room:
            return MEET
        child = first_child(tree, count, large)
        if child < 0 or top + count > key.shape[0]:
            return UNKNOWN
        small_x, small_y, small_z = center(tree, small, view)
        base = top
        for k in range(child, child + count):
            # As `center`, written out: this is where the time goes.
            w = word[k]
            dx = w[0] * x + w[1] * y + w[2] * z + w[START] + along * w[DRIFT] - small_x
            dy = w[3] * x + w[4] * y + w[5] * z + w[START + 1] + along * w[DRIFT + 1] - small_y
            dz = w[6] * x + w[7] * y + w[8] * z + w[START + 2] + along * w[DRIFT + 2] - small_z
            reach = view.radius * (w[NORM] + small_norm) + view.slack
            apart = dx * dx + dy * dy + dz * dz
            if apart > reach * reach:
                continue
            place = top
            while place > base and key[place - 1] < apart:
                key[place], first[place], second[place] = key[place - 1], first[place - 1], second[place - 1]
                place -= 1
            key[place], first[place], second[place] = apart, k, small
            top += 1
    return UNKNOWN if top > 0 else APART
