"""Points of an attractor with fixed addresses: the same point is the same place of the shape all through a morph."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from . import parallel
from .enclosure import norm
from .ifs import IFS, IFSError
from .words import cumulated, grown, unit_maps

CHUNKS = 16

LEAST_SIZE = 1e-8
"""A word this small, relative to the attractor, is a single place, however many points it holds."""

RADIUS_RANGE = (1 / 64, 4.0)
"""Radii of points, as multiples of the spacing that as many would have if they filled the enclosing disc."""


class Points(NamedTuple):
    """Points of an attractor.

    Attributes
    ----------
    position : (count, 2) float32
    attractorlet : (count,) int32
        The map whose attractorlet the point belongs to.
    radius : (count,) float32
        Of a disc about as large as the piece of the attractor that the point stands for.
    """

    position: np.ndarray
    attractorlet: np.ndarray
    radius: np.ndarray


def point_cloud(ifs: IFS, count: int, address_weights: np.ndarray | None = None, threads: int | None = None) -> Points:
    """Spread points over an attractor by its weights.

    Point k stands for the number (k + 1/2) / count, whose place among the cumulated weights gives its first map, its
    place within that part the second, and so on: an arithmetic code. So its address depends on the weights and the
    count only, and the points lie as evenly as can be.

    Parameters
    ----------
    ifs : IFS
    count : int
    address_weights : (N,), optional
        By which the points are spread; by default the weights of `ifs`. Through a morph they must stay the same, or
        points would jump from map to map.
    threads : int, optional
        None for all processors; the result is the same to the byte.

    Raises
    ------
    IFSError
        If there is no attractor.
    ValueError
        If the count or the weights make no sense.
    """
    weights = ifs.weights if address_weights is None else np.asarray(address_weights, dtype=float)
    if count < 1:
        raise ValueError(f"A cloud of {count} points cannot be made; ask for one or more.")
    if weights.shape != (ifs.count,) or not (weights >= 0).all() or not 0 < weights.sum() < np.inf:
        raise ValueError(f"The address weights must be {ifs.count} numbers, none negative and not all zero.")
    maps, center, radius = unit_maps(ifs, least_radius=1e-12)
    home = (ifs.fixed_points[int(np.argmax(weights))] - center) / radius
    points = Points(np.empty((count, 2), np.float32), np.empty(count, np.int32), np.empty(count, np.float32))
    spacing = radius / math.sqrt(count)
    place = np.array([*center, radius, RADIUS_RANGE[0] * spacing, RADIUS_RANGE[1] * spacing])
    borders = cumulated(weights)
    edges = [count * chunk // CHUNKS for chunk in range(CHUNKS + 1)]

    def fill(chunk: int) -> None:
        fill_points(maps, borders, home, place, edges[chunk], edges[chunk + 1], *points)

    parallel.run(fill, range(CHUNKS), threads)
    if not np.isfinite(points.position).all():
        raise IFSError("The attractor lies too far out to be drawn; move its maps towards the origin.")
    return points


@njit(nogil=True, cache=True)
def fill_points(maps, borders, home, place, start, end, position, attractorlet, radii):
    """Points `start` to `end` of the arithmetic code, by a walk over all words that hold some of them.

    Parameters
    ----------
    maps : (N, 6)
        Rows a, b, e, c, d, f in coordinates in which the unit disc holds the attractor.
    borders : (N + 1,)
        Cumulated weights.
    home : (2,)
        The point of the attractor that words are applied to.
    place : (5,)
        Centre and radius of the disc that the unit disc stands for; least and largest radius of a point.
    start, end : int
    position, attractorlet, radii
        The arrays of `Points`, filled for these points.
    """
    count, total = maps.shape[0], position.shape[0]
    # A word: its map, the part of the points that it holds (from, to), and its first letter.
    stack, top = np.empty((64 + count, 9)), 1
    stack[0] = np.array([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, total, -1.0])
    while top > 0:
        top -= 1
        a, b, e = stack[top, 0], stack[top, 1], stack[top, 2]
        c, d, f = stack[top, 3], stack[top, 4], stack[top, 5]
        low, high, letter = stack[top, 6], stack[top, 7], stack[top, 8]
        first, last = max(math.ceil(low - 0.5), 0), min(math.ceil(high - 0.5), total)
        if last <= start or first >= end or last <= first:
            continue
        size = norm(a, b, c, d)
        if letter >= 0 and (last - first == 1 or size <= LEAST_SIZE):
            x = place[0] + place[2] * (a * home[0] + b * home[1] + e)
            y = place[1] + place[2] * (c * home[0] + d * home[1] + f)
            radius = min(max(place[2] * size, place[3]), place[4])
            for k in range(max(first, start), min(last, end)):
                position[k, 0], position[k, 1] = x, y
                attractorlet[k] = int(letter)
                radii[k] = radius
            continue
        if top + count > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + count)
        for i in range(count):
            p, q, r, s, t, u = maps[i, 0], maps[i, 1], maps[i, 2], maps[i, 3], maps[i, 4], maps[i, 5]
            stack[top, 0], stack[top, 1], stack[top, 2] = a * p + b * s, a * q + b * t, a * r + b * u + e
            stack[top, 3], stack[top, 4], stack[top, 5] = c * p + d * s, c * q + d * t, c * r + d * u + f
            stack[top, 6], stack[top, 7] = low + (high - low) * borders[i], low + (high - low) * borders[i + 1]
            stack[top, 8] = letter if letter >= 0 else i
            top += 1
