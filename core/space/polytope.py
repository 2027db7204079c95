"""The outer polytope of an attractor in space: how far it can reach along the axes and the diagonals of a cube.

Where balls leave open whether two pieces meet, the images of the polytope often part them (see `core.polygon`).
"""

from __future__ import annotations

import math

import numpy as np

from ..kernels import njit

DIRECTIONS = 27
"""Of all vectors of -1, 0 and 1, that of zeros in the middle: (x, y, z) has the place ``MIDDLE + 9 x + 3 y + z``."""

MIDDLE = 13

STEPS = 60
"""Of the polytope's iteration at most; it gains a constant factor at each."""


@njit(nogil=True, cache=True)
def corner(reaches, x, y, z):
    """The corner of a polytope with the reaches (27,) that lies furthest in the direction (x, y, z).

    Between the three neighbouring directions that are a single axis, two, and all three, from the largest component of
    the vector to the smallest. No point of what the polytope encloses lies further.
    """
    a, b, c = abs(x), abs(y), abs(z)
    i, j, k = 9 if x >= 0 else -9, 3 if y >= 0 else -3, 1 if z >= 0 else -1
    if a < b:
        a, b, i, j = b, a, j, i
    if b < c:
        b, c, j, k = c, b, k, j
    if a < b:
        a, b, i, j = b, a, j, i
    one = reaches[MIDDLE + i]
    two = reaches[MIDDLE + i + j]
    three = reaches[MIDDLE + i + j + k]
    p = q = r = 0.0
    for step, along in ((i, one), (j, two - one), (k, three - two)):
        if abs(step) == 9:
            p = along if step > 0 else -along
        elif abs(step) == 3:
            q = along if step > 0 else -along
        else:
            r = along if step > 0 else -along
    return p, q, r


@njit(nogil=True, cache=True)
def shrink_polytope(linear, translation, radius, rounding, tolerance, reaches):
    """Write the reaches (27,) of an attractor.

    Starts at the ball about the origin and applies ``K <- K n outer(U w_i K)``; it is an enclosure at every step.

    Parameters
    ----------
    linear, translation : (N, 9), (N, 3)
    radius : float
        Of a ball about the origin that holds the attractor.
    rounding : float
        Added to a reach at each step, times what it is made of.
    tolerance : float
        Stop when no reach changes by more than this.
    reaches : (27,)
        The largest ``<x, direction>`` for each direction; written.
    """
    for place in range(DIRECTIONS):
        x, y, z = place // 9 - 1, place // 3 % 3 - 1, place % 3 - 1
        reaches[place] = radius * math.sqrt(x * x + y * y + z * z)
    for _ in range(STEPS):
        change = 0.0
        for place in range(DIRECTIONS):
            if place == MIDDLE:
                continue
            x, y, z = place // 9 - 1, place // 3 % 3 - 1, place % 3 - 1
            furthest = -np.inf
            for i in range(linear.shape[0]):
                m = linear[i]
                a, b, c = m[0] * x + m[3] * y + m[6] * z, m[1] * x + m[4] * y + m[7] * z, m[2] * x + m[5] * y + m[8] * z
                p, q, r = corner(reaches, a, b, c)
                inside = a * p + b * q + c * r + rounding * (1 + abs(a) + abs(b) + abs(c))
                furthest = max(furthest, inside + x * translation[i, 0] + y * translation[i, 1] + z * translation[i, 2])
            if furthest < reaches[place]:
                change = max(change, reaches[place] - furthest)
                reaches[place] = furthest
        if change <= tolerance:
            break
