"""The kernel that decides, with certainty, which attractorlets in space meet (see `core.overlap`).

By balls; and where these leave it open by the images of the ball and of the outer polytope that hold the attractor:
those of maps that make thin pieces, and of thin attractors, are far smaller than the balls around them.
"""

from __future__ import annotations

import math

import numpy as np

from ..kernels import njit
from ..overlap import APART, MEET, UNKNOWN
from .polytope import corner
from .tree import DRIFT, NORM, START, center, first_child

BUDGET = 20_000
"""Pairs of pieces looked at before a pair is given up."""


@njit(nogil=True, cache=True)
def pair_test(tree, count, view, i, j, tolerance, reaches, steps, budget, first, second, key):
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
    reaches : (27,)
        Of the outer polytope about the ball's centre, see `polytope`.
    steps : int
        Of `surely_apart`; with 0 only balls are tried.
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
        if steps > 0 and surely_apart(tree, view, large, small, reaches, steps):
            continue
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


@njit(nogil=True, cache=True)
def surely_apart(tree, view, one, other, reaches, steps):
    """Whether a plane parts what encloses two pieces, tried by some steps of Gilbert's algorithm (1966)."""
    one_x, one_y, one_z = center(tree, one, view)
    other_x, other_y, other_z = center(tree, other, view)
    # From one to the other: a point of their difference, which comes ever closer to zero.
    x, y, z = other_x - one_x, other_y - one_y, other_z - one_z
    from_x, from_y, from_z = x, y, z
    for _ in range(steps):
        length = math.sqrt(x * x + y * y + z * z)
        if length <= view.slack:
            return False
        p, q, r = furthest(tree.word[one], view.radius, reaches, x, y, z)
        s, t, u = furthest(tree.word[other], view.radius, reaches, -x, -y, -z)
        # The point of the difference that lies furthest back.
        back_x, back_y, back_z = from_x + s - p, from_y + t - q, from_z + u - r
        if x * back_x + y * back_y + z * back_z > view.slack * length:
            return True
        step_x, step_y, step_z = back_x - x, back_y - y, back_z - z
        square = step_x * step_x + step_y * step_y + step_z * step_z
        if square == 0:
            return False
        share = min(max(-(x * step_x + y * step_y + z * step_z) / square, 0.0), 1.0)
        x, y, z = x + share * step_x, y + share * step_y, z + share * step_z
    return False


@njit(nogil=True, cache=True)
def furthest(w, radius, reaches, x, y, z):
    """A point beyond which no point of a word's piece lies in a direction, about the piece's centre.

    Of the image of the ball or of that of the polytope, whichever reaches less far.
    """
    p = w[0] * x + w[3] * y + w[6] * z
    q = w[1] * x + w[4] * y + w[7] * z
    r = w[2] * x + w[5] * y + w[8] * z
    length = math.sqrt(p * p + q * q + r * r)
    a, b, c = corner(reaches, p, q, r)
    if length > 0 and p * a + q * b + r * c > radius * length:
        a, b, c = radius * p / length, radius * q / length, radius * r / length
    return w[0] * a + w[1] * b + w[2] * c, w[3] * a + w[4] * b + w[5] * c, w[6] * a + w[7] * b + w[8] * c
