"""The state of an attractor in space, from its maps to a verdict (see `core.decision`)."""

from __future__ import annotations

import math
from collections import namedtuple

import numpy as np

from .. import enclosure
from ..decision import MANY, POINT, STACK, WORDS_A_MAP, WORK, set_whole
from ..heap import ascending
from ..kernels import njit
from ..overlap import MEET, ROUNDING, SLACK, UNKNOWN, join, surely_one_piece
from ..states import CONNECTED, DISCONNECTED, NO_ATTRACTOR, UNDECIDED
from .enclosure import determinant, enclosing_ball, fixed_point, mean_fixed_point, shrinking_words
from .gap import empty_search, measure_gap
from .overlap import BUDGET, pair_test
from .polytope import DIRECTIONS, shrink_polytope
from .tree import CAPACITY, NORM, View, center, empty_tree, plant, prune

EASY_BUDGET = 256
"""Pairs of pieces looked at in the first stage, which knows balls only; `overlap.BUDGET` in the second, if need be."""

MOST_WORK = 30_000
"""Pairs of pieces looked at for one attractor, after which pairs of attractorlets are left open."""

STEPS = 4
"""Of the search for a plane between two pieces, in the second stage."""

POLYTOPE_PRECISION = 1e-3
"""The change at which the outer polytope is good enough, relative to the ball's radius."""

Desk = namedtuple("Desk", "tree drawn search first second key left right between order nearest reaches points")
"""Work space, made once for many attractors, and which attractorlets (N,) are drawn, all by default."""


@njit(nogil=True, cache=True)
def empty_desk(count):
    """Work space for N maps."""
    pairs = max(1, count * (count - 1) // 2)
    return Desk(
        empty_tree(max(CAPACITY, min(count, MANY) * WORDS_A_MAP)),
        np.ones(count, np.bool_),
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
        np.empty((count, 3)),
    )


@njit(nogil=True, cache=True)
def decide(desk, linear, areas, view, tolerance, labels):
    """State of one attractor, and in `labels` (N,) the component that each attractorlet is known to belong to.

    Before, each has a label of its own, -1 if it does not count.

    The area certificate holds in any number of dimensions: `areas` (N,) are the volumes of the maps here.
    """
    tree, count = desk.tree, labels.shape[0]
    left, right, between, nearest = desk.left, desk.right, desk.between, desk.nearest
    known = 0
    for i in range(count):
        x, y, z = center(tree, i, view)
        for j in range(i + 1, count):
            if min(labels[i], labels[j]) < 0:
                continue
            p, q, r = center(tree, j, view)
            apart = math.sqrt((x - p) * (x - p) + (y - q) * (y - q) + (z - r) * (z - r))
            apart -= view.radius * (tree.word[i, NORM] + tree.word[j, NORM])
            if apart <= view.slack:
                between[known], left[known], right[known] = apart, i, j
                known += 1
    ascending(between, known, desk.order, nearest)
    begun = tree.used[1]
    for steps, budget in ((0, EASY_BUDGET), (STEPS, BUDGET)):
        still_open = 0
        if steps > 0:
            find_polytope(desk, linear, view)
        for place in range(known):
            i, j = left[nearest[place]], right[nearest[place]]
            if labels[i] == labels[j]:
                continue
            if tree.used[0] > tree.child.shape[0] // 2:
                prune(tree, count)
            looks = budget if tree.used[1] - begun < MOST_WORK else 0
            outcome = pair_test(
                tree, count, view, i, j, tolerance, desk.reaches, steps, looks, desk.first, desk.second, desk.key
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
def decide_drawn(desk, linear, view, tolerance, labels):
    """`decide` for what is drawn of an attractor that is connected, as all its attractorlets are then."""
    for i in range(labels.shape[0]):
        labels[i] = i if desk.drawn[i] else -1
    # The certificate is for whole attractors.
    none = np.zeros(labels.shape[0])
    return CONNECTED if surely_one_piece(labels, none) else decide(desk, linear, none, view, tolerance, labels)


@njit(nogil=True, cache=True)
def find_polytope(desk, linear, view):
    """Write the reaches of the outer polytope, about the centre of the ball."""
    for i in range(linear.shape[0]):
        x, y, z = center(desk.tree, i, view)
        desk.points[i, 0], desk.points[i, 1], desk.points[i, 2] = x - view.x, y - view.y, z - view.z
    shrink_polytope(linear, desk.points, view.radius, view.slack, POLYTOPE_PRECISION * view.radius, desk.reaches)


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
    outcome, parent, letter, product, size, limit = shrinking_words(linear)
    if outcome != enclosure.COVERED:
        for node in range(first, nodes):
            state[node] = NO_ATTRACTOR if outcome == enclosure.NO_ATTRACTOR else UNDECIDED
        return nodes
    areas = np.empty(count)
    for i in range(count):
        areas[i] = abs(determinant(linear[i]))
    all_drawn = desk.drawn.all()
    if first < nodes and all_drawn and surely_one_piece(labels[first], areas):
        for node in range(first, nodes):
            set_whole(node, 0.0, state, gap, labels)
        return nodes
    moved, translation = np.empty((count, 3)), np.empty((count, 3))
    for i in range(count):
        for axis in range(3):
            translation[i, axis] = start[i, axis] + along[nodes // 2] * drift[i, axis]
    origin = mean_fixed_point(linear, translation)
    for i in range(count):
        # About an origin close by, so that a shape far away is as precise as any.
        for axis in range(3):
            row = linear[i, 3 * axis : 3 * axis + 3]
            image = row[0] * origin[0] + row[1] * origin[1] + row[2] * origin[2]
            moved[i, axis] = start[i, axis] + image - origin[axis]
    # The largest numbers that are added up, and may cancel.
    reach, drift_reach = abs(origin[0]) + abs(origin[1]) + abs(origin[2]), 0.0
    for i in range(count):
        reach = max(reach, abs(moved[i, 0]) + abs(moved[i, 1]) + abs(moved[i, 2]))
        drift_reach = max(drift_reach, abs(drift[i, 0]) + abs(drift[i, 1]) + abs(drift[i, 2]))
    tree = desk.tree
    plant(tree, linear, moved, drift)
    tree.used[1] = 0
    for node in range(first, nodes):
        if tree.used[1] > WORK:
            return node
        for i in range(count):
            for axis in range(3):
                translation[i, axis] = moved[i, axis] + along[node] * drift[i, axis]
        x, y, z, radius = enclosing_ball(linear, translation, parent, letter, product, size, limit)
        largest = reach + abs(along[node]) * drift_reach
        if radius <= POINT * largest:
            set_whole(node, 0.0, state, gap, labels)
            continue
        view = View(x, y, z, along[node], radius, SLACK * max(radius, abs(x) + abs(y) + abs(z)) + ROUNDING * largest)
        state[node] = decide(desk, linear, areas, view, tolerance, labels[node])
        if state[node] == CONNECTED and not all_drawn:
            state[node] = decide_drawn(desk, linear, view, tolerance, labels[node])
        if state[node] == CONNECTED:
            set_whole(node, tolerance, state, gap, labels)
        elif with_gap:
            points = find_points(desk, linear, translation, view)
            low, high = measure_gap(tree, view, tolerance, points, labels[node].copy(), desk.search)
            gap[node, 0] = max(low / radius, SLACK) / 2 if state[node] == DISCONNECTED else 0.0
            gap[node, 1] = max(high / (2 * radius), tolerance, gap[node, 0])
    return nodes


@njit(nogil=True, cache=True)
def find_points(desk, linear, translation, view):
    """Points (P, 3) on the attractor, about the centre of the ball: the fixed points of the maps."""
    found = 0
    for i in range(linear.shape[0]):
        x, y, z, known = fixed_point(linear[i], translation[i, 0], translation[i, 1], translation[i, 2])
        if known:
            desk.points[found, 0], desk.points[found, 1], desk.points[found, 2] = x - view.x, y - view.y, z - view.z
            found += 1
    return desk.points[:found]


@njit(nogil=True, cache=True)
def decide_each(linear, translation, drawn, tolerance, with_gap):
    """Decide attractors of any maps, of which the attractorlets `drawn` (F, N) are; see `deciding.decide_frames`."""
    frames, count = linear.shape[0], linear.shape[1]
    state, gap = np.empty(frames, np.uint8), np.empty((frames, 2))
    labels = np.empty((frames, count), np.int64)
    desk = empty_desk(count)
    drift, along, zero = np.zeros((count, 3)), np.zeros(1), np.int64(0)
    for k in range(frames):
        here = slice(k, k + 1)
        desk.drawn[:] = drawn[k]
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
        for i in range(count):
            if not drawn[k, i]:
                labels[k, i] = -1
            elif state[k] == CONNECTED:
                labels[k, i] = drawn[k].argmax()
    return state, gap, labels
