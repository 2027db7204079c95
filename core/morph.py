"""The morph: two IFSs with as many maps each, and the family of IFSs between them.

`u` drives the linear parts, `v` the translations, and *swell* thickens the maps where (u,v) alone would let the shape
break (Burch & Hart 1997, Section 5, Eq. 6; swell is an addition).
"""

from __future__ import annotations

import numpy as np

from .affine import determinant, polar, rotation, singular_values
from .ifs import IFS, IFSError
from .joining import over_one_graph

SCHEMES = ("elementwise", "polar", "log-polar")
"""How linear parts are interpolated: entry by entry (Fig. 3), by polar decomposition (Eq. 6), or that with the
logarithm of the stretch, which then stays positive for every u."""

SWOLLEN = 0.72
"""Swell 1 raises every eigenvalue of a stretch to this. Its square is above one half, and maps of equal orientation
whose determinants are all one half or more have a connected attractor, wherever they are (see `connectedness`)."""

SINGULAR = 1e-12
"""A map whose singular values are this far apart has no orientation of its own."""

TIE = 1e-9
"""Angles this close to half a turn apart turn counter-clockwise."""


class Morph:
    """The two-parameter family of IFSs between an initial and a final one.

    Map i of one becomes map i of the other.

    Parameters
    ----------
    initial, final : IFS
        With the same number of maps. Where they allow different transitions, maps are taken apart (see `joining`).
    scheme : str
        One of `SCHEMES`.
    winding : (N,) of int, optional
        Whole turns added to each map's turning, counter-clockwise positive; by default none, the shorter way round.

    Raises
    ------
    IFSError
        If the numbers of maps differ, the scheme is unknown, a winding is not whole, or a stretch has no logarithm.

    Attributes
    ----------
    initial, final : IFS
        With N maps each: those given, or parts of them.
    part_of : (N,) int
        The map given that each is, or is a part of.
    flips : tuple of int
        Maps given that reflect at one end only, or have a part that does. No path of non-singular maps of the plane
        joins such ends: the map is flattened to a line half-way, as if turned over about its mirror axis and projected.
    turned_over : tuple of int
        Maps that reflect at one end only and turn over through space: none, but see `space.lifting.LiftedMorph`.
    turning : (N,)
        Radians by which each map turns on the way, counter-clockwise positive; not for the scheme ``elementwise``.
    shapes : (IFS, IFS)
        With the attractors of the ends: the ends themselves, or what they were made of by splits and symmetries.
    """

    DIMENSION = 2
    """Of the shapes, see `IFS.DIMENSION`."""

    turned_over: tuple[int, ...] = ()

    def __init__(self, initial: IFS, final: IFS, scheme: str = "polar", winding: np.ndarray | None = None) -> None:
        winding = self._accept(initial, final, scheme, winding)
        initial, final = self.initial, self.final
        reflects = _orientations(initial.linear, final.linear)
        self.flips = tuple(np.unique(self.part_of[reflects[0] != reflects[1]]).tolist())
        self._reflects = reflects
        if scheme != "elementwise":
            start, _, self._initial_stretch = polar(initial.linear, reflects[0])
            end, _, self._final_stretch = polar(final.linear, reflects[1])
            turn = np.remainder(end - start + np.pi, 2 * np.pi) - np.pi
            turn = np.where(np.abs(turn) >= np.pi - TIE, np.abs(turn), turn)
            self._start, self.turning = start, turn + 2 * np.pi * winding
        if scheme == "log-polar":
            for ifs, end, stretch in (
                (initial, "initial", self._initial_stretch),
                (final, "final", self._final_stretch),
            ):
                values = singular_values(ifs.linear)
                for i in np.flatnonzero(values[:, 1] <= SINGULAR * values[:, 0]):
                    raise IFSError(
                        f"Map {self.part_of[i] + 1} of the {end} shape is flat, and a flat stretch has no logarithm; "
                        "use the polar scheme or give the map some height."
                    )
                stretch[:] = _of_eigenvalues(stretch, np.log)

    def _accept(self, initial: IFS, final: IFS, scheme: str, winding: np.ndarray | None) -> np.ndarray:
        """Check and keep what the morph is made of; the winding (N,)."""
        for ifs in (initial, final):
            if ifs.DIMENSION != self.DIMENSION:
                raise IFSError(
                    f"This morph is between shapes of {self.DIMENSION} dimensions, and one has {ifs.DIMENSION}; "
                    "choose two shapes of the plane, or two in space."
                )
        if initial.count != final.count:
            raise IFSError(
                f"The initial shape has {initial.count} maps and the final one {final.count}; "
                "both must have as many: add maps to one or remove them from the other."
            )
        if scheme not in SCHEMES:
            raise IFSError(f"There is no scheme “{scheme}”; choose one of {', '.join(SCHEMES)}.")
        winding = np.zeros(initial.count) if winding is None else np.asarray(winding, dtype=float)
        whole = np.isfinite(winding).all() and np.array_equal(winding, np.round(winding))
        if winding.shape != (initial.count,) or not whole:
            raise IFSError(f"Winding must be {initial.count} whole numbers of turns, one a map.")
        self.initial, self.final, self.part_of = over_one_graph(initial, final)
        self.shapes = initial, final
        self._opaque = all((ifs.opacity == 1).all() for ifs in (initial, final))
        self.scheme, self.winding = scheme, winding.astype(int)[self.part_of]
        return self.winding

    @property
    def count(self) -> int:
        """N, the number of maps."""
        return self.initial.count

    @property
    def is_recurrent(self) -> bool:
        """Whether an end is a recurrent IFS."""
        return self.initial.is_recurrent or self.final.is_recurrent

    def at(self, u: np.ndarray | float, v: np.ndarray | float, swell: np.ndarray | float = 0.0) -> IFS:
        """The IFS at (u,v) (Burch & Hart 1997, Eq. 6).

        Parameters
        ----------
        u, v : float or (N,)
            One value for all maps or one each. (0, 0) is the initial shape, (1, 1) the final one; values beyond
            extrapolate.
        swell : float or (N,)
            In [0, 1].

        Returns
        -------
        IFS
            It need not have an attractor.
        """
        linear = np.broadcast_to(self.linear(u, swell), self.initial.linear.shape)
        translation = np.broadcast_to(self.translation(v), self.initial.translation.shape)
        maps = np.concatenate([linear, translation[..., None]], axis=-1)
        plain = self.initial.transitions is self.final.transitions is None
        transitions = None if plain else self.transitions_at(np.mean(u))
        opacity = None if self._opaque else self.opacity_at(u)
        return type(self.initial)(maps, self.weights_at(u), transitions=transitions, opacity=opacity)

    def linear(self, u: np.ndarray | float, swell: np.ndarray | float = 0.0) -> np.ndarray:
        """Linear parts (..., N, 2, 2) for `u` and `swell` that broadcast to (..., N)."""
        u = np.asarray(u, dtype=float)
        along = np.broadcast_to(u, np.broadcast_shapes(u.shape, np.shape(swell), (self.count,)))
        weight = along[..., None, None]
        if self.scheme == "elementwise":
            linear = _blend(self.initial.linear, self.final.linear, weight)
            if not np.any(swell):
                return linear
            angle, reflects, stretch = polar(linear)
            return rotation(angle, reflects) @ _swollen(stretch, swell)
        stretch = _blend(self._initial_stretch, self._final_stretch, weight)
        if self.scheme == "log-polar":
            stretch = _of_eigenvalues(stretch, np.exp)
        stretch = _swollen(stretch, swell)
        # diag(1, sign) turns with u about the mirror axis where the ends differ, and stays where they agree.
        start, end = (np.where(reflects, -1.0, 1.0) for reflects in self._reflects)
        sign = np.where(start == end, start, start * np.cos(np.pi * along))
        orthogonal = rotation(self._start + along * self.turning)
        flipped = np.stack([stretch[..., 0, :], sign[..., None] * stretch[..., 1, :]], axis=-2)
        return orthogonal @ flipped

    def translation(self, v: np.ndarray | float) -> np.ndarray:
        """Translations (..., N, 2) for `v` that broadcasts to (..., N)."""
        along = np.asarray(v, dtype=float)
        along = np.broadcast_to(along, np.broadcast_shapes(along.shape, (self.count,)))
        return _blend(self.initial.translation, self.final.translation, along[..., None])

    def weights_at(self, u: np.ndarray | float) -> np.ndarray:
        """Weights (N,) at u: interpolated between the ends, held beyond them."""
        along = np.clip(u, 0.0, 1.0)
        return _blend(self.initial.weights, self.final.weights, along)

    def transitions_at(self, u: np.ndarray | float) -> np.ndarray:
        """Transitions (..., N, N) at u (...): interpolated between the ends, held beyond them.

        Which of them are allowed is the same all the way.
        """
        ones = np.ones((self.count, self.count))
        start, end = (ones if ifs.transitions is None else ifs.transitions for ifs in (self.initial, self.final))
        return _blend(start, end, np.clip(u, 0.0, 1.0)[..., None, None])

    def opacity_at(self, u: np.ndarray | float) -> np.ndarray:
        """Opacities (..., N) for `u` that broadcasts to (..., N): interpolated between the ends, held beyond them."""
        start, end = self.initial.opacity, self.final.opacity
        # What does not change stays so to the bit.
        return np.where(start == end, start, _blend(start, end, np.clip(u, 0.0, 1.0)))

    def allowed_at(self, u: np.ndarray | float) -> np.ndarray:
        """What `IFS.allowed` is (..., N + 1, N) for `u` that broadcasts to (..., N)."""
        drawn = self.opacity_at(u) > 0
        # What may follow what is the same all the way.
        follows = np.broadcast_to(self.initial.follows, (*drawn.shape[:-1], self.count, self.count))
        return np.concatenate([follows, drawn[..., None, :]], axis=-2)


def spread(places: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """u, v and swell of places of a morph, as `Morph.at` takes them.

    Parameters
    ----------
    places : (..., 3) or (..., 3 + 2M)
        u, v and swell; and where maps have a (u,v) of their own, how much further in u each of M maps is, then in v.
        Maps beyond those go along with u and v.
    count : int
        N, the maps of the morph.

    Returns
    -------
    u, v : (..., 1) or (..., N)
    swell : (..., 1)
    """
    places = np.asarray(places, dtype=float)
    u, v, swell = (places[..., k : k + 1] for k in range(3))
    if places.shape[-1] > 3:
        offsets = places[..., 3:].reshape(*places.shape[:-1], 2, (places.shape[-1] - 3) // 2)[..., :count]
        lacking = [(0, 0)] * (offsets.ndim - 1) + [(0, count - offsets.shape[-1])]
        offsets = np.pad(offsets, lacking)
        u, v = u + offsets[..., 0, :], v + offsets[..., 1, :]
    return u, v, swell


def _blend(start: np.ndarray, end: np.ndarray, along: np.ndarray) -> np.ndarray:
    return (1 - along) * start + along * end


def _orientations(initial: np.ndarray, final: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which maps reflect at each end; one that is singular at one end has the other end's orientation there."""
    reflects, singular = [], []
    for linear in (initial, final):
        values = singular_values(linear)
        singular.append(values[:, 1] <= SINGULAR * values[:, 0])
        reflects.append((determinant(linear) < 0) & ~singular[-1])
    return (
        np.where(singular[0], reflects[1], reflects[0]),
        np.where(singular[1], reflects[0], reflects[1]),
    )


def _of_eigenvalues(symmetric: np.ndarray, function) -> np.ndarray:
    """A function of symmetric matrices (..., 2, 2): of their eigenvalues, the eigenvectors kept."""
    mean = (symmetric[..., 0, 0] + symmetric[..., 1, 1]) / 2
    p = (symmetric[..., 0, 0] - symmetric[..., 1, 1]) / 2
    q = symmetric[..., 0, 1]
    radius = np.hypot(p, q)
    high, low = function(mean + radius), function(mean - radius)
    slope = np.divide((high - low) / 2, radius, out=np.zeros_like(radius), where=radius > 0)
    mean = (high + low) / 2
    return np.stack(
        [np.stack([mean + slope * p, slope * q], axis=-1), np.stack([slope * q, mean - slope * p], axis=-1)],
        axis=-2,
    )


def _swollen(stretch: np.ndarray, swell: np.ndarray | float) -> np.ndarray:
    """Stretches with their eigenvalues below `SWOLLEN` raised towards it, all the way at swell 1."""
    if not np.any(swell):
        return stretch
    return _of_eigenvalues(stretch, lambda values: values + swell * np.maximum(0.0, SWOLLEN - values))
