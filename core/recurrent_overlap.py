"""Kernels that decide which attractorlets of a recurrent IFS meet, as `overlap` does for plain ones.

What a word is applied to depends on its last letter, so each letter has a disc of its own. Its centre is a point of
the attractor: two pieces are no further apart than the images of their centres are.
"""

from __future__ import annotations

import math
from collections import namedtuple

import numpy as np

from .enclosure import norm
from .kernels import njit
from .overlap import APART, MEET, UNKNOWN
from .tree import NORM, START_X, START_Y, A, B, C, D, children, prune

ROUNDS = 12
"""Of what gets more precise each time: the middles, and the radii about the centres."""

DOUBLINGS = 12
"""2 to the power of this is how long a word a centre starts from."""

DEPTH = 8
"""Letters by which the centre of a disc is moved towards the middle."""

Discs = namedtuple("Discs", "x y radius")
"""For each letter (N,), a disc about a point of what may follow it, that holds all of it."""


@njit(nogil=True, cache=True)
def letter_discs(linear, translation, follows, view):
    """Discs about what may follow each letter: ``U w_k(U_k)`` over those k for letter i, the fixed point U of that."""
    count = linear.shape[0]
    middle, start = middles_and_points(linear, translation, follows, view)
    discs = Discs(np.empty(count), np.empty(count), np.empty(count))
    sizes = np.empty(count)
    for i in range(count):
        sizes[i] = norm(linear[i, 0], linear[i, 1], linear[i, 2], linear[i, 3])
        discs.x[i], discs.y[i] = near(linear, translation, follows, start, i, middle[i, 0], middle[i, 1])
        discs.radius[i] = math.hypot(discs.x[i] - view.x, discs.y[i] - view.y) + view.radius + view.slack
    for _ in range(ROUNDS):
        for i in range(count):
            reach = 0.0
            for k in range(count):
                if follows[i, k]:
                    x, y = image(linear, translation, k, discs.x[k], discs.y[k])
                    apart = math.hypot(x - discs.x[i], y - discs.y[i])
                    reach = max(reach, apart + sizes[k] * discs.radius[k] + view.slack)
            discs.radius[i] = min(discs.radius[i], reach)
    return discs


@njit(nogil=True, cache=True)
def middles_and_points(linear, translation, follows, view):
    """Middles (N, 2) of what may follow each letter, and points (N, 2) of it."""
    count = linear.shape[0]
    middle, moved = np.empty((count, 2)), np.empty((count, 2))
    for i in range(count):
        middle[i, 0], middle[i, 1] = view.x, view.y
    nearest = np.empty(count, np.int64)
    for _ in range(ROUNDS):
        for i in range(count):
            total_x = total_y = least = 0.0
            letters = 0
            for k in range(count):
                if follows[i, k]:
                    x, y = image(linear, translation, k, middle[k, 0], middle[k, 1])
                    apart = math.hypot(x - middle[i, 0], y - middle[i, 1])
                    if letters == 0 or apart < least:
                        least, nearest[i] = apart, k
                    total_x, total_y, letters = total_x + x, total_y + y, letters + 1
            moved[i, 0], moved[i, 1] = total_x / letters, total_y / letters
        middle[:] = moved
    # From each letter on to the one nearest to its middle, again and again: a word twice as long each time.
    word, shift = np.empty((count, 4)), np.empty((count, 2))
    for i in range(count):
        word[i], shift[i] = linear[nearest[i]], translation[nearest[i]]
    for _ in range(DOUBLINGS):
        longer, further, then = np.empty((count, 4)), np.empty((count, 2)), np.empty(count, np.int64)
        for i in range(count):
            a, b, c, d = word[i]
            p, q, r, s = word[nearest[i]]
            longer[i, 0], longer[i, 1], longer[i, 2], longer[i, 3] = (
                a * p + b * r,
                a * q + b * s,
                c * p + d * r,
                c * q + d * s,
            )
            further[i, 0], further[i, 1] = image(word, shift, i, shift[nearest[i], 0], shift[nearest[i], 1])
            then[i] = nearest[nearest[i]]
        word, shift, nearest = longer, further, then
    return middle, shift


@njit(nogil=True, cache=True)
def near(linear, translation, follows, start, letter, x, y):
    """A point of what may follow a letter, near to (x, y), by the nearest of the points (N, 2) after each."""
    a, b, c, d, e, f = 1.0, 0.0, 0.0, 1.0, 0.0, 0.0
    found_x, found_y = start[letter]
    for _ in range(DEPTH):
        least, best = np.inf, letter
        for k in range(linear.shape[0]):
            if follows[letter, k]:
                at_x, at_y = image(linear, translation, k, start[k, 0], start[k, 1])
                at_x, at_y = a * at_x + b * at_y + e, c * at_x + d * at_y + f
                apart = math.hypot(at_x - x, at_y - y)
                if apart < least:
                    least, best, found_x, found_y = apart, k, at_x, at_y
        p, q, r, s = linear[best]
        e, f = (
            a * translation[best, 0] + b * translation[best, 1] + e,
            c * translation[best, 0] + d * translation[best, 1] + f,
        )
        a, b, c, d = a * p + b * r, a * q + b * s, c * p + d * r, c * q + d * s
        letter = best
    return found_x, found_y


@njit(nogil=True, cache=True)
def image(linear, translation, k, x, y):
    """Image of a point under map k."""
    return (
        linear[k, 0] * x + linear[k, 1] * y + translation[k, 0],
        linear[k, 2] * x + linear[k, 3] * y + translation[k, 1],
    )


@njit(nogil=True, cache=True)
def pieces_meet(tree, follows, discs, view, i, j, tolerance, budget, room):
    """Whether attractorlets i and j meet, as `overlap.pair_test` says it.

    Parameters
    ----------
    tree, follows, view, i, j, tolerance, budget
        As there.
    discs : Discs
    room : (first, second, key)
        Work space: a stack of pairs of words, and the distances of their centres.

    Returns
    -------
    int
        MEET, APART or UNKNOWN.
    """
    word, last = tree.word, tree.last
    first, second, key = room
    enough = 2 * tolerance * view.radius
    if tree.used[0] > tree.child.shape[0] // 2:
        prune(tree, follows.shape[0])
    first[0], second[0], key[0] = i, j, np.inf
    top = 1
    for _ in range(budget):
        if top == 0:
            return APART
        top -= 1
        tree.used[1] += 1
        if key[top] <= enough:
            return MEET
        large, small = first[top], second[top]
        if word[large, NORM] * discs.radius[last[large]] < word[small, NORM] * discs.radius[last[small]]:
            large, small = small, large
        small_x, small_y = center(word, small, discs, last[small])
        small_radius = word[small, NORM] * discs.radius[last[small]]
        child, end = children(tree, follows, large)
        if child < 0 or top + end - child > key.shape[0]:
            return UNKNOWN
        base = top
        for k in range(child, end):
            x, y = center(word, k, discs, last[k])
            apart = math.hypot(x - small_x, y - small_y)
            if apart > word[k, NORM] * discs.radius[last[k]] + small_radius + view.slack:
                continue
            place = top
            while place > base and key[place - 1] < apart:
                key[place], first[place], second[place] = key[place - 1], first[place - 1], second[place - 1]
                place -= 1
            key[place], first[place], second[place] = apart, k, small
            top += 1
    return UNKNOWN if top > 0 else APART


@njit(nogil=True, cache=True)
def center(word, place, discs, last):
    """The image under a word of the centre of its last letter's disc."""
    x, y = discs.x[last], discs.y[last]
    return (
        word[place, A] * x + word[place, B] * y + word[place, START_X],
        word[place, C] * x + word[place, D] * y + word[place, START_Y],
    )
