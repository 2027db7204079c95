"""Points of an attractor with fixed addresses: when the maps move, every point moves along, and none jumps.

An *address* is a word that leads to a point. Point k of n has the number (k + 1/2) / n, and the weights part the unit
interval among the maps, each part again, and so on: the letters of the address are the parts that the number falls into
(arithmetic decoding). So the address depends on n and the weights alone.

A word whose part has come down to `FEW` points or less goes on with the address that its points have in a cloud of so
many. Such small clouds are made once for each number of points, and put under all words with as many. In a recurrent
IFS the parts depend on the letter before, so there is a small cloud for each number and state (`grammar`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from . import parallel
from .enclosure import norm
from .grammar import word_grammar
from .ifs import IFS
from .kernels import njit
from .space import cloud as space_cloud
from .space.ifs import SpaceIFS
from .words import FEW, IDENTITY, INVISIBLE, LETTER, STATE, grown, state_points, unit_maps

CHUNK = 200_000
"""Points for a thread at least, so that it is worth its while."""

RADIUS_RANGE = (1 / 16, 2.0)
"""Bounds of the radius of a point, relative to the one that would have all points just fill the enclosing disc."""

FIRST, COUNT = 6, 7
"""Columns of a table of words between those of the map and LETTER: the index of the first point, and their number."""


@dataclass(frozen=True)
class Points:
    """Points of an attractor.

    Attributes
    ----------
    position : (count, 2) or (count, 3) float32
    attractorlet : (count,) int32
        First letter of the address, the index of the map that the point's attractorlet is the image by.
    radius : (count,) float32
        About half the size of the piece of the attractor that the point stands for: small where points are dense.
    """

    position: np.ndarray
    attractorlet: np.ndarray
    radius: np.ndarray


def point_cloud(
    ifs: IFS,
    count: int,
    address_weights: np.ndarray | None = None,
    threads: int | None = None,
    placing: tuple[float, ...] | None = None,
    address_transitions: np.ndarray | None = None,
    address_opacity: np.ndarray | None = None,
) -> Points:
    """Points of an attractor, spread as the weights, transitions and opacities say; none in hidden attractorlets.

    Parameters
    ----------
    ifs : IFS
        Of the plane, or of space.
    count : int
    address_weights : (N,), optional
        Weights that give the addresses, those of `ifs` by default. Keep them the same all through an animation, and the
        points keep their addresses.
    threads : int, optional
        By default one for each processor. The result is the same to the byte.
    placing : (x, y, unit) or (x, y, z, unit), optional
        Put the points into a space of three dimensions, with its origin at a place of the plane or of space and the
        length 1 for so many units of it. Positions and radii are in that space; without z the third coordinate of a
        shape of the plane is zero.
    address_transitions : (N, N), optional
        Transitions that give the addresses, those of `ifs` by default. Points of addresses that `ifs` does not allow
        are not on its attractor.
    address_opacity : (N,), optional
        Opacities that give the addresses, those of `ifs` by default. Points in attractorlets that `ifs` hides are left
        out, and there are fewer than `count`.

    Raises
    ------
    IFSError
        If there is no attractor.
    ValueError
        If the count is negative, or weights or opacities are not N numbers, none negative and one positive.
    """
    count = int(count)
    if count < 0:
        raise ValueError(f"There cannot be {count} points.")
    weights = ifs.weights if address_weights is None else np.asarray(address_weights, dtype=float)
    opacity = ifs.opacity if address_opacity is None else np.asarray(address_opacity, dtype=float)
    for values, name in ((weights, "weights"), (opacity, "opacities")):
        if values.shape != (ifs.count,) or not (np.isfinite(values).all() and (values >= 0).all() and values.sum() > 0):
            raise ValueError(f"Address {name} must be {ifs.count} numbers, none negative and one positive.")
    opacity = None if (opacity == 1).all() else opacity
    if isinstance(ifs, SpaceIFS):
        return _drawn(ifs, _in_space(ifs, count, weights, opacity, threads, placing))
    maps, center, radius = unit_maps(ifs, least_radius=1e-30)
    dimensions = 2
    if placing is not None:
        x, y, *_, unit = placing
        center, radius, dimensions = (center - (x, y)) / unit, radius / unit, 3
    points = Points(np.empty((count, dimensions), np.float32), np.empty(count, np.int32), np.empty(count, np.float32))
    transitions = ifs.transitions if address_transitions is None else address_transitions
    grammar = word_grammar(weights, transitions, opacity)
    words = share_out(maps, grammar, count)
    # Every point is the image of one point of the attractor, for each state: the fixed point of the map with the most
    # weight, where maps follow each other freely.
    seeds = state_points(maps, grammar, grammar.shares.argmax(axis=1))
    start, small = small_clouds(maps, np.ascontiguousarray(ifs.norms), grammar, seeds, words)
    small = [np.ascontiguousarray(column) for column in small.T]
    bounds = np.float32(RADIUS_RANGE) * np.float32(radius / math.sqrt(max(count, 1)))
    found = points.position.reshape(-1), points.attractorlet, points.radius

    def chunk(rows: tuple[int, int]) -> None:
        place(words[slice(*rows)], start, *small, center, radius, bounds, dimensions, *found)

    _run(chunk, len(words), count, threads)
    return _drawn(ifs, points)


def _drawn(ifs: IFS, points: Points) -> Points:
    """Points without those in hidden attractorlets."""
    if ifs.drawn.all():
        return points
    kept = ifs.drawn[points.attractorlet]
    return Points(points.position[kept], points.attractorlet[kept], points.radius[kept])


def _run(chunk: Callable, words: int, count: int, threads: int | None) -> None:
    """Call `chunk` with the first and the last of some of the words, until all are done."""
    chunks = min(parallel.thread_count(threads), 1 + count // CHUNK)
    parallel.run(chunk, list(pairwise(np.linspace(0, words, chunks + 1).astype(int))), threads)


def _in_space(
    ifs: SpaceIFS,
    count: int,
    weights: np.ndarray,
    opacity: np.ndarray | None,
    threads: int | None,
    placing: tuple[float, ...] | None,
) -> Points:
    """`point_cloud` of a shape in space."""
    center, radius = ifs.enclosing_ball
    radius = max(radius, 1e-30)
    shift = (ifs.translation + ifs.linear @ center - center) / radius
    maps = np.concatenate([ifs.linear.reshape(-1, 9), shift], axis=1)
    if placing is not None:
        *origin, unit = placing
        center, radius = (center - origin) / unit, radius / unit
    points = Points(np.empty((count, 3), np.float32), np.empty(count, np.int32), np.empty(count, np.float32))
    grammar = word_grammar(weights, None, opacity)
    borders = grammar.borders[0]
    words = space_cloud.share_out(maps, grammar.borders[-1], borders, count)
    heaviest = int(np.argmax(weights))
    seed = np.linalg.solve(np.eye(3) - ifs.linear[heaviest], shift[heaviest])
    start, small = space_cloud.small_clouds(maps, np.ascontiguousarray(ifs.norms), borders, seed, words)
    small = [np.ascontiguousarray(column) for column in small.T]
    bounds = np.float32(RADIUS_RANGE) * np.float32(radius / max(count, 1) ** (1 / 3))
    found = points.position.reshape(-1), points.attractorlet, points.radius

    def chunk(rows: tuple[int, int]) -> None:
        space_cloud.place(words[slice(*rows)], start, *small, center, radius, bounds, *found)

    _run(chunk, len(words), count, threads)
    return points


@njit(nogil=True, cache=True)
def share_out(maps, grammar, count):
    """Words of one letter or more that share out the points from 0 to `count`, as a table (M, 10) in their order.

    Each has FEW points at most.
    """
    words, found = np.empty((256, 10)), 0
    # Columns of the stack: the map, the ends of the word's part of the interval from 0 to `count`, the first letter,
    # and the state after the last.
    stack, top = np.empty((64 + maps.shape[0], 10)), 1
    for k in range(6):
        stack[0, k] = IDENTITY[k]
    stack[0, 6], stack[0, 7], stack[0, 8], stack[0, STATE] = 0.0, count, -1.0, grammar.borders.shape[0] - 1
    while top > 0:
        top -= 1
        a, b, e = stack[top, 0], stack[top, 1], stack[top, 2]
        c, d, f = stack[top, 3], stack[top, 4], stack[top, 5]
        low, high, letter, state = stack[top, 6], stack[top, 7], stack[top, 8], int(stack[top, STATE])
        first, last = math.ceil(low - 0.5), math.ceil(high - 0.5)
        if first == last:
            continue
        if letter >= 0 and (last - first <= FEW or norm(a, b, c, d) < INVISIBLE):
            for start in range(first, last, FEW):
                if found == words.shape[0]:
                    words = grown(words, 2 * found)
                words[found, 0], words[found, 1], words[found, 2] = a, b, e
                words[found, 3], words[found, 4], words[found, 5] = c, d, f
                words[found, FIRST], words[found, COUNT] = start, min(FEW, last - start)
                words[found, LETTER], words[found, STATE] = letter, state
                found += 1
            continue
        if top + maps.shape[0] > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + maps.shape[0])
        right, borders = high, grammar.borders[state]
        for i in range(maps.shape[0] - 1, -1, -1):
            left = low + (high - low) * borders[i]
            p, q, r, s, t, u = maps[i, 0], maps[i, 1], maps[i, 2], maps[i, 3], maps[i, 4], maps[i, 5]
            stack[top, 0], stack[top, 1], stack[top, 2] = a * p + b * s, a * q + b * t, a * r + b * u + e
            stack[top, 3], stack[top, 4], stack[top, 5] = c * p + d * s, c * q + d * t, c * r + d * u + f
            stack[top, 6], stack[top, 7], stack[top, 8] = left, right, letter if letter >= 0 else i
            stack[top, STATE] = grammar.state[i]
            right = left
            top += 1
    return words[:found]


@njit(nogil=True, cache=True)
def small_clouds(maps, norms, grammar, seeds, words):
    """Clouds of as many points as the words have.

    Returns
    -------
    start : (S, FEW + 1) int64
        The cloud of n points of a state has the rows from start[state, n] on, if such a word has so many.
    points : (P, 3)
        x, y, and the radius, in units of the enclosing disc.
    """
    states = seeds.shape[0]
    start, end = np.full((states, FEW + 1), -1, np.int64), 0
    for w in range(words.shape[0]):
        count, state = int(words[w, COUNT]), int(words[w, STATE])
        if start[state, count] < 0:
            start[state, count] = end
            end += count
    points = np.empty((end, 3))
    stack = np.empty((256, 9))
    for state in range(states):
        for count in range(1, FEW + 1):
            first = start[state, count]
            if first >= 0:
                stack = _decode(maps, norms, grammar, seeds, state, count, points[first : first + count], stack)
    return start, points


@njit(nogil=True, cache=True)
def _decode(maps, norms, grammar, seeds, state, count, points, stack):
    """Fill in a cloud of `count` points, each at the end of the first word that is its alone. Returns the stack.

    A word that is down to one point takes it to where its last letter takes the seed of the state after it. The
    letter's norm stands for what the letter does to the word's size.
    """
    for k in range(6):
        stack[0, k] = IDENTITY[k]
    stack[0, 6], stack[0, 7], stack[0, 8] = 0.0, count, state
    top = 1
    while top > 0:
        top -= 1
        a, b, e = stack[top, 0], stack[top, 1], stack[top, 2]
        c, d, f = stack[top, 3], stack[top, 4], stack[top, 5]
        low, high, state = stack[top, 6], stack[top, 7], int(stack[top, 8])
        size = norm(a, b, c, d)
        if top + maps.shape[0] > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + maps.shape[0])
        right, borders = high, grammar.borders[state]
        for i in range(maps.shape[0] - 1, -1, -1):
            left = low + (high - low) * borders[i]
            first, last = math.ceil(left - 0.5), math.ceil(right - 0.5)
            if first < last:
                p, q, r, s, t, u = maps[i, 0], maps[i, 1], maps[i, 2], maps[i, 3], maps[i, 4], maps[i, 5]
                if last - first == 1 or size < INVISIBLE:
                    # A point stands for a part of length 1; area is taken to be spread as weight is.
                    seed_x, seed_y = seeds[grammar.state[i], 0], seeds[grammar.state[i], 1]
                    across, along = p * seed_x + q * seed_y + r, s * seed_x + t * seed_y + u
                    for k in range(first, last):
                        points[k, 0], points[k, 1] = a * across + b * along + e, c * across + d * along + f
                        points[k, 2] = size * norms[i] / math.sqrt(right - left)
                else:
                    stack[top, 0], stack[top, 1], stack[top, 2] = a * p + b * s, a * q + b * t, a * r + b * u + e
                    stack[top, 3], stack[top, 4], stack[top, 5] = c * p + d * s, c * q + d * t, c * r + d * u + f
                    stack[top, 6], stack[top, 7], stack[top, 8] = left, right, grammar.state[i]
                    top += 1
            right = left
    return stack


@njit(nogil=True, cache=True)
def place(words, start, x, y, size, center, radius, bounds, dimensions, position, attractorlet, radii):
    """Put the small clouds under the words; `position` is flat, with two or three `dimensions` for each point."""
    for w in range(words.shape[0]):
        a, b, e = radius * words[w, 0], radius * words[w, 1], radius * words[w, 2] + center[0]
        c, d, f = radius * words[w, 3], radius * words[w, 4], radius * words[w, 5] + center[1]
        first, count, letter = int(words[w, FIRST]), int(words[w, COUNT]), np.int32(words[w, LETTER])
        begin = start[int(words[w, STATE]), count]
        last, end = first + count, begin + count
        px, py = x[begin:end], y[begin:end]
        spot = position[first * dimensions : last * dimensions]
        if dimensions == 2:
            for k in range(count):
                spot[2 * k], spot[2 * k + 1] = a * px[k] + b * py[k] + e, c * px[k] + d * py[k] + f
        else:
            for k in range(count):
                spot[3 * k], spot[3 * k + 1] = a * px[k] + b * py[k] + e, c * px[k] + d * py[k] + f
                spot[3 * k + 2] = 0
        letters = attractorlet[first:last]
        for k in range(count):
            letters[k] = letter
        scale, sizes, reach = norm(a, b, c, d), size[begin:end], radii[first:last]
        for k in range(count):
            reach[k] = min(max(np.float32(scale * sizes[k]), bounds[0]), bounds[1])
