"""The iterated function system in space: as the one of the plane, with maps of three dimensions."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from ..ifs import IFS, IFSError
from .enclosure import enclosing_ball, shrinking_words

BOUNDS_PRECISION = 1e-4
"""Of the sides of the box, relative to the radius of the enclosing ball; less where that takes too many words."""

BOUNDS_WORDS = 5000


@dataclass(frozen=True, eq=False)
class SpaceIFS(IFS):
    """An iterated function system of maps of space; as `IFS`, but for what is said here.

    Parameters
    ----------
    maps : (N, 3, 4)
        ``[[a, b, c, j], [d, e, f, k], [g, h, i, l]]`` each, N >= 1: the matrix and the translation.
    weights : (N,), optional
        By default the volumes, none below a hundredth of their sum.
    name : str
    transitions : None
        Maps of space follow each other freely.
    opacity : (N,), optional
        As for `IFS`.

    Raises
    ------
    IFSError
        As `IFS`, and if there are transitions.
    """

    DIMENSION: ClassVar[int] = 3
    _LAYOUT: ClassVar[str] = "(N, 3, 4) is needed, a matrix and a translation each"
    _ENTRIES: ClassVar[str] = "all twelve"

    def __post_init__(self) -> None:
        if self.transitions is not None:
            raise IFSError(f"{self._called} shapes in space have no transitions; leave them out.")
        super().__post_init__()

    @property
    def _spectral_radii(self) -> np.ndarray:
        return np.abs(np.linalg.eigvals(self.linear)).max(axis=-1)

    @cached_property
    def _words(self) -> tuple:
        return shrinking_words(np.ascontiguousarray(self.linear).reshape(-1, 9))

    @cached_property
    def enclosing_ball(self) -> tuple[np.ndarray, float]:
        """Centre (3,) and radius of a ball that is certain to hold the attractor.

        Raises
        ------
        IFSError
            If there is no attractor.
        """
        self.require_attractor()
        linear = np.ascontiguousarray(self.linear).reshape(-1, 9)
        _, *words = self._words
        *center, radius = enclosing_ball(linear, np.ascontiguousarray(self.translation), *words)
        return np.array(center), radius

    @property
    def enclosing_disc(self) -> tuple[np.ndarray, float]:
        """The enclosing ball, for those who ask for what encloses the attractor in any number of dimensions."""
        return self.enclosing_ball

    @cached_property
    def bounds(self) -> tuple[float, float, float, float, float, float]:
        """Least x, y, z, largest x, y, z of a box that is certain to hold all that is drawn, close to it.

        Raises
        ------
        IFSError
            If there is no attractor.
        """
        center, radius = self.enclosing_ball
        reaches = [self._reach(sign * axis, center, radius) for sign in (-1.0, 1.0) for axis in np.eye(3)]
        least, most = center - reaches[:3], center + reaches[3:]
        return (*map(float, least), *map(float, most))

    def _reach(self, direction: np.ndarray, center: np.ndarray, radius: float) -> float:
        """Upper bound of how far all that is drawn reaches from the centre in a direction (3,).

        What a word adds to the reach depends on the image of the direction under its transpose alone, so the words
        are kept as such rows; of those with equal rows only the one that reaches furthest can matter.
        """
        shift = self.translation + self.linear @ center - center
        inside = np.linalg.solve(np.eye(3) - self.linear[0], shift[0])
        rows, offsets = direction[None], np.zeros(1)
        if not self.drawn.all():
            rows, offsets = (direction @ self.linear)[self.drawn], (shift @ direction)[self.drawn]
        while True:
            spread = radius * np.linalg.norm(rows, axis=1)
            most = offsets + spread
            if spread.max() <= BOUNDS_PRECISION * radius or len(rows) > BOUNDS_WORDS:
                return float(most.max()) + 1e-12 * radius
            kept = most >= (offsets + rows @ inside).max()
            rows, offsets = rows[kept], offsets[kept]
            offsets = (offsets[:, None] + rows @ shift.T).ravel()
            rows = (rows[:, None, None] @ self.linear).reshape(-1, 3)
            order = np.lexsort((-offsets, *np.round(rows, 12).T))
            rows, offsets = rows[order], offsets[order]
            first = np.append(True, (np.abs(np.diff(rows, axis=0)) > 1e-12).any(axis=1))
            rows, offsets = rows[first], offsets[first]
