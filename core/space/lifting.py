"""Shapes of the plane put into space: on the floor z = 0, with maps that act on what is above it too.

A map that reflects the plane is a half-turn of space about its mirror axis. So maps that reflect at one end only, which
in the plane must pass through a line, turn over in space, and no map between two that are not flat is ever flat.
"""

from __future__ import annotations

import numpy as np

from ..affine import determinant
from ..ifs import IFS, IFSError
from ..morph import Morph
from .ifs import SpaceIFS
from .morph import SpaceMorph

FLIPS = ("turned", "projected")
"""What becomes of a map that reflects at one end only: it turns over through space, or stays in the plane as a line."""


def lift(ifs: IFS) -> SpaceIFS:
    """The shape in space, flat on the floor, that a shape of the plane is.

    Each map takes heights to their product with the root of the area ``|det L|``, and turns them over if it reflects.

    Raises
    ------
    IFSError
        If the shape is recurrent.
    """
    if ifs.is_recurrent:
        called = f"“{ifs.name}”" if ifs.name else "One shape"
        raise IFSError(
            f"{called} is recurrent, and no recurrent shape can become one in space; allow all its transitions, or "
            "choose a shape of the plane for the other end."
        )
    area = determinant(ifs.linear)
    maps = np.zeros((ifs.count, 3, 4))
    maps[:, :2, :2], maps[:, :2, 3] = ifs.linear, ifs.translation
    maps[:, 2, 2] = np.sign(area) * np.sqrt(np.abs(area))
    return SpaceIFS(maps, ifs.weights, ifs.name, opacity=ifs.opacity)


def in_one_space(initial: IFS, final: IFS) -> tuple[IFS, IFS]:
    """Two shapes of the same number of dimensions: one of the plane beside one of space is put into space."""
    if initial.DIMENSION == final.DIMENSION:
        return initial, final
    return tuple(lift(ifs) if ifs.DIMENSION == 2 else ifs for ifs in (initial, final))


class LiftedMorph(SpaceMorph):
    """The morph between two shapes of the plane that goes through space, for some of its maps flip."""

    def __init__(self, plane: Morph) -> None:
        super().__init__(lift(plane.initial), lift(plane.final), plane.scheme, plane.winding)
        self.turned_over = plane.flips


def morph_between(
    initial: IFS, final: IFS, scheme: str = "polar", winding: np.ndarray | None = None, flip: str = "projected"
) -> Morph:
    """The morph between two shapes of the plane, of space, or one of each.

    Parameters
    ----------
    initial, final, scheme, winding
        As for `Morph`.
    flip : str
        One of `FLIPS`. With ``turned`` the morph of two shapes of the plane goes through space if a map flips.

    Raises
    ------
    IFSError
        As `Morph`.
    """
    if flip not in FLIPS:
        raise IFSError(f"There is no flip “{flip}”; choose one of {', '.join(FLIPS)}.")
    initial, final = in_one_space(initial, final)
    if initial.DIMENSION == 3:
        return SpaceMorph(initial, final, scheme, winding)
    morph = Morph(initial, final, scheme, winding)
    turns = flip == "turned" and scheme != "elementwise" and not morph.is_recurrent
    return LiftedMorph(morph) if turns and morph.flips else morph
