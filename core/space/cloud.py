"""Points of an attractor in space with fixed addresses: the kernels of `core.cloud` for maps of space.

Maps and words are rows of twelve numbers, the matrix row by row and then the translation, in coordinates in which the
unit ball holds the attractor.
"""

from __future__ import annotations

import math

import numpy as np

from ..kernels import njit
from ..words import FEW, INVISIBLE, grown
from .enclosure import norm

FIRST, COUNT, LETTER, COLUMNS = 12, 13, 14, 15
"""Columns of a table of words after those of the map: the index of the first point, their number, the first letter."""


@njit(nogil=True, cache=True)
def append(word, letter, longer):
    """Write the map (12,) of a word with one more letter."""
    for row in range(3):
        a, b, c = word[3 * row], word[3 * row + 1], word[3 * row + 2]
        for column in range(3):
            longer[3 * row + column] = a * letter[column] + b * letter[3 + column] + c * letter[6 + column]
        longer[9 + row] = a * letter[9] + b * letter[10] + c * letter[11] + word[9 + row]


@njit(nogil=True, cache=True)
def empty_word(word):
    """Write the map (12,) of the word without letters."""
    for k in range(12):
        word[k] = 1.0 if k in (0, 4, 8) else 0.0


@njit(nogil=True, cache=True)
def share_out(maps, first_borders, borders, count):
    """Words of one letter or more that share out the points from 0 to `count`, as a table (M, 15) in their order.

    Each has FEW points at most. The parts of first letters have borders of their own.
    """
    words, found = np.empty((256, COLUMNS)), 0
    # Columns 12 and 13 of the stack are the ends of the word's part of the interval from 0 to `count`.
    stack, top = np.empty((64 + maps.shape[0], COLUMNS)), 1
    word = np.empty(COLUMNS)
    empty_word(stack[0])
    stack[0, FIRST], stack[0, COUNT], stack[0, LETTER] = 0.0, count, -1.0
    while top > 0:
        top -= 1
        word[:] = stack[top]
        low, high, letter = word[FIRST], word[COUNT], word[LETTER]
        first, last = math.ceil(low - 0.5), math.ceil(high - 0.5)
        if first == last:
            continue
        if letter >= 0 and (last - first <= FEW or norm(word) < INVISIBLE):
            for start in range(first, last, FEW):
                if found == words.shape[0]:
                    words = grown(words, 2 * found)
                words[found] = word
                words[found, FIRST], words[found, COUNT] = start, min(FEW, last - start)
                found += 1
            continue
        if top + maps.shape[0] > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + maps.shape[0])
        right, parts = high, borders if letter >= 0 else first_borders
        for i in range(maps.shape[0] - 1, -1, -1):
            left = low + (high - low) * parts[i]
            append(word, maps[i], stack[top])
            stack[top, FIRST], stack[top, COUNT] = left, right
            stack[top, LETTER] = letter if letter >= 0 else i
            right = left
            top += 1
    return words[:found]


@njit(nogil=True, cache=True)
def small_clouds(maps, norms, borders, seed, words):
    """Clouds of as many points as the words have.

    Returns
    -------
    start : (FEW + 1,) int64
        The cloud of n points has the rows from start[n] on, if a word has so many.
    points : (P, 4)
        x, y, z, and the radius, in units of the enclosing ball.
    """
    start, end = np.full(FEW + 1, -1, np.int64), 0
    for w in range(words.shape[0]):
        count = int(words[w, COUNT])
        if start[count] < 0:
            start[count] = end
            end += count
    points = np.empty((end, 4))
    stack = np.empty((256, COLUMNS))
    for count in range(1, FEW + 1):
        if start[count] >= 0:
            stack = _decode(maps, norms, borders, seed, count, points[start[count] : start[count] + count], stack)
    return start, points


@njit(nogil=True, cache=True)
def _decode(maps, norms, borders, seed, count, points, stack):
    """Fill in a cloud of `count` points, each at the end of the first word that is its alone. Returns the stack."""
    word, longer = np.empty(COLUMNS), np.empty(12)
    empty_word(stack[0])
    stack[0, FIRST], stack[0, COUNT] = 0.0, count
    top = 1
    while top > 0:
        top -= 1
        word[:] = stack[top]
        low, high, size = word[FIRST], word[COUNT], norm(word)
        if top + maps.shape[0] > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + maps.shape[0])
        right = high
        for i in range(maps.shape[0] - 1, -1, -1):
            left = low + (high - low) * borders[i]
            first, last = math.ceil(left - 0.5), math.ceil(right - 0.5)
            if first < last:
                append(word, maps[i], longer)
                if last - first == 1 or size < INVISIBLE:
                    # A point stands for a part of length 1; volume is taken to be spread as weight is.
                    radius = size * norms[i] / math.pow(right - left, 1 / 3)
                    for k in range(first, last):
                        for row in range(3):
                            m = longer[3 * row : 3 * row + 3]
                            points[k, row] = m[0] * seed[0] + m[1] * seed[1] + m[2] * seed[2] + longer[9 + row]
                        points[k, 3] = radius
                else:
                    stack[top, :12] = longer
                    stack[top, FIRST], stack[top, COUNT] = left, right
                    top += 1
            right = left
    return stack


@njit(nogil=True, cache=True)
def place(words, start, x, y, z, size, center, radius, bounds, position, attractorlet, radii):
    """Put the small clouds under the words; `position` is flat, with three numbers for each point."""
    m = np.empty(12)
    for w in range(words.shape[0]):
        for k in range(12):
            m[k] = radius * words[w, k]
        a, b, c, d, e, f, g, h, i = m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8]
        at_x, at_y, at_z = m[9] + center[0], m[10] + center[1], m[11] + center[2]
        first, count, letter = int(words[w, FIRST]), int(words[w, COUNT]), np.int32(words[w, LETTER])
        begin = start[count]
        last, end = first + count, begin + count
        px, py, pz = x[begin:end], y[begin:end], z[begin:end]
        spot = position[3 * first : 3 * last]
        for k in range(count):
            spot[3 * k] = a * px[k] + b * py[k] + c * pz[k] + at_x
            spot[3 * k + 1] = d * px[k] + e * py[k] + f * pz[k] + at_y
            spot[3 * k + 2] = g * px[k] + h * py[k] + i * pz[k] + at_z
        letters, reach, sizes = attractorlet[first:last], radii[first:last], size[begin:end]
        scale = norm(m)
        for k in range(count):
            letters[k] = letter
            reach[k] = min(max(np.float32(scale * sizes[k]), bounds[0]), bounds[1])
