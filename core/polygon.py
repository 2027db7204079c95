"""The outer polygon of an attractor: for each of evenly spaced directions, how far it can reach.

Where discs leave open whether two pieces meet, the images of the polygon often part them.
"""

from __future__ import annotations

import math

import numpy as np

from .kernels import njit
from .tree import A, B, C, D

STEPS = 100
"""Of the polygon's iteration at most; it gains a constant factor at each."""

ROUNDING = 1e-14
"""Of a reach, relative to the radius."""

SMALL = 1e-300
"""A squared length below this is none."""


@njit(nogil=True, cache=True)
def directions_seen(linear, directions):
    """How far an image of a polygon reaches, by the reaches of the polygon.

    A convex set that reaches ``h(n)`` in the direction n has an image under L that reaches ``h(L^T n)``. For
    ``L^T n = s n_m + t n_{m+1}`` between two neighbouring directions that is at most ``s h(n_m) + t h(n_{m+1})``, for
    a polygon of all directions exactly that.

    Parameters
    ----------
    linear : (N, 4)
    directions : int
        How many; direction k is at the angle 2 pi k / directions.

    Returns
    -------
    normal : (directions, 2)
    sector : (N, directions) int
        m of each map and direction.
    share : (N, directions, 2)
        s and t.
    """
    step = 2 * math.pi / directions
    normal = np.empty((directions, 2))
    for k in range(directions):
        normal[k, 0], normal[k, 1] = math.cos(step * k), math.sin(step * k)
    across = math.sin(step)
    sector = np.empty((linear.shape[0], directions), np.int64)
    share = np.empty((linear.shape[0], directions, 2))
    for i in range(linear.shape[0]):
        for k in range(directions):
            x = linear[i, 0] * normal[k, 0] + linear[i, 2] * normal[k, 1]
            y = linear[i, 1] * normal[k, 0] + linear[i, 3] * normal[k, 1]
            m = math.floor(math.atan2(y, x) / step) % directions
            n = (m + 1) % directions
            sector[i, k] = m
            share[i, k, 0] = max(0.0, (x * normal[n, 1] - y * normal[n, 0]) / across)
            share[i, k, 1] = max(0.0, (normal[m, 0] * y - normal[m, 1] * x) / across)
    return normal, sector, share


@njit(nogil=True, cache=True)
def shrink_polygon(normal, sector, share, translation, radius, rounding, tolerance, reach, corners):
    """Write the reaches of an attractor, and the corners between them.

    Starts at the disc about the origin and applies ``K <- K n outer(U w_i K)``; it is an enclosure at every step.

    Parameters
    ----------
    normal, sector, share
        From `directions_seen`.
    translation : (N, 2)
    radius : float
        Of a disc about the origin that holds the attractor.
    rounding : float
        Added to a reach at each step, times what it is made of: maps may enlarge an error before they shrink it.
    tolerance : float
        Stop when no reach changes by more than this.
    reach : (directions,)
        The largest ``<x, normal>``; written.
    corners : (directions, 2)
        Between direction k and k + 1; their hull holds the attractor. Written.
    """
    directions = normal.shape[0]
    for k in range(directions):
        reach[k] = radius
    for _ in range(STEPS):
        change = 0.0
        for k in range(directions):
            furthest = -np.inf
            for i in range(sector.shape[0]):
                m = sector[i, k]
                n = m + 1 if m + 1 < directions else 0
                offset = translation[i, 0] * normal[k, 0] + translation[i, 1] * normal[k, 1]
                s, t = share[i, k, 0], share[i, k, 1]
                furthest = max(furthest, s * reach[m] + t * reach[n] + offset + rounding * (1 + s + t))
            if furthest < reach[k]:
                change = max(change, reach[k] - furthest)
                reach[k] = furthest
        if change <= tolerance:
            break
    across = normal[0, 0] * normal[1, 1] - normal[0, 1] * normal[1, 0]
    for k in range(directions):
        n = k + 1 if k + 1 < directions else 0
        corners[k, 0] = (reach[k] * normal[n, 1] - reach[n] * normal[k, 1]) / across
        corners[k, 1] = (reach[n] * normal[k, 0] - reach[k] * normal[n, 0]) / across


@njit(nogil=True, cache=True)
def outer_polygon(linear, translation, radius, directions, tolerance):
    """Reaches (directions,) and corners (directions, 2) of one attractor; arguments as above."""
    reach, corners = np.empty(directions), np.empty((directions, 2))
    normal, sector, share = directions_seen(linear, directions)
    shrink_polygon(normal, sector, share, translation, radius, ROUNDING * radius, tolerance, reach, corners)
    return reach, corners


def recurrent_reach(linear, translation, allowed, radius, directions, tolerance):
    """Reaches (directions,) of what is drawn of any IFS: `shrink_polygon` with one for each attractorlet.

    Parameters
    ----------
    linear, translation : (N, 4), (N, 2)
    allowed : (N + 1, N) bool
        allowed[i, k]: whether the letter k may come after i, and in the last row whether it may come first.
    radius, directions, tolerance
        As above.
    """
    normal, sector, share = directions_seen(linear, directions)
    next_sector = (sector + 1) % directions
    offset = translation @ normal.T + ROUNDING * radius * (1 + share.sum(axis=-1))
    reach = np.full((len(linear), directions), float(radius))
    for _ in range(STEPS):
        inside = np.where(allowed[:-1, :, None], reach, -np.inf).max(axis=1)
        ends = np.take_along_axis(inside, sector, 1), np.take_along_axis(inside, next_sector, 1)
        shrunk = np.minimum(share[..., 0] * ends[0] + share[..., 1] * ends[1] + offset, reach)
        change = (reach - shrunk).max()
        reach = shrunk
        if change <= tolerance:
            break
    return reach[allowed[-1]].max(axis=0)


@njit(nogil=True, cache=True)
def furthest(corners, x, y):
    """Index of the corner that is furthest in a direction, and how far it is times the direction's length."""
    most, at = -np.inf, 0
    for k in range(corners.shape[0]):
        reach = x * corners[k, 0] + y * corners[k, 1]
        if reach > most:
            most, at = reach, k
    return at, most


@njit(nogil=True, cache=True)
def polygon_distance(word, one, other, apart_x, apart_y, corners, enough, steps):
    """Lower bound of the distance of the images of the outer polygon, by a few steps of Gilbert's algorithm (1966).

    The point (x, y) of the difference of the two polygons walks towards the origin; the line across its direction
    through the furthest corner parts the origin from all of the difference, or does not.

    Parameters
    ----------
    word : (W, 9)
        Words of a tree.
    one, other : int
        Places of two words.
    apart_x, apart_y : float
        From the centre of the one to that of the other.
    corners : (K, 2)
        About the centre of the attractor.
    enough : float
        Stop at a bound above this.
    steps : int

    Returns
    -------
    float
        Not above 0 where the polygons may meet.
    """
    a, b, c, d = word[one, A], word[one, B], word[one, C], word[one, D]
    p, q, r, s = word[other, A], word[other, B], word[other, C], word[other, D]
    x, y = apart_x, apart_y
    bound = -np.inf
    for _ in range(steps):
        length = math.sqrt(x * x + y * y)
        if length * length <= SMALL:
            break
        at_one, out = furthest(corners, a * x + c * y, b * x + d * y)
        at_other, back = furthest(corners, -p * x - r * y, -q * x - s * y)
        bound = max(bound, (x * apart_x + y * apart_y - out - back) / length)
        if bound > enough:
            break
        g, h = corners[at_other, 0], corners[at_other, 1]
        e, f = corners[at_one, 0], corners[at_one, 1]
        # Nearest point to the origin on the segment from (x, y) to the furthest corner of the difference.
        dx = apart_x + p * g + q * h - a * e - b * f - x
        dy = apart_y + r * g + s * h - c * e - d * f - y
        squared = dx * dx + dy * dy
        along = -(x * dx + y * dy)
        if squared <= SMALL or along <= 0:
            break
        along = min(along / squared, 1.0)
        x, y = x + along * dx, y + along * dy
    return bound
