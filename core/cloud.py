"""Points of an attractor with fixed addresses: when the maps move, every point moves along, and none jumps.

An *address* is a word that leads to a point. Point k of n has the number (k + 1/2) / n, and the weights part the unit
interval among the maps, each part again, and so on: the letters of the address are the parts that the number falls into
(arithmetic decoding). So the address depends on n and the weights alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numba import njit

from . import parallel
from .enclosure import norm
from .ifs import IFS
from .words import IDENTITY, cumulated, grown, unit_maps

CHUNK = 1 << 15
"""Points of a chunk at least, so that threads are worth their while."""

RADIUS_RANGE = (1 / 16, 2.0)
"""Bounds of the radius of a point, relative to the one that would have all points just fill the enclosing disc."""

INVISIBLE = 1e-9
"""A word of this size relative to the attractor is a point, even if several addresses start with it."""


@dataclass(frozen=True)
class Points:
    """Points of an attractor.

    Attributes
    ----------
    position : (count, 2) float32
    attractorlet : (count,) int32
        First letter of the address, the index of the map that the point's attractorlet is the image by.
    radius : (count,) float32
        Half the size of the piece of the attractor that the point stands for: small where points are dense. The norm
        of the piece's word, its last letter apart from the others, scaled by the square root of the piece's share.
    """

    position: np.ndarray
    attractorlet: np.ndarray
    radius: np.ndarray


def point_cloud(ifs: IFS, count: int, address_weights: np.ndarray | None = None, threads: int | None = None) -> Points:
    """Points of an attractor, spread by the weights.

    Parameters
    ----------
    ifs : IFS
    count : int
    address_weights : (N,), optional
        Weights that give the addresses, those of `ifs` by default. Keep them the same all through an animation, and the
        points keep their addresses.
    threads : int, optional
        By default one for each processor. The result is the same to the byte.

    Raises
    ------
    IFSError
        If there is no attractor.
    ValueError
        If the count is negative, or the weights are not N numbers, none negative and one positive.
    """
    count = int(count)
    if count < 0:
        raise ValueError(f"There cannot be {count} points.")
    weights = ifs.weights if address_weights is None else np.asarray(address_weights, dtype=float)
    if weights.shape != (ifs.count,) or not (np.isfinite(weights).all() and (weights >= 0).all() and weights.sum() > 0):
        raise ValueError(f"Address weights must be {ifs.count} numbers, none negative and one positive.")
    maps, center, radius = unit_maps(ifs, least_radius=1e-30)
    # Every point is the image of one point of the attractor: the fixed point of the map with the most weight.
    a, b, e, c, d, f = maps[np.argmax(weights)]
    seed = np.linalg.solve([[1 - a, -b], [-c, 1 - d]], [e, f])
    seeds = maps.reshape(-1, 2, 3) @ [*seed, 1.0]
    borders = cumulated(weights)
    points = Points(np.empty((count, 2), np.float32), np.empty(count, np.int32), np.empty(count, np.float32))
    norms = np.ascontiguousarray(ifs.norms)
    bounds = np.array(RADIUS_RANGE) * radius / math.sqrt(max(count, 1))

    def chunk(ends: tuple[int, int]) -> None:
        found = points.position, points.attractorlet, points.radius
        decode(maps, norms, seeds, borders, center, radius, bounds, count, *ends, *found)

    chunks = min(parallel.thread_count(threads), count // CHUNK + 1)
    parallel.run(chunk, list(pairwise(np.linspace(0, count, chunks + 1).astype(np.int64))), threads)
    return points


@njit(nogil=True, cache=True)
def decode(maps, norms, seeds, borders, center, radius, bounds, count, begin, end, position, attractorlet, radii):
    """Find the points from `begin` to `end` (exclusive) of `count`.

    Takes the words depth first, each with its part of the interval from 0 to `count`, and leaves out those whose parts
    hold none of the points k + 1/2 asked for. So words that several addresses start with are composed only once. A word
    that is down to one point takes it to where its last letter i takes the seed, `seeds[i]`.
    """
    # Columns: the map, the ends of the part, the first letter.
    stack, top = np.empty((256, 9)), 1
    for k in range(6):
        stack[0, k] = IDENTITY[k]
    stack[0, 6], stack[0, 7], stack[0, 8] = 0.0, count, -1.0
    while top > 0:
        top -= 1
        a, b, e = stack[top, 0], stack[top, 1], stack[top, 2]
        c, d, f = stack[top, 3], stack[top, 4], stack[top, 5]
        low, high, letter = stack[top, 6], stack[top, 7], stack[top, 8]
        size = norm(a, b, c, d)
        if top + maps.shape[0] > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + maps.shape[0])
        left = low
        for i in range(maps.shape[0]):
            right = low + (high - low) * borders[i + 1] if i + 1 < maps.shape[0] else high
            first, last = math.ceil(left - 0.5), math.ceil(right - 0.5)
            start = letter if letter >= 0 else i
            if last - first == 1 or (last > first and size < INVISIBLE):
                # A point stands for a part of length 1; area is taken to be spread as weight is.
                around = radius * size * norms[i] / math.sqrt(right - left)
                for k in range(max(first, begin), min(last, end)):
                    position[k, 0] = center[0] + radius * (a * seeds[i, 0] + b * seeds[i, 1] + e)
                    position[k, 1] = center[1] + radius * (c * seeds[i, 0] + d * seeds[i, 1] + f)
                    attractorlet[k] = np.int32(start)
                    radii[k] = min(max(around, bounds[0]), bounds[1])
            elif first < last and first < end and last > begin:
                p, q, r, s, t, u = maps[i, 0], maps[i, 1], maps[i, 2], maps[i, 3], maps[i, 4], maps[i, 5]
                stack[top, 0], stack[top, 1], stack[top, 2] = a * p + b * s, a * q + b * t, a * r + b * u + e
                stack[top, 3], stack[top, 4], stack[top, 5] = c * p + d * s, c * q + d * t, c * r + d * u + f
                stack[top, 6], stack[top, 7], stack[top, 8] = left, right, start
                top += 1
            left = right
