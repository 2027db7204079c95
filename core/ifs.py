"""The iterated function system: its maps and weights, whether it has an attractor, and where that lies."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from functools import cached_property
from typing import ClassVar

import numpy as np

from .affine import determinant, singular_values, spectral_radius
from .enclosure import enclosing_disc, shrinking_words
from .polygon import outer_polygon, recurrent_reach

WEIGHT_FLOOR = 0.01
"""Least default weight of a map as a share of all areas, so that a flat map is drawn too."""

BOUNDS_DIRECTIONS = 64

ALMOST_A_POINT = 1e-9
"""Radius of an attractor, relative to its distance from the origin, below which its bounds are those of its disc."""


class IFSError(ValueError):
    """Something a person gave is not an IFS that can be used; the message says what, where and what to do."""


class Contractivity(IntEnum):
    """Whether an IFS has an attractor."""

    CONTRACTIVE = 0
    NO_ATTRACTOR = 1
    UNDECIDED = 2


@dataclass(frozen=True, eq=False)
class IFS:
    """An iterated function system ``{w_i}``, ``w_i(x) = L_i x + t_i`` (Burch & Hart 1997, Section 1).

    Parameters
    ----------
    maps : (N, 2, 3)
        ``[[a, b, e], [c, d, f]]`` each, N >= 1.
    weights : (N,), optional
        How often each map is used where a measure is drawn, scaled to the sum 1. By default the areas ``|det L_i|``,
        none below a hundredth of their sum.
    name : str
        What to call it in a message or a menu.
    transitions : (N, N), optional
        Makes it a *recurrent* IFS (Barnsley, Elton & Hardin 1989): entry [i, j] times weight j is how often map j is
        applied next after map i, never where it is 0. By default all are 1.
    opacity : (N,), optional
        Share, from 0 to 1, with which the points of each attractorlet are drawn, those that map i was applied to last.
        Where it is 0 the map is *hidden*: it belongs to the attractor, and its attractorlet is not drawn. By default
        all are 1.

    Raises
    ------
    IFSError
        If the arrays have another shape, hold NaN or infinity, a weight is negative, or no map is drawn. Maps that do
        not contract are accepted, since a morph may pass through them: see `contractivity`.
    """

    maps: np.ndarray
    weights: np.ndarray | None = None
    name: str = field(default="")
    transitions: np.ndarray | None = None
    opacity: np.ndarray | None = None

    DIMENSION: ClassVar[int] = 2
    """Of the space that the maps act on: 2, and 3 for a `space.ifs.SpaceIFS`."""
    _LAYOUT: ClassVar[str] = "(N, 2, 3) is needed, [[a, b, e], [c, d, f]] each"
    _ENTRIES: ClassVar[str] = "a, b, c, d, e and f"

    def __post_init__(self) -> None:
        maps = _numbers(self.maps, f"{self._called} maps")
        if maps.ndim != 3 or maps.shape[1:] != (self.DIMENSION, self.DIMENSION + 1):
            raise IFSError(f"{self._called} maps have the shape {maps.shape}; {self._LAYOUT}.")
        if len(maps) == 0:
            raise IFSError(f"{self._called} has no maps; add at least one.")
        _require_finite(maps, f"{self._called} map", self._ENTRIES)
        areas = np.abs(determinant(maps[:, :, :-1]))
        if self.weights is None:
            total = areas.sum()
            weights = np.maximum(areas, WEIGHT_FLOOR * total) if total > 0 else np.ones(len(maps))
        else:
            weights = _numbers(self.weights, f"{self._called} weights")
            if weights.shape != (len(maps),):
                raise IFSError(
                    f"{self._called} has {len(maps)} maps but weights of shape {weights.shape}; give one weight a map."
                )
            _require_finite(weights, f"{self._called} weight of map", "the weight")
            for i in np.flatnonzero(weights < 0):
                raise IFSError(f"{self._called} weight of map {i + 1} is {weights[i]:g}; use zero or more.")
            if weights.sum() == 0:
                raise IFSError(f"{self._called} weights are all zero; give at least one map a weight.")
        total = weights.sum()
        # What was scaled once stays as it is, so that an IFS written to a file and read again is the same to the bit.
        if abs(total - 1) > len(weights) * np.finfo(float).eps:
            weights = weights / total
        maps.flags.writeable = weights.flags.writeable = False
        if self.transitions is not None:
            object.__setattr__(self, "transitions", _checked_transitions(self.transitions, len(maps), self._called))
        opacity = np.ones(len(maps))
        if self.opacity is not None:
            opacity = _checked_opacity(self.opacity, len(maps), self._called)
        opacity.flags.writeable = False
        object.__setattr__(self, "opacity", opacity)
        object.__setattr__(self, "maps", maps)
        object.__setattr__(self, "weights", weights)

    @property
    def _called(self) -> str:
        return f"The IFS “{self.name}”:" if self.name else "The IFS:"

    @property
    def count(self) -> int:
        """N, the number of maps."""
        return len(self.maps)

    @property
    def linear(self) -> np.ndarray:
        """Linear parts (N, 2, 2)."""
        return self.maps[:, :, :-1]

    @property
    def translation(self) -> np.ndarray:
        """Translations (N, 2)."""
        return self.maps[:, :, -1]

    @property
    def is_recurrent(self) -> bool:
        """Whether some map is never applied next after some other."""
        return self.transitions is not None and not self.transitions.all()

    @cached_property
    def follows(self) -> np.ndarray:
        """Which letter may come after which in a word (N, N): follows[i, k] where map i may be applied after map k."""
        if self.transitions is None:
            return np.ones((self.count, self.count), dtype=bool)
        return np.ascontiguousarray(self.transitions.T > 0)

    @property
    def drawn(self) -> np.ndarray:
        """Which attractorlets (N,) are drawn, be it faintly."""
        return self.opacity > 0

    @property
    def allowed(self) -> np.ndarray:
        """Which letter may come after which (N + 1, N), as `follows`; in the last row those that may come first.

        The words are those of all that is drawn, so a hidden letter may come anywhere but first.
        """
        return np.concatenate([self.follows, self.drawn[None]])

    @cached_property
    def norms(self) -> np.ndarray:
        """Lipschitz constants (N,) of the maps."""
        return singular_values(self.linear)[:, 0]

    @property
    def _spectral_radii(self) -> np.ndarray:
        return spectral_radius(self.linear)

    @cached_property
    def _words(self) -> tuple:
        return shrinking_words(np.ascontiguousarray(self.linear).reshape(-1, 4), self.follows)

    @property
    def contractivity(self) -> Contractivity:
        """Whether the maps contract, decided by words: one norm above 1 does not rule an attractor out."""
        return Contractivity(self._words[0])

    def require_attractor(self) -> None:
        """Raise IFSError, naming the map and its norm, unless the IFS is known to have an attractor."""
        if self.contractivity == Contractivity.CONTRACTIVE:
            return
        radii = self._spectral_radii
        worst = int(np.argmax(radii))
        if radii[worst] >= 1 - 1e-9:
            raise IFSError(
                f"{self._called} map {worst + 1} does not contract: its norm is {self.norms[worst]:.4g} and applied "
                f"again and again it grows by {radii[worst]:.4g} each time; scale it below 1."
            )
        worst = int(np.argmax(self.norms))
        found = (
            "applied in turn with the others it grows without end"
            if self.contractivity == Contractivity.NO_ATTRACTOR
            else "it could not be shown that the maps contract together"
        )
        raise IFSError(
            f"{self._called} map {worst + 1} has the norm {self.norms[worst]:.4g} and {found}; scale it below 1."
        )

    @cached_property
    def enclosing_disc(self) -> tuple[np.ndarray, float]:
        """Centre (2,) and radius of a disc that is certain to hold the attractor.

        Raises
        ------
        IFSError
            If there is no attractor.
        """
        self.require_attractor()
        linear = np.ascontiguousarray(self.linear).reshape(-1, 4)
        _, *words = self._words
        x, y, radius = enclosing_disc(linear, np.ascontiguousarray(self.translation), *words)
        return np.array([x, y]), radius

    @property
    def fixed_points(self) -> np.ndarray:
        """Fixed points (N, 2) of the maps; all lie on the attractor, unless it is recurrent.

        Raises
        ------
        IFSError
            If there is no attractor.
        """
        self.require_attractor()
        return np.linalg.solve(np.eye(self.DIMENSION) - self.linear, self.translation[..., None])[..., 0]

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """Least x, least y, largest x, largest y of a box that is certain to hold all that is drawn, and close to it.

        Raises
        ------
        IFSError
            If there is no attractor.
        """
        center, radius = self.enclosing_disc
        if radius <= ALMOST_A_POINT * np.abs(center).max():
            # The polygon would be made of rounding errors, which its steps may enlarge.
            return (*(center - radius).tolist(), *(center + radius).tolist())
        translation = self.translation + self.linear @ center - center
        linear = np.ascontiguousarray(self.linear).reshape(-1, 4)
        if not self.allowed.all():
            reach = recurrent_reach(linear, translation, self.allowed, radius, BOUNDS_DIRECTIONS, 1e-6 * radius)
        else:
            reach, _ = outer_polygon(linear, translation, radius, BOUNDS_DIRECTIONS, 1e-6 * radius)
        quarter = BOUNDS_DIRECTIONS // 4
        right, top, left, bottom = reach[::quarter]
        return (
            float(center[0] - left),
            float(center[1] - bottom),
            float(center[0] + right),
            float(center[1] + top),
        )


def _numbers(values: np.ndarray, what: str) -> np.ndarray:
    try:
        return np.array(values, dtype=float)
    except (TypeError, ValueError) as error:
        raise IFSError(f"{what} are not an array of numbers of one shape.") from error


def _checked_transitions(transitions: np.ndarray, count: int, called: str) -> np.ndarray:
    transitions = _numbers(transitions, f"{called} transitions")
    if transitions.shape != (count, count):
        raise IFSError(
            f"{called} has {count} maps but transitions of shape {transitions.shape}; give one from each map to each."
        )
    _require_finite(transitions, f"{called} transitions of map", "them")
    for i in range(count):
        if (transitions[i] < 0).any():
            raise IFSError(f"{called} a transition of map {i + 1} is negative; use zero or more.")
        if not transitions[i].any():
            raise IFSError(f"{called} no map may be applied after map {i + 1}; allow one.")
        if not transitions[:, i].any():
            raise IFSError(f"{called} map {i + 1} may not be applied after any map; allow one, or remove the map.")
    transitions.flags.writeable = False
    return transitions


def _checked_opacity(opacity: np.ndarray, count: int, called: str) -> np.ndarray:
    opacity = _numbers(opacity, f"{called} opacities")
    if opacity.shape != (count,):
        raise IFSError(f"{called} has {count} maps but opacities of shape {opacity.shape}; give one a map.")
    _require_finite(opacity, f"{called} opacity of map", "the opacity")
    for i in np.flatnonzero((opacity < 0) | (opacity > 1)):
        raise IFSError(f"{called} opacity of map {i + 1} is {opacity[i]:g}; use 0 to 1.")
    if not opacity.any():
        raise IFSError(f"{called} all its maps are hidden; give at least one an opacity above 0.")
    return opacity


def _require_finite(values: np.ndarray, what: str, which: str) -> None:
    """Name the first entry along the first axis that holds NaN or infinity."""
    broken = ~np.isfinite(values.reshape(len(values), -1)).all(axis=1)
    if broken.any():
        raise IFSError(f"{what} {int(np.argmax(broken)) + 1} holds NaN or infinity; {which} must be finite numbers.")
