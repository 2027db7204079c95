"""The connectedness locus: for which (u,v) of a morph the attractor is in one piece (Burch & Hart 1997, Section 5).

Its nodes are aligned so that u = 0, u = 1, v = 0 and v = 1 lie on them. Shapes that only touch, as the Sierpinski
gasket does, are connected on just these lines, and any other grid would lose them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from . import parallel
from .connectedness import Connectedness
from .deciding import column_steps
from .morph import Morph

COLORS = {
    Connectedness.CONNECTED: (1.0, 1.0, 1.0),
    Connectedness.UNDECIDED: (1.0, 0.72, 0.2),
    Connectedness.NO_ATTRACTOR: (0.36, 0.05, 0.09),
}
"""White is connected, as in the paper's Figure 7; amber is undecided, dark red has no attractor."""

NEAR, FAR = (0.42, 0.52, 0.66), (0.02, 0.03, 0.06)
"""Disconnected with the least gap, and with a gap of `WIDE` enclosing diameters or more."""

WIDE = 0.25

PATH_COLOR = (0.95, 0.25, 0.1)

MAX_NODES = 4096


@dataclass(frozen=True, eq=False)
class Locus:
    """States of a morph's attractors over a grid of (u,v).

    Attributes
    ----------
    u, v : (U,), (V,)
        Coordinates of the nodes, ascending; multiples of one spacing, so that 0 and 1 are exactly on them.
    state : (V, U) uint8
        Values of `Connectedness`.
    gap : (V, U) float32
        Lower bound of the gap relative to the enclosing diameter: above 0 exactly where disconnected. NaN where there
        is no attractor, or where it was not asked for.
    tolerance : float
        Gaps below it may count as none.
    """

    u: np.ndarray
    v: np.ndarray
    state: np.ndarray
    gap: np.ndarray
    tolerance: float

    def share(self, state: Connectedness) -> float:
        """Share of the nodes that have this state."""
        return float(np.mean(self.state == state))

    def node(self, u: float, v: float) -> tuple[int, int]:
        """Row and column of the node nearest to (u,v)."""
        spacing = self.u[1] - self.u[0]
        column = int(np.clip(round((u - self.u[0]) / spacing), 0, len(self.u) - 1))
        row = int(np.clip(round((v - self.v[0]) / spacing), 0, len(self.v) - 1))
        return row, column

    def nearest_nodes(self, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rows (V',) nearest to the coordinates v and columns (U',) nearest to u: this locus on other nodes."""
        spacing = self.u[1] - self.u[0]
        rows = np.clip(np.rint((v - self.v[0]) / spacing), 0, len(self.v) - 1)
        columns = np.clip(np.rint((u - self.u[0]) / spacing), 0, len(self.u) - 1)
        return rows.astype(int), columns.astype(int)

    def picture(self, path: np.ndarray | None = None) -> np.ndarray:
        """The locus as colours: white connected, blue to black by the gap disconnected (see `COLORS`).

        Parameters
        ----------
        path : (P, 2), optional
            Points (u,v) to join by a line.

        Returns
        -------
        (V, U, 4) float32
            sRGB and alpha in [0, 1]; row 0 has the lowest v.
        """
        gap = np.nan_to_num(self.gap, nan=WIDE)
        depth = np.sqrt(np.clip(gap / WIDE, 0, 1))[..., None]
        picture = np.ones((*self.state.shape, 4), dtype=np.float32)
        picture[..., :3] = (1 - depth) * NEAR + depth * FAR
        for state, color in COLORS.items():
            picture[self.state == state, :3] = color
        if path is not None:
            _draw_line(picture, self._in_nodes(np.asarray(path, dtype=float)))
        return picture

    def _in_nodes(self, path: np.ndarray) -> np.ndarray:
        spacing = self.u[1] - self.u[0]
        return (path - (self.u[0], self.v[0])) / spacing


def compute_locus(
    morph: Morph,
    resolution: int = 511,
    tolerance: float = 1 / 300,
    domain: tuple = (-1, 2),
    threads: int | None = None,
    progress: Callable[[float], bool | None] | None = None,
    gap: bool = True,
) -> Locus:
    """Compute the connectedness locus of a morph by the certified test.

    Parameters
    ----------
    morph : Morph
    resolution : int
        Nodes along u; 1 + 3 k of them fit [-1, 2] (130, 256, 511), other numbers are brought to the nearest that fits.
    tolerance : float
        Relative to the enclosing diameter of each attractor.
    domain : (low, high) or ((low, high), (low, high))
        Of u and v; widened outward to whole nodes.
    threads : int, optional
        None for all processors; the result does not depend on it.
    progress : callable, optional
        Told the share done; returning False cancels with `parallel.Cancelled`.
    gap : bool
        Whether to measure the gaps, which takes a few times as long as the states.

    Raises
    ------
    ValueError
        If the resolution, the tolerance or the domain cannot be used.
    """
    return parallel.finish(compute_locus_steps(morph, resolution, tolerance, domain, threads, gap), progress)


def compute_locus_steps(
    morph: Morph,
    resolution: int = 511,
    tolerance: float = 1 / 300,
    domain: tuple = (-1, 2),
    threads: int | None = None,
    gap: bool = True,
) -> Generator[float, None, Locus]:
    """`compute_locus` in steps of about 50 milliseconds, each yielding the share done."""
    if not tolerance > 0:
        raise ValueError(f"The tolerance is {tolerance:g}; it must be above 0.")
    u, v = nodes(resolution, domain)
    linear = morph.linear(u[:, None]).reshape(len(u), morph.count, -1)
    start = morph.translation(0.0)
    drift = morph.translation(1.0) - start
    allowed = morph.allowed_at(u[:, None])
    state = np.empty((len(v), len(u)), dtype=np.uint8)
    low = np.empty((len(v), len(u)), dtype=np.float32)

    def fill(column: int) -> Generator[None, None, None]:
        found = yield from column_steps(linear[column], start, drift, v, allowed[column], tolerance, gap)
        state[:, column], low[:, column] = found[0], found[1][:, 0]

    yield from parallel.steps(fill, range(len(u)), threads)
    return Locus(u, v, state, low, float(tolerance))


def nodes(resolution: int, domain: tuple = (-1, 2)) -> tuple[np.ndarray, np.ndarray]:
    """Coordinates of the nodes along u and v: multiples of 1/m for a whole m."""
    ranges = np.asarray(domain, dtype=float)
    if ranges.ndim == 1:
        ranges = np.stack([ranges, ranges])
    if ranges.shape != (2, 2) or not np.isfinite(ranges).all() or (ranges[:, 0] >= ranges[:, 1]).any():
        raise ValueError(f"The domain is {domain}; it must be (low, high) or one of these each for u and v.")
    if not 2 <= resolution <= MAX_NODES:
        raise ValueError(f"The resolution is {resolution}; it must be between 2 and {MAX_NODES}.")
    per_unit = max(1, round((resolution - 1) / (ranges[0, 1] - ranges[0, 0])))
    axes = []
    for low, high in ranges:
        first, last = math.floor(low * per_unit + 1e-9), math.ceil(high * per_unit - 1e-9)
        if last - first >= MAX_NODES:
            raise ValueError(
                f"The domain {domain} takes {last - first + 1} nodes a side; at most {MAX_NODES} are allowed."
            )
        axes.append(np.arange(first, max(last, first + 1) + 1) / per_unit)
    return axes[0], axes[1]


def _draw_line(picture: np.ndarray, points: np.ndarray) -> None:
    """Join points, in pixels, by an antialiased line about two pixels wide, with a dark edge to stand out on white."""
    height, width = picture.shape[:2]
    rows, columns = np.mgrid[:height, :width]
    nearest = np.full((height, width), np.inf)
    for start, end in pairwise(points):
        low = np.floor(np.minimum(start, end)).astype(int) - 4
        high = np.ceil(np.maximum(start, end)).astype(int) + 5
        box = (slice(max(low[1], 0), max(high[1], 0)), slice(max(low[0], 0), max(high[0], 0)))
        x, y = columns[box] - start[0], rows[box] - start[1]
        along = end - start
        share = np.clip((x * along[0] + y * along[1]) / max(along @ along, 1e-12), 0, 1)
        nearest[box] = np.minimum(nearest[box], np.hypot(x - share * along[0], y - share * along[1]))
    for reach, color in ((2.4, (0.0, 0.0, 0.0)), (1.4, PATH_COLOR)):
        cover = np.clip(reach + 0.5 - nearest, 0, 1)[..., None]
        picture[..., :3] = (1 - cover) * picture[..., :3] + cover * color
