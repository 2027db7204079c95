"""Sets of attractors that overlap themselves too much to be taken apart into words: a point spreads until all is found.

The images of a point of the attractor belong to it too. So one point is kept for each cell of a grid over the
attractor, and its images start further cells, until no new one is found. That costs one step for each cell and map,
where the chaos game comes by the same places again and again and takes ages to find those that it seldom visits.
"""

from __future__ import annotations

import numpy as np

from .kernels import njit
from .words import fixed_point, grown

CELLS = 3.0
"""Cells for each pixel, along each side. A map that hardly contracts takes a point near its fixed point to the same
cell, and what lies closer to it is missed: cells are small to keep that to a few pixels."""

LEAST_CELLS, MOST_CELLS = 1024, 8192
"""Along each side of the grid, which takes a byte for each cell."""


def mark(canvas: np.ndarray, root: np.ndarray, maps: np.ndarray, labels: np.ndarray) -> bool:
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

    Returns
    -------
    bool
        Whether cells were no larger than pixels. If the canvas shows a small part only, more points are needed.
    """
    diameter = 2 * max(root[0], root[4])
    sides = int(min(max(CELLS * diameter, LEAST_CELLS), MOST_CELLS))
    spread(root, maps, labels, fixed_point(maps[0]), sides, canvas.shape[1], canvas.shape[0], canvas.reshape(-1))
    return sides >= diameter


@njit(nogil=True, cache=True)
def spread(root, maps, labels, start, sides, width, height, pixels):
    """`mark` from a point of the attractor, on a grid of `sides` cells along each side of the unit disc's square."""
    known = np.zeros((sides, sides), np.uint8)
    stack, top = np.empty((4096, 2)), 1
    stack[0, 0], stack[0, 1] = start[0], start[1]
    while top > 0:
        top -= 1
        x, y = stack[top, 0], stack[top, 1]
        if top + maps.shape[0] > stack.shape[0]:
            stack = grown(stack, 2 * stack.shape[0] + maps.shape[0])
        for i in range(maps.shape[0]):
            p, q = maps[i, 0] * x + maps[i, 1] * y + maps[i, 2], maps[i, 3] * x + maps[i, 4] * y + maps[i, 5]
            across, along = root[0] * p + root[1] * q + root[2], root[3] * p + root[4] * q + root[5]
            if 0 <= across < width and 0 <= along < height:
                pixel = np.int64(along) * width + np.int64(across)
                pixels[pixel] = max(pixels[pixel], labels[i])
            column = min(max(int((p + 1) / 2 * sides), 0), sides - 1)
            row = min(max(int((q + 1) / 2 * sides), 0), sides - 1)
            if known[row, column] == 0:
                known[row, column] = 1
                stack[top, 0], stack[top, 1] = p, q
                top += 1
