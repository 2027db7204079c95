"""Words of an IFS in space as a tree that grows where it is looked at (see `core.tree`)."""

from __future__ import annotations

from collections import namedtuple

import numpy as np

from ..kernels import njit
from .enclosure import norm

CAPACITY = 40_000
"""Words that a tree can hold."""

START, DRIFT, NORM, COLUMNS = 9, 12, 15, 16
"""Columns of a word after the nine of its linear part: its translation at 0, what is added to it at 1, its norm."""

Tree = namedtuple("Tree", "word child used")
"""Words (CAPACITY, 16), those of one letter first; the place of each word's first child (CAPACITY,), which its other
children follow, or -1; the number of words, and how many pairs of pieces were looked at (2,)."""

View = namedtuple("View", "x y z along radius slack")
"""One of the attractors that share a tree: a ball that holds it, where it is on the drift, and the rounding allowed in
a distance, so that pieces are called apart only when they are."""


@njit(nogil=True, cache=True)
def empty_tree(capacity):
    """Room for a tree."""
    return Tree(np.empty((capacity, COLUMNS)), np.empty(capacity, np.int32), np.zeros(2, np.int64))


@njit(nogil=True, cache=True)
def plant(tree, linear, start, drift):
    """Start a tree afresh with the maps (N, 9), (N, 3), (N, 3) as words of one letter."""
    count = linear.shape[0]
    for i in range(count):
        word = tree.word[i]
        word[:START] = linear[i]
        word[START:DRIFT] = start[i]
        word[DRIFT:NORM] = drift[i]
        word[NORM] = norm(linear[i])
        tree.child[i] = -1
    tree.used[0] = count


@njit(nogil=True, cache=True)
def prune(tree, count):
    """Leave only the words of one letter, of which there are `count`."""
    for i in range(count):
        tree.child[i] = -1
    tree.used[0] = count


@njit(nogil=True, cache=True)
def first_child(tree, count, parent):
    """Place of the first of a word's N children, which are made if they are not there; -1 if there is no room."""
    first = tree.child[parent]
    if first >= 0:
        return first
    first = tree.used[0]
    if first + count > tree.child.shape[0]:
        return -1
    whole = tree.word[parent]
    for k in range(count):
        letter, part = tree.word[k], tree.word[first + k]
        for row in range(3):
            a, b, c = whole[3 * row], whole[3 * row + 1], whole[3 * row + 2]
            for column in range(3):
                part[3 * row + column] = a * letter[column] + b * letter[3 + column] + c * letter[6 + column]
            part[START + row] = a * letter[START] + b * letter[START + 1] + c * letter[START + 2] + whole[START + row]
            part[DRIFT + row] = a * letter[DRIFT] + b * letter[DRIFT + 1] + c * letter[DRIFT + 2] + whole[DRIFT + row]
        part[NORM] = norm(part)
        tree.child[first + k] = -1
    tree.child[parent] = first
    tree.used[0] = first + count
    return first


@njit(nogil=True, cache=True)
def center(tree, place, view):
    """Centre of the ball that holds the piece of a word: the image of the attractor's."""
    w = tree.word[place]
    x, y, z, along = view.x, view.y, view.z, view.along
    return (
        w[0] * x + w[1] * y + w[2] * z + w[9] + along * w[12],
        w[3] * x + w[4] * y + w[5] * z + w[10] + along * w[13],
        w[6] * x + w[7] * y + w[8] * z + w[11] + along * w[14],
    )
