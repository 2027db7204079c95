"""The state of an attractor, from its maps to a verdict: one kernel for a locus, a path or a single shape.

It puts together whether there is an attractor (`enclosure`), which attractorlets meet (`overlap`), and how far apart
the others are (`gap`).
"""

from __future__ import annotations

import math
from collections import namedtuple

import numpy as np

from . import enclosure
from .enclosure import POINT, enclosing_disc, mean_fixed_point, move_origin, shrinking_words
from .gap import empty_search, measure_gap
from .heap import ascending
from .kernels import njit
from .overlap import BUDGET, MEET, ROUNDING, SLACK, STACK, UNKNOWN, join, pair_test, surely_one_piece
from .polygon import directions_seen, shrink_polygon
from .states import CONNECTED, DISCONNECTED, NO_ATTRACTOR, UNDECIDED
from .tree import CAPACITY, NORM, View, center, empty_tree, plant, prune

DISC_BUDGET = 256
"""Pairs of pieces looked at in the first stage, which knows discs only; `overlap.BUDGET` in the second."""

WORDS_A_MAP = 8000
MANY = 32
"""Room of the tree for each of so many maps: enough for a pair test to its end, whatever was looked at before."""

WORK = 30_000
"""Pairs of pieces after which no other attractor is begun in one go."""

MOST_WORK = 300_000
"""Pairs of pieces looked at for one attractor, after which pairs of attractorlets are left open."""

DIRECTIONS = 16
POLYGON_PRECISION = 1e-3
"""Of the outer polygon: its sides, and the change at which it is good enough, relative to the disc's radius."""

Desk = namedtuple(
    "Desk", "tree follows search first second key left right between order nearest reach corners unit points"
)
"""Work space, made once for many attractors; every letter may come after every other."""


@njit(nogil=True, cache=True)
def empty_desk(count):
    """Work space for N maps."""
    pairs = max(1, count * (count - 1) // 2)
    return Desk(
        empty_tree(max(CAPACITY, min(count, MANY) * WORDS_A_MAP)),
        np.ones((count, count), np.bool_),
        empty_search(count),
        np.empty(STACK, np.int32),
        np.empty(STACK, np.int32),
        np.empty(STACK),
        np.empty(pairs, np.int64),
        np.empty(pairs, np.int64),
        np.empty(pairs),
        np.empty(pairs, np.int64),
        np.empty(pairs, np.int64),
        np.empty(DIRECTIONS),
        np.empty((DIRECTIONS, 2)),
        np.empty((count, 2)),
        np.empty((count, 2)),
    )


@njit(nogil=True, cache=True)
def decide(desk, linear, areas, seen, view, tolerance, labels):
    """State of one attractor, and in `labels` (N,) the component that each attractorlet is known to belong to.

    An attractor is connected if and only if the overlap graph of its attractorlets is (Hata 1985; Burch & Hart 1997,
    Theorem 2). Discs first; the outer polygon only for pairs that discs leave open.
    """
    count = linear.shape[0]
    tree = desk.tree
    left, right, between, nearest = desk.left, desk.right, desk.between, desk.nearest
    known = 0
    for i in range(count):
        labels[i] = i
        one_x, one_y = center(tree, i, view)
        for j in range(i + 1, count):
            other_x, other_y = center(tree, j, view)
            apart = math.sqrt((one_x - other_x) * (one_x - other_x) + (one_y - other_y) * (one_y - other_y))
            apart -= view.radius * (tree.word[i, NORM] + tree.word[j, NORM])
            if apart <= view.slack:
                between[known], left[known], right[known] = apart, i, j
                known += 1
    ascending(between, known, desk.order, nearest)
    begun = tree.used[1]
    for stage in range(2):
        corners = desk.corners[: stage * DIRECTIONS]
        if stage == 1:
            find_polygon(desk, linear, seen, view)
        still_open = 0
        for place in range(known):
            i, j = left[nearest[place]], right[nearest[place]]
            if labels[i] == labels[j]:
                continue
            if tree.used[0] > tree.child.shape[0] // 2:
                prune(tree, count)
            budget = DISC_BUDGET if stage == 0 else BUDGET
            if tree.used[1] - begun > MOST_WORK:
                budget = 0
            outcome = pair_test(
                tree, desk.follows, view, i, j, tolerance, corners, budget, desk.first, desk.second, desk.key
            )
            if outcome == MEET:
                join(labels, i, j)
                if surely_one_piece(labels, areas):
                    return CONNECTED
            elif outcome == UNKNOWN:
                nearest[still_open] = nearest[place]
                still_open += 1
        known = still_open
        if known == 0:
            return DISCONNECTED
    for place in range(known):
        if labels[left[nearest[place]]] != labels[right[nearest[place]]]:
            return UNDECIDED
    return DISCONNECTED


@njit(nogil=True, cache=True)
def find_polygon(desk, linear, seen, view):
    """Write the corners of the outer polygon, about the centre of the disc."""
    normal, sector, share = seen
    for i in range(linear.shape[0]):
        x, y = center(desk.tree, i, view)
        desk.unit[i, 0], desk.unit[i, 1] = x - view.x, y - view.y
    tolerance = POLYGON_PRECISION * view.radius
    shrink_polygon(normal, sector, share, desk.unit, view.radius, view.slack, tolerance, desk.reach, desk.corners)


@njit(nogil=True, cache=True)
def find_points(desk, linear):
    """Write the fixed points of the maps, about the centre of the disc: points on the attractor."""
    for i in range(linear.shape[0]):
        a, b, c, d = 1 - linear[i, 0], -linear[i, 1], -linear[i, 2], 1 - linear[i, 3]
        det = a * d - b * c
        desk.points[i, 0] = (d * desk.unit[i, 0] - b * desk.unit[i, 1]) / det
        desk.points[i, 1] = (a * desk.unit[i, 1] - c * desk.unit[i, 0]) / det


@njit(nogil=True, cache=True)
def decide_drift(desk, linear, start, drift, along, tolerance, with_gap, first, state, gap, labels):
    """Decide some attractors that share their linear parts, from the `first` on; see `deciding.column_steps`.

    Stops after `WORK`, so that a caller can look up. `state` (V,), `gap` (V, 2) and `labels` (V, N) are written.

    Returns
    -------
    int
        The first that is left.
    """
    nodes, count = along.shape[0], linear.shape[0]
    for node in range(first, nodes):
        gap[node, 0] = gap[node, 1] = np.nan
        for i in range(count):
            labels[node, i] = i
    outcome, parent, letter, product, size, limit = shrinking_words(linear, desk.follows)
    if outcome != enclosure.COVERED:
        for node in range(first, nodes):
            state[node] = NO_ATTRACTOR if outcome == enclosure.NO_ATTRACTOR else UNDECIDED
        return nodes
    areas = np.empty(count)
    for i in range(count):
        areas[i] = abs(linear[i, 0] * linear[i, 3] - linear[i, 1] * linear[i, 2])
    if first < nodes and surely_one_piece(labels[first], areas):
        for node in range(first, nodes):
            set_whole(node, 0.0, state, gap, labels)
        return nodes
    seen = directions_seen(linear, np.int64(DIRECTIONS))
    moved, translation, known = np.empty((count, 2)), np.empty((count, 2)), np.empty(count, np.int64)
    for i in range(count):
        for axis in range(2):
            translation[i, axis] = start[i, axis] + along[nodes // 2] * drift[i, axis]
    origin_x, origin_y = mean_fixed_point(linear, translation)
    # About an origin close by, so that a shape far away is as precise as any.
    move_origin(linear, start, origin_x, origin_y, moved)
    # The largest numbers that are added up, and may cancel.
    reach, drift_reach = abs(origin_x) + abs(origin_y), 0.0
    for i in range(count):
        reach = max(reach, abs(moved[i, 0]) + abs(moved[i, 1]))
        drift_reach = max(drift_reach, abs(drift[i, 0]) + abs(drift[i, 1]))
    tree = desk.tree
    plant(tree, linear, moved, drift)
    tree.used[1] = 0
    for node in range(first, nodes):
        if tree.used[1] > WORK:
            return node
        for i in range(count):
            for axis in range(2):
                translation[i, axis] = moved[i, axis] + along[node] * drift[i, axis]
        x, y, radius = enclosing_disc(linear, translation, parent, letter, product, size, limit)
        largest = reach + abs(along[node]) * drift_reach
        if radius <= POINT * largest:
            set_whole(node, 0.0, state, gap, labels)
            continue
        view = View(x, y, along[node], radius, SLACK * max(radius, abs(x) + abs(y)) + ROUNDING * largest)
        state[node] = decide(desk, linear, areas, seen, view, tolerance, labels[node])
        if state[node] == CONNECTED:
            set_whole(node, tolerance, state, gap, labels)
        elif with_gap:
            find_polygon(desk, linear, seen, view)
            find_points(desk, linear)
            for i in range(count):
                known[i] = labels[node, i]
            low, high = measure_gap(tree, desk.follows, view, tolerance, desk.corners, desk.points, known, desk.search)
            gap[node, 0] = max(low / radius, SLACK) / 2 if state[node] == DISCONNECTED else 0.0
            gap[node, 1] = max(high / (2 * radius), tolerance, gap[node, 0])
    return nodes


@njit(nogil=True, cache=True)
def set_whole(node, widest, state, gap, labels):
    """Write that an attractor is in one piece."""
    state[node], gap[node, 0], gap[node, 1] = CONNECTED, 0.0, widest
    for i in range(labels.shape[1]):
        labels[node, i] = 0


@njit(nogil=True, cache=True)
def decide_each(linear, translation, tolerance, with_gap):
    """Decide attractors of any maps; see `deciding.decide_frames`."""
    frames, count = linear.shape[0], linear.shape[1]
    state, gap = np.empty(frames, np.uint8), np.empty((frames, 2))
    labels = np.empty((frames, count), np.int64)
    desk = empty_desk(count)
    drift, along, zero = np.zeros((count, 2)), np.zeros(1), np.int64(0)
    for k in range(frames):
        here = slice(k, k + 1)
        decide_drift(
            desk,
            linear[k],
            translation[k],
            drift,
            along,
            tolerance,
            with_gap,
            zero,
            state[here],
            gap[here],
            labels[here],
        )
    return state, gap, labels
