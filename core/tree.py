"""Words of an IFS as a tree that grows where it is looked at.

The linear part and the norm of a word depend on the linear parts of the maps alone, and its translation is linear in
theirs. So attractors whose maps differ by ``translation = start + along * drift``, as those of one u of a morph do,
share one tree, and a word once looked at costs the next attractor a few multiplications.
"""

from __future__ import annotations

from collections import namedtuple

import numpy as np

from .enclosure import norm
from .kernels import njit

CAPACITY = 30_000
"""Words that a tree can hold."""

A, B, C, D, START_X, START_Y, DRIFT_X, DRIFT_Y, NORM = range(9)
"""Columns of a word: its linear part, its translation at 0 and what is added to it at 1, its norm."""

Tree = namedtuple("Tree", "word child last used")
"""Words (CAPACITY, 9), those of one letter first; the place of each word's first child (CAPACITY,), which its other
children follow, or -1; its last letter (CAPACITY,); the number of words, and of
pairs of them that were looked at (2,)."""

View = namedtuple("View", "x y along radius slack")
"""One of the attractors that share a tree: a disc that holds it, where it is on the drift, and the rounding allowed in
a distance, so that pieces are called apart only when they are."""


@njit(nogil=True, cache=True)
def empty_tree(capacity):
    """Room for a tree."""
    return Tree(
        np.empty((capacity, 9)), np.empty(capacity, np.int32), np.empty(capacity, np.int32), np.zeros(2, np.int64)
    )


@njit(nogil=True, cache=True)
def plant(tree, linear, start, drift):
    """Start a tree afresh with the maps (N, 4), (N, 2), (N, 2) as words of one letter."""
    for i in range(linear.shape[0]):
        a, b, c, d = linear[i, 0], linear[i, 1], linear[i, 2], linear[i, 3]
        set_word(tree, i, i, a, b, c, d, start[i, 0], start[i, 1], drift[i, 0], drift[i, 1])
    tree.used[0] = linear.shape[0]


@njit(nogil=True, cache=True)
def prune(tree, count):
    """Leave only the words of one letter, of which there are `count`."""
    for i in range(count):
        tree.child[i] = -1
    tree.used[0] = count


@njit(nogil=True, cache=True)
def set_word(tree, place, last, a, b, c, d, start_x, start_y, drift_x, drift_y):
    """Write a word without children."""
    word = tree.word
    word[place, A], word[place, B], word[place, C], word[place, D] = a, b, c, d
    word[place, START_X], word[place, START_Y] = start_x, start_y
    word[place, DRIFT_X], word[place, DRIFT_Y] = drift_x, drift_y
    word[place, NORM] = norm(a, b, c, d)
    tree.child[place], tree.last[place] = -1, last


@njit(nogil=True, cache=True)
def children(tree, follows, parent):
    """Places of a word's children, the first and the one after the last; they are made if they are not there.

    Parameters
    ----------
    tree : Tree
    follows : (N, N) bool
        follows[i, k]: whether the letter k may come after i, as all may but in a recurrent IFS.
    parent : int

    Returns
    -------
    first, end : int
        -1 twice if there is no room.
    """
    count = 0
    letters = follows.shape[0]
    last = tree.last[parent]
    for k in range(letters):
        count += follows[last, k]
    first = tree.child[parent]
    if first >= 0:
        return first, first + count
    first = tree.used[0]
    word = tree.word
    if first + count > word.shape[0]:
        return -1, -1
    a, b, c, d = word[parent, A], word[parent, B], word[parent, C], word[parent, D]
    place = first
    for k in range(letters):
        if follows[last, k]:
            p, q, r, s = word[k, A], word[k, B], word[k, C], word[k, D]
            set_word(
                tree,
                place,
                k,
                a * p + b * r,
                a * q + b * s,
                c * p + d * r,
                c * q + d * s,
                a * word[k, START_X] + b * word[k, START_Y] + word[parent, START_X],
                c * word[k, START_X] + d * word[k, START_Y] + word[parent, START_Y],
                a * word[k, DRIFT_X] + b * word[k, DRIFT_Y] + word[parent, DRIFT_X],
                c * word[k, DRIFT_X] + d * word[k, DRIFT_Y] + word[parent, DRIFT_Y],
            )
            place += 1
    tree.child[parent] = first
    tree.used[0] = place
    return first, place


@njit(nogil=True, cache=True)
def center(tree, place, view):
    """Centre of the disc that holds the piece of a word: the image of the attractor's."""
    word = tree.word
    return (
        word[place, A] * view.x + word[place, B] * view.y + word[place, START_X] + view.along * word[place, DRIFT_X],
        word[place, C] * view.x + word[place, D] * view.y + word[place, START_Y] + view.along * word[place, DRIFT_Y],
    )
