"""The chaos game on a canvas, for attractors that overlap themselves too much to be taken apart into words.

A point is moved by one map after another, drawn by chance as often as the weights say, and leaves a trace in the pixels
that it comes by (Barnsley & Demko 1985). The draws are fixed: a run of points always makes the same, whatever the maps.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numba import njit

from . import parallel

RUN = 2**16
"""Points of one run."""

GUIDE_BITS = 12
"""A random number's first bits look up where to start searching for its map."""


def mark(
    canvas: np.ndarray,
    maps: np.ndarray,
    borders: np.ndarray,
    labels: np.ndarray,
    points: float,
    threads: int | None,
) -> None:
    """Raise the pixels that the game comes by to the label of the map that led there.

    Parameters
    ----------
    canvas : (height, width) uint8
        Written to.
    maps : (N, 6)
        In pixels; they must have an attractor.
    borders : (N + 1,)
        Parts of the maps in the unit interval, see `words.cumulated`.
    labels : (N,) uint8
    points : float
        How many to play, rounded up to whole runs, and these to a power of two.
    threads : int, optional
    """
    for marks, _ in _games(canvas.shape, maps, borders, labels, _runs(points), threads):
        np.maximum(canvas, marks, out=canvas)


def deposit(
    canvas: np.ndarray, maps: np.ndarray, borders: np.ndarray, points: float, mass: int, threads: int | None
) -> None:
    """Add `mass` to the pixels that the game comes by, in equal parts for each point; otherwise as `mark`.

    `mass` is to be a power of two, larger than the number of points.
    """
    runs = _runs(points)
    for _, hits in _games(canvas.shape, maps, borders, np.zeros(0, np.uint8), runs, threads):
        canvas += hits * (mass // (runs * RUN))


def _runs(points: float) -> int:
    return 1 << max(int(np.ceil(np.log2(points / RUN))), 0)


def _games(shape, maps, borders, labels, runs, threads) -> list[tuple[np.ndarray, np.ndarray]]:
    """Marks and hits, one of them empty, of the runs that each thread has played."""
    height, width = shape
    guide = np.searchsorted(borders, np.arange(2**GUIDE_BITS) / 2**GUIDE_BITS, side="right") - 1
    a, b, e, c, d, f = maps[0]
    start = np.linalg.solve([[1 - a, -b], [-c, 1 - d]], [e, f])

    def game(share: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
        marks = np.zeros(shape if len(labels) else (0, 0), np.uint8)
        hits = np.zeros((0, 0) if len(labels) else shape, np.int64)
        play(maps, borders, guide, labels, start, *share, height, width, marks.reshape(-1), hits.reshape(-1))
        return marks, hits

    bounds = np.linspace(0, runs, min(parallel.thread_count(threads), runs) + 1).astype(int)
    return parallel.run(game, list(pairwise(bounds)), threads)


@njit(nogil=True, cache=True)
def play(maps, borders, guide, labels, start, first_run, last_run, height, width, marks, hits):
    """Play the runs from `first_run` to `last_run` (exclusive), each from `start`, into `marks` or else `hits`.

    Random numbers are by xorshift64* (Vigna 2016), seeded by the number of the run.
    """
    for run in range(first_run, last_run):
        state = np.uint64(run + 1) * np.uint64(0x9E3779B97F4A7C15)
        x, y = start[0], start[1]
        for _ in range(RUN):
            state ^= state >> np.uint64(12)
            state ^= state << np.uint64(25)
            state ^= state >> np.uint64(27)
            bits = (state * np.uint64(0x2545F4914F6CDD1D)) >> np.uint64(11)
            chance = np.float64(bits) * 2.0**-53
            i = guide[bits >> np.uint64(53 - GUIDE_BITS)]
            while borders[i + 1] <= chance:
                i += 1
            x, y = (
                maps[i, 0] * x + maps[i, 1] * y + maps[i, 2],
                maps[i, 3] * x + maps[i, 4] * y + maps[i, 5],
            )
            if 0 <= x < width and 0 <= y < height:
                pixel = np.int64(y) * width + np.int64(x)
                if labels.shape[0] > 0:
                    marks[pixel] = max(marks[pixel], labels[i])
                else:
                    hits[pixel] += 1
