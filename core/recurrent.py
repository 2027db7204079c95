"""Connectedness of recurrent IFSs, in which not every map may come after every other (Barnsley, Elton & Hardin 1989).

Their attractorlets are images of parts of the attractor, not of all of it. So it does not do that the attractorlets
hang together: each of them must. The same is true of any IFS some of whose attractorlets are not drawn.
"""

from __future__ import annotations

import numpy as np

from . import enclosure
from .enclosure import POINT, enclosing_disc, mean_fixed_point, move_origin, shrinking_words
from .gap import empty_search, measure_gap
from .kernels import njit
from .overlap import BUDGET, MEET, ROUNDING, SLACK, STACK, UNKNOWN, join
from .recurrent_overlap import letter_discs, pieces_meet
from .states import CONNECTED, DISCONNECTED, NO_ATTRACTOR, UNDECIDED
from .tree import CAPACITY, View, empty_tree, plant

MOST_VERTICES = 48
"""Parts that the attractorlets may fall into before the search is given up."""

FIRST_BUDGET = 256
"""Pairs of pieces looked at for a pair of attractorlets, `overlap.BUDGET` where those that meet do not join it."""

MOST_WORK = 12_000
"""Pairs of pieces looked at in all, after which what is not known is left open."""


@njit(nogil=True, cache=True)
def decide_recurrent(linear, translation, allowed, tolerance, with_gap):
    """States of what is drawn of recurrent IFSs; arguments and returns as `deciding.decide_frames`."""
    frames, count = linear.shape[0], linear.shape[1]
    state, gap = np.empty(frames, np.uint8), np.full((frames, 2), np.nan)
    labels = np.empty((frames, count), np.int64)
    moved = np.empty((count, 2))
    room = np.empty(STACK, np.int32), np.empty(STACK, np.int32), np.empty(STACK)
    tree = empty_tree(np.int64(CAPACITY))
    for frame in range(frames):
        follows, drawn = allowed[frame][:count], allowed[frame][count]
        for i in range(count):
            labels[frame, i] = i if drawn[i] else -1
        outcome, parent, letter, product, size, limit = shrinking_words(linear[frame], follows)
        if outcome != enclosure.COVERED:
            state[frame] = NO_ATTRACTOR if outcome == enclosure.NO_ATTRACTOR else UNDECIDED
            continue
        origin_x, origin_y = mean_fixed_point(linear[frame], translation[frame])
        move_origin(linear[frame], translation[frame], origin_x, origin_y, moved)
        x, y, radius = enclosing_disc(linear[frame], moved, parent, letter, product, size, limit)
        largest = abs(origin_x) + abs(origin_y)
        for i in range(count):
            largest = max(largest, abs(moved[i, 0]) + abs(moved[i, 1]))
        if radius <= POINT * largest:
            state[frame], gap[frame, 0], gap[frame, 1] = CONNECTED, 0.0, 0.0
        else:
            view = View(x, y, 0.0, radius, SLACK * max(radius, abs(x) + abs(y)) + ROUNDING * largest)
            state[frame], low, high = decide(
                tree, room, linear[frame], moved, follows, drawn, view, tolerance, with_gap, labels[frame]
            )
            if state[frame] == CONNECTED:
                gap[frame, 0], gap[frame, 1] = 0.0, tolerance
            elif with_gap:
                gap[frame, 0] = max(low / radius, SLACK) / 2 if state[frame] == DISCONNECTED else 0.0
                gap[frame, 1] = max(high / (2 * radius), tolerance, gap[frame, 0])
        if state[frame] == CONNECTED:
            for i in range(count):
                labels[frame, i] = drawn.argmax() if drawn[i] else -1
    return state, gap, labels


@njit(nogil=True, cache=True)
def decide(tree, room, linear, translation, follows, drawn, view, tolerance, with_gap, labels):
    """State of one attractor, and the bracket of its gap; `labels` (N,) as in `decision.decide`, -1 if not drawn.

    Attractorlet i is ``A_i = w_i(U A_k)`` over the letters k that may follow i. All of them are connected if, for each
    i, the overlap graph of those A_k is; and then what is drawn of A is, if the overlap graph of its A_i is. Where an
    A_i falls into parts, these take its place, each a letter of its own, and all is looked at again. The gap is that
    between attractorlets or such parts; within them there may be wider ones.
    """
    count = linear.shape[0]
    of = np.arange(count)
    allowed = follows.copy()
    while True:
        vertices = of.shape[0]
        own_linear, own_translation = np.empty((vertices, 4)), np.empty((vertices, 2))
        for v in range(vertices):
            for k in range(4):
                own_linear[v, k] = linear[of[v], k]
            for k in range(2):
                own_translation[v, k] = translation[of[v], k]
        plant(tree, own_linear, own_translation, np.zeros((vertices, 2)))
        discs = letter_discs(own_linear, own_translation, allowed, view)
        meets, known = np.full((vertices, vertices), UNKNOWN, np.int8), np.zeros((vertices, vertices), np.int64)
        tree.used[1] = 0
        group = np.arange(vertices)
        seen = drawn[of]
        sure = join_meeting(tree, room, allowed, discs, view, tolerance, meets, known, seen, group)
        pieces = 0
        for v in range(vertices):
            if not seen[v]:
                group[v] = -1
            pieces += group[v] == v
        if vertices == count:
            for i in range(count):
                labels[i] = group[i]
        if pieces > 1:
            if not sure:
                return UNDECIDED, 0.0, 2 * view.radius
            low = high = 0.0
            if with_gap:
                none, search = np.empty((0, 2)), empty_search(vertices)
                low, high = measure_gap(tree, allowed, view, tolerance, none, none, group, search)
            return DISCONNECTED, low, high
        parts = np.ones(vertices, np.int64)
        member = np.zeros((vertices, vertices), np.int64)
        for v in range(vertices):
            for k in range(vertices):
                group[k] = k
            if not join_meeting(tree, room, allowed, discs, view, tolerance, meets, known, allowed[v], group):
                return UNDECIDED, 0.0, 2 * view.radius
            parts[v] = 0
            for k in range(vertices):
                if allowed[v, k] and group[k] == k:
                    for other in range(vertices):
                        if allowed[v, other] and group[other] == k:
                            member[v, other] = parts[v]
                    parts[v] += 1
        total = parts.sum()
        if total == vertices:
            return CONNECTED, 0.0, 0.0
        if total > MOST_VERTICES:
            return UNDECIDED, 0.0, 2 * view.radius
        whole, part = np.empty(total, np.int64), np.empty(total, np.int64)
        at = 0
        for v in range(vertices):
            for p in range(parts[v]):
                whole[at], part[at] = v, p
                at += 1
        finer = np.zeros((total, total), np.bool_)
        for v in range(total):
            for k in range(total):
                finer[v, k] = allowed[whole[v], whole[k]] and member[whole[v], whole[k]] == part[v]
        of, allowed = of[whole], finer


@njit(nogil=True, cache=True)
def join_meeting(tree, room, follows, discs, view, tolerance, meets, known, among, group):
    """Join the groups (V,) of those `among` (V,) all letters whose pieces meet; whether nothing was left open.

    What is found of pairs is kept in `meets` (V, V), and in `known` (V, V) the budget that it was found with.
    """
    count = follows.shape[0]
    for budget in (FIRST_BUDGET, BUDGET):
        for i in range(count):
            for j in range(i + 1, count):
                if not (among[i] and among[j]) or group[i] == group[j]:
                    continue
                if known[i, j] < budget and tree.used[1] < MOST_WORK:
                    known[i, j] = budget
                    meets[i, j] = pieces_meet(tree, follows, discs, view, i, j, tolerance, budget, room)
                    if meets[i, j] != UNKNOWN:
                        known[i, j] = BUDGET
                if meets[i, j] == MEET:
                    join(group, i, j)
    for i in range(count):
        for j in range(i + 1, count):
            if among[i] and among[j] and group[i] != group[j] and meets[i, j] == UNKNOWN:
                return False
    return True
