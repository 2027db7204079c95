"""Where an attractor in space can be: words that shrink, and the ball that encloses it (see `core.enclosure`).

The kernels take maps as rows: `linear` (N, 9) holds the matrices row by row, `translation` (N, 3) the translations.
"""

from __future__ import annotations

import math

import numpy as np

from ..enclosure import (
    CONTRACTIVE_NORM,
    CONTRACTIVITY_BUDGET,
    COVERED,
    NO_ATTRACTOR,
    SURE_NORM,
    TIGHT_BUDGET,
    TIGHT_NORM,
    UNDECIDED,
)
from ..kernels import njit

SPECTRAL_SLACK = 1e-9
"""How far below 1 a spectral radius may be that is taken for 1."""

SQUARINGS = 32
"""After so many, the bounds of `grows` are this close to the spectral radius: ``3 ** -(2 ** -32)``."""

NORM_SLACK = 4e-8
"""Twice the error that the rounding of a cosine can make in `norm`, the arc cosine being steep at its ends."""


@njit(nogil=True, cache=True)
def norm(m):
    """Upper bound of the largest singular value of a matrix (9,): exact for similarities, to 1e-7 for the others.

    The largest eigenvalue of ``m^T m`` by the trigonometric solution of its cubic, rounded up.
    """
    xx = m[0] * m[0] + m[3] * m[3] + m[6] * m[6]
    yy = m[1] * m[1] + m[4] * m[4] + m[7] * m[7]
    zz = m[2] * m[2] + m[5] * m[5] + m[8] * m[8]
    xy = m[0] * m[1] + m[3] * m[4] + m[6] * m[7]
    xz = m[0] * m[2] + m[3] * m[5] + m[6] * m[8]
    yz = m[1] * m[2] + m[4] * m[5] + m[7] * m[8]
    mean = (xx + yy + zz) / 3
    xx, yy, zz = xx - mean, yy - mean, zz - mean
    spread = math.sqrt((xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)) / 6)
    # All eigenvalues are the mean where there is no spread, or one of rounding only.
    if spread <= 1e-15 * mean:
        return math.sqrt(mean + 2 * spread)
    det = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    cosine = math.cos(math.acos(min(max(det / (2 * spread * spread * spread), -1.0), 1.0)) / 3)
    return math.sqrt(mean + 2 * spread * min(1.0, cosine + NORM_SLACK * math.sqrt(mean / spread)))


@njit(nogil=True, cache=True)
def multiply(one, other, product):
    """Write the product of two matrices (9,) into a third array."""
    for row in range(0, 9, 3):
        for column in range(3):
            product[row + column] = (
                one[row] * other[column] + one[row + 1] * other[3 + column] + one[row + 2] * other[6 + column]
            )


@njit(nogil=True, cache=True)
def determinant(m):
    """Determinant of a matrix (9,)."""
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6])


@njit(nogil=True, cache=True)
def grows(matrix):
    """Whether the spectral radius of a matrix (9,) is 1 or more.

    The coefficients of the characteristic polynomial bound it from below, a sum of at most three products of
    eigenvalues each; those of powers bound it ever closer.
    """
    m, square = matrix.copy(), np.empty(9)
    logarithm, power = 0.0, 1.0
    for _ in range(SQUARINGS):
        size = np.abs(m).max()
        if size == 0:
            return False
        for k in range(9):
            m[k] /= size
        logarithm += math.log(size)
        minors = m[0] * m[4] - m[1] * m[3] + m[0] * m[8] - m[2] * m[6] + m[4] * m[8] - m[5] * m[7]
        least = max(abs(m[0] + m[4] + m[8]) / 3, math.sqrt(abs(minors) / 3), math.pow(abs(determinant(m)), 1 / 3))
        if least > 0 and logarithm + math.log(least) >= -SPECTRAL_SLACK * power:
            return True
        multiply(m, m, square)
        m[:] = square
        logarithm *= 2
        power *= 2
    return False


@njit(nogil=True, cache=True)
def cover(linear, limit, budget):
    """Words, shortest first, until every branch has one of norm at most `limit`; as `core.enclosure.cover`.

    Returns
    -------
    outcome : int
        COVERED, NO_ATTRACTOR or UNDECIDED.
    parent, letter : (M,)
        Index of the word without its last letter, -1 for words of one letter; and the last letter.
    product : (M, 9)
        The word's linear part.
    size : (M,)
        Its norm.
    """
    count_maps = linear.shape[0]
    capacity = max(budget, count_maps)
    parent, letter = np.empty(capacity, np.int32), np.empty(capacity, np.int32)
    product, size = np.empty((capacity, 9)), np.empty(capacity)
    count, head, outcome = count_maps, 0, COVERED
    for i in range(count_maps):
        parent[i], letter[i] = -1, i
        product[i] = linear[i]
        size[i] = norm(linear[i])
    while head < count:
        if size[head] > limit:
            if size[head] >= 1 - SPECTRAL_SLACK and grows(product[head]):
                outcome = NO_ATTRACTOR
                break
            if count + count_maps > capacity:
                outcome = UNDECIDED
                break
            for i in range(count_maps):
                parent[count], letter[count] = head, i
                multiply(product[head], linear[i], product[count])
                size[count] = norm(product[count])
                count += 1
        head += 1
    return outcome, parent[:count], letter[:count], product[:count], size[:count]


@njit(nogil=True, cache=True)
def shrinking_words(linear):
    """The words by which to enclose the attractor: a tight cover where that is short, else any cover.

    Returns
    -------
    As `cover`, and the norm that the words of the cover do not exceed.
    """
    outcome, parent, letter, product, size = cover(linear, TIGHT_NORM, np.int64(TIGHT_BUDGET))
    if outcome != UNDECIDED:
        return outcome, parent, letter, product, size, TIGHT_NORM
    outcome, parent, letter, product, size = cover(linear, CONTRACTIVE_NORM, np.int64(CONTRACTIVITY_BUDGET))
    largest = size[: linear.shape[0]].max()
    if outcome != UNDECIDED or largest > SURE_NORM:
        return outcome, parent, letter, product, size, CONTRACTIVE_NORM
    outcome, parent, letter, product, size = cover(linear, largest, np.int64(linear.shape[0]))
    return outcome, parent, letter, product, size, largest


@njit(nogil=True, cache=True)
def fixed_point(m, e, f, g):
    """The point that a map (9,) with the translation e, f, g leaves where it is, and whether there is just one."""
    n = np.empty(9)
    for k in range(9):
        n[k] = -m[k]
    n[0], n[4], n[8] = 1 - m[0], 1 - m[4], 1 - m[8]
    det = determinant(n)
    if abs(det) <= 1e-12:
        return 0.0, 0.0, 0.0, False
    x = e * (n[4] * n[8] - n[5] * n[7]) - n[1] * (f * n[8] - n[5] * g) + n[2] * (f * n[7] - n[4] * g)
    y = n[0] * (f * n[8] - n[5] * g) - e * (n[3] * n[8] - n[5] * n[6]) + n[2] * (n[3] * g - f * n[6])
    z = n[0] * (n[4] * g - f * n[7]) - n[1] * (n[3] * g - f * n[6]) + e * (n[3] * n[7] - n[4] * n[6])
    return x / det, y / det, z / det, True


@njit(nogil=True, cache=True)
def mean_fixed_point(linear, translation):
    """Mean of the fixed points of those of the maps (N, 9), (N, 3) that have one."""
    x = y = z = 0.0
    count = 0
    for i in range(linear.shape[0]):
        p, q, r, known = fixed_point(linear[i], translation[i, 0], translation[i, 1], translation[i, 2])
        if known:
            x, y, z = x + p, y + q, z + r
            count += 1
    count = max(count, 1)
    return x / count, y / count, z / count


@njit(nogil=True, cache=True)
def enclosing_ball(linear, translation, parent, letter, product, size, limit):
    """A ball that holds the attractor, small but not always the smallest; as `core.enclosure.enclosing_disc`.

    Parameters
    ----------
    linear, translation : (N, 9), (N, 3)
    parent, letter, product, size, limit
        From `shrinking_words`.

    Returns
    -------
    x, y, z, radius : float
    """
    count = parent.shape[0]
    shift = np.empty((count, 3))
    for k in range(count):
        e, f, g = translation[letter[k], 0], translation[letter[k], 1], translation[letter[k], 2]
        if parent[k] >= 0:
            m = product[parent[k]]
            for row in range(3):
                shift[k, row] = m[3 * row] * e + m[3 * row + 1] * f + m[3 * row + 2] * g + shift[parent[k], row]
        else:
            shift[k, 0], shift[k, 1], shift[k, 2] = e, f, g
    x, y, z = mean_fixed_point(linear, translation)
    best_x, best_y, best_z, best = x, y, z, np.inf
    for step in range(12):
        worst, worst_x, worst_y, worst_z = 0.0, 0.0, 0.0, 0.0
        for k in range(count):
            if size[k] <= limit:
                m = product[k]
                dx = m[0] * x + m[1] * y + m[2] * z + shift[k, 0] - x
                dy = m[3] * x + m[4] * y + m[5] * z + shift[k, 1] - y
                dz = m[6] * x + m[7] * y + m[8] * z + shift[k, 2] - z
                room = 1 - size[k]
                radius = math.sqrt(dx * dx + dy * dy + dz * dz) / room
                if radius > worst:
                    worst, worst_x, worst_y, worst_z = radius, dx / room, dy / room, dz / room
        if worst < best:
            best_x, best_y, best_z, best = x, y, z, worst
        x += worst_x / (step + 3)
        y += worst_y / (step + 3)
        z += worst_z / (step + 3)
    return best_x, best_y, best_z, best * (1 + 1e-12)
