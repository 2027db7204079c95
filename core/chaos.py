"""The chaos game on a canvas, for attractors that overlap themselves too much to be taken apart into words.

A point is moved by one map after another, drawn by chance as often as weights and transitions say, and leaves a trace
in the pixels that it comes by (Barnsley & Demko 1985). The draws are fixed: a run of points always makes the same,
whatever the maps.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from . import parallel
from .grammar import game_grammar, set_grammar
from .kernels import njit
from .words import origins

RUN = 2**16
"""Points of one run."""

GUIDE_BITS = 12
"""A random number's first bits look up where to start searching for its map."""


def mark(
    canvas: np.ndarray,
    root: np.ndarray,
    maps: np.ndarray,
    weights: np.ndarray,
    labels: np.ndarray,
    samples: float,
    threads: int | None,
    transitions: np.ndarray | None = None,
) -> None:
    """Raise the pixels that the game comes by to the label of the map that led there.

    Parameters
    ----------
    canvas : (height, width) uint8
        Written to.
    root : (6,)
        Map to pixels.
    maps : (N, 6)
        They must have an attractor.
    weights : (N,)
    labels : (N,) uint8
        0 for maps that are not drawn.
    samples : float
        Points for each pixel of the canvas; all in all they are rounded up to a power of two.
    threads : int, optional
    transitions : (N, N), optional
        Of a recurrent IFS.
    """
    runs = _runs(canvas, samples)
    none = np.zeros(0, np.int64)
    for marks, _ in _games(canvas.shape, root, maps, weights, transitions, labels, none, runs, threads):
        np.maximum(canvas, marks, out=canvas)


def deposit(
    canvas: np.ndarray,
    root: np.ndarray,
    maps: np.ndarray,
    weights: np.ndarray,
    samples: float,
    mass: int,
    threads: int | None,
    transitions: np.ndarray | None = None,
    opacity: np.ndarray | float = 1.0,
) -> None:
    """Add `mass`, a large power of two, to the pixels that the game comes by, in equal parts; otherwise as `mark`.

    Of each part only the share `opacity` (N,) of the map that led there is added.
    """
    runs = _runs(canvas, samples)
    parts = np.rint(np.broadcast_to(opacity, len(maps)) * (mass // (runs * RUN))).astype(np.int64)
    for _, sums in _games(canvas.shape, root, maps, weights, transitions, np.zeros(0, np.uint8), parts, runs, threads):
        canvas += sums


def _runs(canvas: np.ndarray, samples: float) -> int:
    return 1 << max(math.ceil(math.log2(samples * canvas.size / RUN)), 0)


def _games(
    shape, root, maps, weights, transitions, labels, parts, runs, threads
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Marks and sums of parts, one of them empty, of the runs that each thread has played."""
    height, width = shape
    rules = game_grammar(weights, transitions)
    first_bits = np.arange(2**GUIDE_BITS) / 2**GUIDE_BITS
    guide = np.array([np.searchsorted(borders, first_bits, side="right") - 1 for borders in rules.borders])
    starts = origins(maps, set_grammar(weights, transitions))
    # Runs start in the attractorlets as often as a game is in them, since it need not come from each to each.
    turns = (np.arange(runs) + 0.5) / runs
    letters = np.searchsorted(rules.borders[-1], turns, side="right") - 1 if len(starts) > 1 else np.zeros(runs, int)

    def game(share: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
        marks = np.zeros(height * width if len(labels) else 0, np.uint8)
        sums = np.zeros(0 if len(labels) else height * width, np.int64)
        play(root, maps, rules, guide, labels, parts, starts, letters, *share, height, width, marks, sums)
        return marks.reshape(-1, width), sums.reshape(-1, width)

    bounds = np.linspace(0, runs, min(parallel.thread_count(threads), runs) + 1).astype(int)
    return parallel.run(game, list(pairwise(bounds)), threads)


@njit(nogil=True, cache=True)
def play(root, maps, rules, guide, labels, parts, starts, letters, first_run, last_run, height, width, marks, sums):
    """Play the runs from `first_run` to `last_run` (exclusive), each from its letter's start, for `marks` or `sums`.

    Random numbers are by xorshift64* (Vigna 2016), seeded by the number of the run.
    """
    for run in range(first_run, last_run):
        state = np.uint64(run + 1) * np.uint64(0x9E3779B97F4A7C15)
        i = letters[run]
        x, y = starts[i, 0], starts[i, 1]
        for _ in range(RUN):
            state ^= state >> np.uint64(12)
            state ^= state << np.uint64(25)
            state ^= state >> np.uint64(27)
            bits = (state * np.uint64(0x2545F4914F6CDD1D)) >> np.uint64(11)
            chance = np.float64(bits) * 2.0**-53
            row = rules.state[i]
            borders = rules.borders[row]
            i = guide[row, bits >> np.uint64(53 - GUIDE_BITS)]
            while borders[i + 1] <= chance:
                i += 1
            x, y = (
                maps[i, 0] * x + maps[i, 1] * y + maps[i, 2],
                maps[i, 3] * x + maps[i, 4] * y + maps[i, 5],
            )
            across, along = root[0] * x + root[1] * y + root[2], root[3] * x + root[4] * y + root[5]
            if 0 <= across < width and 0 <= along < height:
                pixel = np.int64(along) * width + np.int64(across)
                if labels.shape[0] > 0:
                    marks[pixel] = max(marks[pixel], labels[i])
                else:
                    sums[pixel] += parts[i]
