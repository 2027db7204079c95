"""Sets of attractors that overlap themselves too much to be taken apart into words: a point spreads until all is found.

The images of a point of the attractor belong to it too. So one point is kept for each cell of a grid over the
attractor, and its images start further cells, until no new one is found. That costs one step for each cell and map,
where the chaos game comes by the same places again and again and takes ages to find those that it seldom visits.
Of a recurrent IFS, one is kept for each state that a point can be in (`grammar`), since its images depend on that.
"""

from __future__ import annotations

import math

import numpy as np

from .grammar import game_grammar, set_grammar, state_count
from .kernels import njit
from .words import grown, origins

CELLS = 3.0
"""Cells for each pixel, along each side. A map that hardly contracts takes a point near its fixed point to the same
cell, and what lies closer to it is missed: cells are small to keep that to a few pixels."""

LEAST_CELLS, MOST_CELLS = 1024, 8192
"""Along each side of the grid, which takes a byte for each cell and state; for several states it is made coarser."""


def mark(
    canvas: np.ndarray, root: np.ndarray, maps: np.ndarray, labels: np.ndarray, transitions: np.ndarray | None = None
) -> bool:
    """Raise the pixels that the attractor meets to the label of the last of its attractorlets that do.

    Parameters
    ----------
    canvas : (height, width) uint8
        Written to.
    root : (6,)
        Map to pixels.
    maps : (N, 6)
        They must have an attractor, in the unit disc.
    labels : (N,) uint8
        0 for maps that are not drawn.
    transitions : (N, N), optional
        Of a recurrent IFS.

    Returns
    -------
    bool
        Whether cells were no larger than pixels. If the canvas shows a small part only, more points are needed.
    """
    diameter = 2 * max(root[0], root[4])
    alike = np.ones(len(maps))
    rules = game_grammar(alike, None if transitions is None else (transitions > 0) / 1.0)
    starts = origins(maps, set_grammar(alike, transitions))
    states = state_count(rules)
    sides = int(min(max(CELLS * diameter, LEAST_CELLS), MOST_CELLS / math.sqrt(states)))
    known = np.zeros((states, sides, sides), np.uint8)
    spread(root, maps, rules, labels, starts, known, canvas.shape[1], canvas.shape[0], canvas.reshape(-1))
    return sides >= diameter


@njit(nogil=True, cache=True)
def spread(root, maps, rules, labels, starts, known, width, height, pixels):
    """`mark` from points of the attractor (1, 2), or of each attractorlet (N, 2), on the grids `known`."""
    sides = known.shape[1]
    # Columns: the point, and the state that it is in.
    stack, top = np.empty((4096, 3)), starts.shape[0]
    for i in range(top):
        stack[i, 0], stack[i, 1], stack[i, 2] = starts[i, 0], starts[i, 1], rules.state[i]
    while top > 0:
        top -= 1
        x, y, state = stack[top, 0], stack[top, 1], int(stack[top, 2])
        if top + maps.shape[0] > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + maps.shape[0])
        for i in range(maps.shape[0]):
            if not rules.allowed[state, i]:
                continue
            p, q = maps[i, 0] * x + maps[i, 1] * y + maps[i, 2], maps[i, 3] * x + maps[i, 4] * y + maps[i, 5]
            across, along = root[0] * p + root[1] * q + root[2], root[3] * p + root[4] * q + root[5]
            if 0 <= across < width and 0 <= along < height:
                pixel = np.int64(along) * width + np.int64(across)
                pixels[pixel] = max(pixels[pixel], labels[i])
            column = min(max(int((p + 1) / 2 * sides), 0), sides - 1)
            row = min(max(int((q + 1) / 2 * sides), 0), sides - 1)
            after = rules.state[i]
            if known[after, row, column] == 0:
                known[after, row, column] = 1
                stack[top, 0], stack[top, 1], stack[top, 2] = p, q, after
                top += 1
