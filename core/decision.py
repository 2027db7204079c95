"""The state of an attractor, from its maps to a verdict: one kernel for a locus, a path or a single shape.

It puts together whether there is an attractor (`enclosure`), which attractorlets meet (`overlap`), and how far apart
the others are (`gap`).
"""

from __future__ import annotations

import numpy as np

from . import enclosure
from .enclosure import enclosing_disc, outer_polygon, shrinking_words
from .gap import measure_gap
from .kernels import njit
from .overlap import MEET, SLACK, UNKNOWN, distance, join, normalize, pair_test, set_piece, surely_one_piece

CONNECTED, DISCONNECTED, UNDECIDED, NO_ATTRACTOR = 0, 1, 2, 3
"""States of an attractor, the values of `connectedness.Connectedness`."""

POINT = 1e-12
"""An attractor this small beside its distance from the origin is one point: what is left is rounding."""

DISC_BUDGET = 256
POLYGON_BUDGET = 4000
"""Pairs of pieces looked at in the first stage, which knows discs only, and in the second."""

STACK = 4096
GAP_PAIRS = 6000
"""Pairs of pieces held at once by the pair test, and by the gap search beside those it starts with."""


@njit(nogil=True, cache=True)
def decide(linear, unit, areas, tolerance, labels, first, second, key):
    """State of one attractor, and in `labels` (N,) the component that each attractorlet is known to belong to.

    An attractor is connected if and only if the overlap graph of its attractorlets is (Hata 1985; Burch & Hart 1997,
    Theorem 2). Discs first; the outer polygon only for pairs that discs leave open.
    """
    count = linear.shape[0]
    for i in range(count):
        labels[i] = i
    if surely_one_piece(labels, areas):
        return CONNECTED
    pairs = count * (count - 1) // 2
    left, right = np.empty(pairs, np.int64), np.empty(pairs, np.int64)
    between = np.empty(pairs)
    pieces = np.empty((count, 7))
    for i in range(count):
        set_piece(linear, unit, i, pieces[i])
    known = 0
    for i in range(count):
        for j in range(i + 1, count):
            apart = distance(pieces[i], pieces[j]) - pieces[i, 6] - pieces[j, 6]
            if apart > SLACK:
                continue
            place = known
            while place > 0 and between[place - 1] > apart:
                between[place] = between[place - 1]
                left[place], right[place] = left[place - 1], right[place - 1]
                place -= 1
            between[place], left[place], right[place] = apart, i, j
            known += 1
    corners = np.empty((0, 2))
    for stage in range(2):
        if stage == 1:
            _, corners = outer_polygon(linear, unit, 1.0, enclosure.DIRECTIONS, 1e-3)
        still_open = 0
        for pair in range(known):
            i, j = left[pair], right[pair]
            if labels[i] == labels[j]:
                continue
            budget = DISC_BUDGET if stage == 0 else POLYGON_BUDGET
            outcome = pair_test(linear, unit, i, j, tolerance, corners, budget, first, second, key)
            if outcome == MEET:
                join(labels, min(labels[i], labels[j]), max(labels[i], labels[j]))
                if surely_one_piece(labels, areas):
                    return CONNECTED
            elif outcome == UNKNOWN:
                left[still_open], right[still_open] = i, j
                still_open += 1
        known = still_open
        if known == 0:
            return DISCONNECTED
    for pair in range(known):
        if labels[left[pair]] != labels[right[pair]]:
            return UNDECIDED
    return DISCONNECTED


@njit(nogil=True, cache=True)
def decide_column(linear, translations, tolerance, with_gap):
    """States of attractors that share their linear parts, as those of one u do.

    Parameters
    ----------
    linear : (N, 4)
    translations : (V, N, 2)
    tolerance : float
        Relative to the enclosing diameter.
    with_gap : bool
        Whether to measure the gaps.

    Returns
    -------
    state : (V,) uint8
    gap : (V, 2)
        Brackets relative to the enclosing diameter; NaN where there is no attractor or the gap was not asked for.
    labels : (V, N) int64
        Components of attractorlets that are known to meet.
    """
    nodes, count = translations.shape[0], linear.shape[0]
    state = np.empty(nodes, np.uint8)
    gap = np.full((nodes, 2), np.nan)
    labels = np.zeros((nodes, count), np.int64)
    outcome, parent, letter, product, size, limit = shrinking_words(linear)
    if outcome != enclosure.COVERED:
        state[:] = NO_ATTRACTOR if outcome == enclosure.NO_ATTRACTOR else UNDECIDED
        for i in range(count):
            labels[:, i] = i
        return state, gap, labels
    areas = np.abs(linear[:, 0] * linear[:, 3] - linear[:, 1] * linear[:, 2])
    if surely_one_piece(np.arange(count), areas):
        state[:] = CONNECTED
        gap[:] = 0.0
        return state, gap, labels
    room = GAP_PAIRS + count * (count - 1) // 2
    first, second = np.empty((room, 7)), np.empty((room, 7))
    ends, order = np.empty((room, 3), np.int64), np.empty(room, np.int64)
    key = np.empty(room)
    unit = np.empty((count, 2))
    scratch = np.empty(count, np.int64)
    for node in range(nodes):
        x, y, radius = enclosing_disc(linear, translations[node], parent, letter, product, size, limit)
        if radius <= POINT * (abs(x) + abs(y)):
            state[node], gap[node] = CONNECTED, 0.0
            continue
        normalize(linear, translations[node], x, y, radius, unit)
        state[node] = decide(linear, unit, areas, tolerance, labels[node], first[:STACK], second[:STACK], key)
        if state[node] == CONNECTED:
            labels[node] = 0
            gap[node, 0], gap[node, 1] = 0.0, tolerance
        elif with_gap:
            low, high = measure_gap(linear, unit, tolerance, scratch, first, second, ends, key, order)
            gap[node, 0] = max(low, SLACK) / 2 if state[node] == DISCONNECTED else 0.0
            gap[node, 1] = high / 2
    return state, gap, labels


def is_connected(linear: np.ndarray, translation: np.ndarray, tolerance: float) -> bool:
    """Whether the attractor of one set of maps, (N, 4) and (N, 2), is connected at the tolerance."""
    return decide_column(linear, translation[None], tolerance, False)[0][0] == CONNECTED
