"""The morph in space: two IFSs of maps of space, and the family between them (see `core.morph`).

Each map turns about one axis, by the shorter way: the straight line between two quaternions on their sphere (Shoemake
1985).
"""

from __future__ import annotations

import numpy as np

from ..ifs import IFSError
from ..morph import TIE, Morph
from .affine import SINGULAR, axis_and_angle, of_eigenvalues, polar, turned
from .ifs import SpaceIFS

SWOLLEN = 0.8
"""Swell 1 raises every eigenvalue of a stretch to this. Its cube is above one half, as the area certificate needs for
volumes (see `core.overlap.surely_one_piece`, which holds in any number of dimensions): 0.794 is the least."""


class SpaceMorph(Morph):
    """The family of IFSs between two of space; as `Morph`, but for what is said here.

    Parameters
    ----------
    initial, final : SpaceIFS
    scheme : str
    winding : (N,) of int, optional
        Whole turns about each map's axis, counter-clockwise as seen from its upper end.

    Attributes
    ----------
    flips : tuple of int
        Maps that reflect at one end only. Such a map is flattened half-way to a plane, the one that is mirrored after
        the least turn.
    axis : (N, 3)
        What the maps turn about, in the coordinates of the initial map's stretch; points up.
    turning : (N,)
        Radians by which each map turns on the way.
    """

    DIMENSION = SpaceIFS.DIMENSION

    def __init__(
        self, initial: SpaceIFS, final: SpaceIFS, scheme: str = "polar", winding: np.ndarray | None = None
    ) -> None:
        winding = self._accept(initial, final, scheme, winding)
        start, end, stretches = _decomposed(initial.linear, final.linear)
        relative = np.swapaxes(start, -1, -2) @ end
        mirrors = np.linalg.det(relative) < 0
        self.flips = tuple(int(i) for i in np.flatnonzero(mirrors))
        # A turn with a mirroring is minus a turn; that mirrors along its axis, and turns by half a turn less.
        self.axis, angle = axis_and_angle(np.where(mirrors[:, None, None], -relative, relative))
        angle = np.where(mirrors, np.remainder(angle, 2 * np.pi) - np.pi, angle)
        angle = np.where(np.abs(angle) >= np.pi - TIE, np.abs(angle), angle)
        self._start, self._mirrors = start, mirrors
        self.turning = angle + 2 * np.pi * winding
        if scheme == "log-polar":
            for ifs, name in ((initial, "initial"), (final, "final")):
                values = np.linalg.svd(ifs.linear, compute_uv=False)
                for i in np.flatnonzero(values[:, 2] <= SINGULAR * values[:, 0]):
                    raise IFSError(
                        f"Map {i + 1} of the {name} shape is flat, and a flat stretch has no logarithm; "
                        "use the polar scheme or give the map some depth."
                    )
            stretches = [of_eigenvalues(stretch, np.log) for stretch in stretches]
        self._initial_stretch, self._final_stretch = stretches

    def linear(self, u: np.ndarray | float, swell: np.ndarray | float = 0.0) -> np.ndarray:
        """Linear parts (..., N, 3, 3) for `u` and `swell` that broadcast to (..., N)."""
        u = np.asarray(u, dtype=float)
        along = np.broadcast_to(u, np.broadcast_shapes(u.shape, np.shape(swell), (self.count,)))
        weight = along[..., None, None]
        if self.scheme == "elementwise":
            linear = (1 - weight) * self.initial.linear + weight * self.final.linear
            if not np.any(swell):
                return linear
            orthogonal, stretch = polar(linear.reshape(-1, 3, 3))
            return (orthogonal @ _swollen(stretch, np.ravel(np.broadcast_to(swell, along.shape)))).reshape(linear.shape)
        stretch = (1 - weight) * self._initial_stretch + weight * self._final_stretch
        if self.scheme == "log-polar":
            stretch = of_eigenvalues(stretch, np.exp)
        stretch = _swollen(stretch, swell)
        # A turn about the axis, and along it a mirroring as if turned over and projected, where the ends differ.
        axis = np.broadcast_to(self.axis, (*along.shape, 3))
        shrunk = np.where(self._mirrors, np.cos(np.pi * along) - 1, 0.0)[..., None, None]
        mirroring = np.eye(3) + shrunk * axis[..., :, None] * axis[..., None, :]
        return self._start @ turned(axis, along * self.turning) @ mirroring @ stretch


def _decomposed(initial: np.ndarray, final: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[np.ndarray]]:
    """Orthogonal factors of both ends, a singular one as near to the other's as can be, and their stretches."""
    values = np.linalg.svd(initial, compute_uv=False)
    singular = values[:, 2] <= SINGULAR * values[:, 0]
    start, _ = polar(initial)
    end, final_stretch = polar(final, np.where(singular[:, None, None], np.eye(3), start))
    start, initial_stretch = polar(initial, end)
    return start, end, [initial_stretch, final_stretch]


def _swollen(stretch: np.ndarray, swell: np.ndarray | float) -> np.ndarray:
    """Stretches with their eigenvalues below `SWOLLEN` raised towards it, all the way at swell 1."""
    if not np.any(swell):
        return stretch
    swell = np.asarray(swell, dtype=float)[..., None]
    return of_eigenvalues(stretch, lambda values: values + swell * np.maximum(0.0, SWOLLEN - values))
