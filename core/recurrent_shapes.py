"""The library of recurrent shapes: figures of corners, with a rule on which corner may come next.

They are what the chaos game draws that goes half of the way to a corner drawn by chance, if some draws are not allowed.
All are connected.
"""

import numpy as np

from .ifs import IFS
from .shapes import circle, towards


def restless_square() -> IFS:
    """Return a square that never goes to the same corner twice running: a lattice with a lattice on it.

    Source: direct construction, a recurrent IFS as in Barnsley, Elton & Hardin 1989.
    """
    return _corners(4, 45, 0, "restless square")


def hollow_square() -> IFS:
    """Return a square that never goes to the opposite corner next: its four sides, and ornaments on them.

    Each side is a segment of itself, of halves that may follow each other.

    Source: direct construction, as the restless square.
    """
    return _corners(4, 45, 2, "hollow square")


def restless_pentagon() -> IFS:
    """Return a pentagon that never goes to the same corner twice running: five flakes that overlap.

    Source: direct construction, as the restless square.
    """
    return _corners(5, 90, 0, "restless pentagon")


def _corners(count: int, first_angle: float, forbidden: int, name: str) -> IFS:
    """Return halves of a regular polygon towards its corners; so many corners on is not allowed next."""
    maps = [towards(1 / 2, corner) for corner in circle(count, first_angle)]
    return IFS(maps, name=name, transitions=1.0 - np.roll(np.eye(count), forbidden, axis=1))


RECURRENT_SHAPES = {
    ifs.name: ifs
    for ifs in (
        restless_square(),
        hollow_square(),
        restless_pentagon(),
    )
}
"""By name, in the order of the menu."""
