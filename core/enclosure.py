"""Where an attractor can be: words that shrink, and the disc that encloses it.

The kernels take maps as rows: `linear` (N, 4) holds a, b, c, d and `translation` (N, 2) holds e, f. A *word* is a
composition ``w_i w_j w_k ...``; the attractor is the union of its images under any set of words that has one prefix
of every infinite word, here called a *cover*.
"""

from __future__ import annotations

import math

import numpy as np

from .kernels import njit

COVERED, NO_ATTRACTOR, UNDECIDED = 0, 1, 2
"""Outcomes of `cover`."""

CONTRACTIVE_NORM = 0.9
"""Every word of norm at most this: the maps contract."""

CONTRACTIVITY_BUDGET = 20_000
"""Words looked at before contractivity is given up as undecided."""

SURE_NORM = 1 - 1e-9
"""Maps of norms up to this contract, however many words it takes to come down to `CONTRACTIVE_NORM`."""

TIGHT_NORM = 0.5
TIGHT_BUDGET = 600
"""Words of at most this norm give a disc at most (1 + 0.5) / (1 - 0.5) times too large, mostly far less."""

POINT = 1e-12
"""An attractor this small beside its distance from the origin is one point: what is left is rounding."""

SPECTRAL_SLACK = 1e-12
"""Rounding allowed when a spectral radius is compared with 1."""


@njit(nogil=True, cache=True)
def norm(a, b, c, d):
    """Largest singular value of [[a, b], [c, d]]."""
    turning = math.sqrt((a + d) * (a + d) + (c - b) * (c - b))
    mirroring = math.sqrt((a - d) * (a - d) + (b + c) * (b + c))
    return (turning + mirroring) / 2


@njit(nogil=True, cache=True)
def spectral_radius(a, b, c, d):
    """Largest absolute eigenvalue of [[a, b], [c, d]]."""
    half_trace, det = (a + d) / 2, a * d - b * c
    discriminant = half_trace * half_trace - det
    if discriminant >= 0:
        return abs(half_trace) + math.sqrt(discriminant)
    return math.sqrt(det)


@njit(nogil=True, cache=True)
def cover(linear, follows, limit, budget):
    """Words, shortest first, until every branch has one of norm at most `limit`.

    An attractor exists if and only if the joint spectral radius of the linear parts is below 1, that is, if every long
    enough word has a norm below 1 (Berger & Wang 1992). A word of spectral radius 1 or more rules it out.

    Parameters
    ----------
    linear : (N, 4)
    follows : (N, N) bool
        follows[i, k]: whether the letter k may come after i, which is inside.
    limit : float
        Below 1.
    budget : int
        Words looked at before giving up.

    Returns
    -------
    outcome : int
        COVERED, NO_ATTRACTOR or UNDECIDED.
    parent : (M,)
        Index of the word without its last letter, -1 for words of one letter.
    letter : (M,)
        The last letter.
    product : (M, 4)
        The word's linear part.
    size : (M,)
        Its norm. The words with ``size <= limit`` are the cover, the others lead to them.
    """
    count_maps = linear.shape[0]
    capacity = max(budget, count_maps)
    parent = np.empty(capacity, np.int32)
    letter = np.empty(capacity, np.int32)
    initial = np.empty(capacity, np.int32)
    product = np.empty((capacity, 4))
    size = np.empty(capacity)
    count, head, outcome = count_maps, 0, COVERED
    for i in range(count_maps):
        parent[i], letter[i], initial[i] = -1, i, i
        for k in range(4):
            product[i, k] = linear[i, k]
        size[i] = norm(linear[i, 0], linear[i, 1], linear[i, 2], linear[i, 3])
    while head < count:
        if size[head] > limit:
            a, b, c, d = product[head, 0], product[head, 1], product[head, 2], product[head, 3]
            # Only a word that may come after itself is applied again and again.
            if (
                size[head] >= 1 - SPECTRAL_SLACK
                and follows[letter[head], initial[head]]
                and spectral_radius(a, b, c, d) >= 1 - SPECTRAL_SLACK
            ):
                outcome = NO_ATTRACTOR
                break
            if count + count_maps > capacity:
                outcome = UNDECIDED
                break
            for i in range(count_maps):
                if not follows[letter[head], i]:
                    continue
                p, q, r, s = linear[i, 0], linear[i, 1], linear[i, 2], linear[i, 3]
                parent[count], letter[count], initial[count] = head, i, initial[head]
                product[count, 0], product[count, 1] = a * p + b * r, a * q + b * s
                product[count, 2], product[count, 3] = c * p + d * r, c * q + d * s
                size[count] = norm(product[count, 0], product[count, 1], product[count, 2], product[count, 3])
                count += 1
        head += 1
    return outcome, parent[:count], letter[:count], product[:count], size[:count]


@njit(nogil=True, cache=True)
def shrinking_words(linear, follows):
    """The words by which to enclose the attractor: a tight cover where that is short, else any cover.

    Returns
    -------
    As `cover`, and the norm that the words of the cover do not exceed.
    """
    # Whole numbers that are constants would be compiled in, and `cover` twice.
    outcome, parent, letter, product, size = cover(linear, follows, TIGHT_NORM, np.int64(TIGHT_BUDGET))
    if outcome != UNDECIDED:
        return outcome, parent, letter, product, size, TIGHT_NORM
    outcome, parent, letter, product, size = cover(linear, follows, CONTRACTIVE_NORM, np.int64(CONTRACTIVITY_BUDGET))
    largest = size[: linear.shape[0]].max()
    if outcome != UNDECIDED or largest > SURE_NORM:
        return outcome, parent, letter, product, size, CONTRACTIVE_NORM
    outcome, parent, letter, product, size = cover(linear, follows, largest, np.int64(linear.shape[0]))
    return outcome, parent, letter, product, size, largest


@njit(nogil=True, cache=True)
def mean_fixed_point(linear, translation):
    """Mean of the fixed points of those of the maps (N, 4), (N, 2) that have one."""
    x = y = 0.0
    count = 0
    for i in range(linear.shape[0]):
        a, b, c, d = 1 - linear[i, 0], -linear[i, 1], -linear[i, 2], 1 - linear[i, 3]
        det = a * d - b * c
        if abs(det) > SPECTRAL_SLACK:
            x += (d * translation[i, 0] - b * translation[i, 1]) / det
            y += (a * translation[i, 1] - c * translation[i, 0]) / det
            count += 1
    return x / max(count, 1), y / max(count, 1)


@njit(nogil=True, cache=True)
def move_origin(linear, translation, x, y, moved):
    """Write the translations (N, 2) that the maps have about the origin (x, y)."""
    for i in range(linear.shape[0]):
        moved[i, 0] = translation[i, 0] + linear[i, 0] * x + linear[i, 1] * y - x
        moved[i, 1] = translation[i, 1] + linear[i, 2] * x + linear[i, 3] * y - y


@njit(nogil=True, cache=True)
def enclosing_disc(linear, translation, parent, letter, product, size, limit):
    """A disc that holds the attractor, small but not always the smallest.

    About any centre c the radius ``max |w(c) - c| / (1 - norm(w))`` over the words of a cover is enough. The centre
    starts at the mean of the fixed points and steps towards the image that asks for the largest radius.

    Parameters
    ----------
    linear, translation : (N, 4), (N, 2)
    parent, letter, product, size, limit
        From `shrinking_words`.

    Returns
    -------
    x, y, radius : float
    """
    count = parent.shape[0]
    shift = np.empty((count, 2))
    for k in range(count):
        e, f = translation[letter[k], 0], translation[letter[k], 1]
        if parent[k] >= 0:
            m = product[parent[k]]
            shift[k, 0] = m[0] * e + m[1] * f + shift[parent[k], 0]
            shift[k, 1] = m[2] * e + m[3] * f + shift[parent[k], 1]
        else:
            shift[k, 0], shift[k, 1] = e, f
    x, y = mean_fixed_point(linear, translation)
    best_x, best_y, best = x, y, np.inf
    for step in range(12):
        worst, worst_x, worst_y = 0.0, 0.0, 0.0
        for k in range(count):
            if size[k] <= limit:
                dx = product[k, 0] * x + product[k, 1] * y + shift[k, 0] - x
                dy = product[k, 2] * x + product[k, 3] * y + shift[k, 1] - y
                radius = math.sqrt(dx * dx + dy * dy) / (1 - size[k])
                if radius > worst:
                    worst, worst_x, worst_y = radius, dx / (1 - size[k]), dy / (1 - size[k])
        if worst < best:
            best_x, best_y, best = x, y, worst
        x += worst_x / (step + 3)
        y += worst_y / (step + 3)
    return best_x, best_y, best * (1 + 1e-12)
