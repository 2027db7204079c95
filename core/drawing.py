"""Sets of points under words, into pixels: kernels, and the strips of rows that threads share out.

Each strip draws all that falls into its rows, so that no two threads write to the same pixel and the result is the same
for any number of strips. The arithmetic is that of 32 bit floats, in pixels: good to a few thousandths of a pixel.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from . import parallel
from .kernels import njit
from .pieces import PointSets
from .words import MASS

NONE, SOME, ALL = 0, 1, 2
"""How many points of a word show."""

POINT_MASS = 2**22
"""Units of mass of a set of points."""

STRIP_POINTS = 1_000_000
"""Points that a strip has at least, so that a thread is worth its while."""

ROUNDING = 0.25
"""A word that is inside the strip by this many pixels has all its points inside, rounding included."""


def mark(canvas: np.ndarray, words: np.ndarray, labels: np.ndarray, sets: PointSets, threads: int | None) -> None:
    """Write the label of each word into the pixels that it touches, later words over earlier ones.

    Parameters
    ----------
    canvas : (height, width) uint8
        Written to.
    words : (M, 10)
        In pixels, see `words.cut_words`.
    labels : (M,) uint8
    sets : PointSets
        `pieces.outlines`.
    threads : int, optional
    """
    nearest, room = sets.nearest(words), np.diff(sets.start).max()
    pixels, width = canvas.reshape(-1), canvas.shape[1]

    def strip(rows: tuple[int, int]) -> None:
        draw_marks(pixels, width, words, labels, nearest, sets.start, room, sets.x, sets.y, *rows)

    parallel.run(strip, _strips(canvas, words, nearest, sets, threads), threads)


def deposit(canvas: np.ndarray, words: np.ndarray, sets: PointSets, threads: int | None) -> None:
    """Add the mass of each word to the pixels that it covers.

    Parameters
    ----------
    canvas : (height, width) int64
        Added to; a word of mass m in a cut adds ``m * POINT_MASS`` units.
    words : (M, 10)
        In pixels, see `words.cut_words`.
    sets : PointSets
        `pieces.measures`.
    threads : int, optional
    """
    nearest, room = sets.nearest(words), np.diff(sets.start).max()
    pixels, width = canvas.reshape(-1), canvas.shape[1]
    masses = _whole_masses(sets)

    def strip(rows: tuple[int, int]) -> None:
        add_masses(pixels, width, words, masses, nearest, sets.start, room, sets.x, sets.y, *rows)

    parallel.run(strip, _strips(canvas, words, nearest, sets, threads), threads)


def _whole_masses(sets: PointSets) -> np.ndarray:
    """Masses (P,) of points in units, those of each set adding up to `POINT_MASS` exactly."""
    masses = np.empty(len(sets.masses), np.int64)
    for begin, end in pairwise(sets.start):
        total = np.cumsum(sets.masses[begin:end])
        total = np.floor(total * (POINT_MASS / total[-1]) + 0.5)
        masses[begin:end] = np.diff(total, prepend=0.0)
    return masses


def _strips(
    canvas: np.ndarray, words: np.ndarray, nearest: np.ndarray, sets: PointSets, threads: int | None
) -> list[tuple[int, int]]:
    """Strips of rows, from first to last (exclusive), at most one a thread, with about as many points in each."""
    height, points = len(canvas), np.diff(sets.start)[nearest]
    count = min(parallel.thread_count(threads), 1 + int(points.sum()) // STRIP_POINTS)
    if count == 1:
        return [(0, height)]
    rows = np.clip(words[:, 5], 0, height - 1).astype(np.int64)
    points = np.cumsum(np.bincount(rows, weights=points, minlength=height))
    borders = np.searchsorted(points, points[-1] * np.arange(1, count) / count)
    return [(int(first), int(last)) for first, last in pairwise([0, *borders, height]) if first < last]


@njit(nogil=True, cache=True)
def draw_marks(pixels, width, words, labels, nearest, start, room, x, y, first_row, last_row):
    """`mark` within the rows from `first_row` to `last_row` (exclusive)."""
    index = np.empty(room, np.int32)
    for w in range(words.shape[0]):
        begin, end = start[nearest[w]], start[nearest[w] + 1]
        shows = place(words[w], x[begin:end], y[begin:end], width, first_row, last_row, index)
        label = labels[w]
        if shows == ALL:
            for k in range(end - begin):
                pixels[np.uint32(index[k])] = label
        elif shows == SOME:
            for k in range(end - begin):
                if index[k] >= 0:
                    pixels[np.uint32(index[k])] = label


@njit(nogil=True, cache=True)
def add_masses(pixels, width, words, masses, nearest, start, room, x, y, first_row, last_row):
    """`deposit` within the rows from `first_row` to `last_row` (exclusive)."""
    index = np.empty(room, np.int32)
    for w in range(words.shape[0]):
        begin, end = start[nearest[w]], start[nearest[w] + 1]
        shows = place(words[w], x[begin:end], y[begin:end], width, first_row, last_row, index)
        mass = np.int64(words[w, MASS])
        if shows == ALL:
            for k in range(end - begin):
                pixels[np.uint32(index[k])] += mass * masses[begin + k]
        elif shows == SOME:
            for k in range(end - begin):
                if index[k] >= 0:
                    pixels[np.uint32(index[k])] += mass * masses[begin + k]


@njit(nogil=True, cache=True)
def place(word, x, y, width, first_row, last_row, index):
    """Find the pixels that a word takes points (x, y) of the unit disc to.

    Writes their positions in the flat canvas to `index`, -1 for those outside the rows, and returns NONE, SOME or ALL
    for how many are inside. NONE and ALL are found from the disc alone, and ALL is free of branches for the compiler
    to use vector instructions.
    """
    across = math.sqrt(word[0] * word[0] + word[1] * word[1]) + ROUNDING
    along = math.sqrt(word[3] * word[3] + word[4] * word[4]) + ROUNDING
    left, right, low, high = word[2] - across, word[2] + across, word[5] - along, word[5] + along
    if right < 0 or left > width or high < first_row or low > last_row:
        return NONE
    a, b, e = np.float32(word[0]), np.float32(word[1]), np.float32(word[2])
    c, d, f = np.float32(word[3]), np.float32(word[4]), np.float32(word[5])
    stride = np.int32(width)
    if left >= 0 and right <= width and low >= first_row and high <= last_row:
        for k in range(x.shape[0]):
            row, column = np.int32(c * x[k] + d * y[k] + f), np.int32(a * x[k] + b * y[k] + e)
            index[k] = row * stride + column
        return ALL
    for k in range(x.shape[0]):
        across, along = a * x[k] + b * y[k] + e, c * x[k] + d * y[k] + f
        inside = 0 <= across < width and first_row <= along < last_row
        index[k] = np.int32(along) * stride + np.int32(across) if inside else -1
    return SOME
