"""The library of named shapes in space, each built from its geometry; as `core.shapes` for the plane.

They stand upright along y, as those of the plane do, and the entries of Fractint's files.
"""

from itertools import product

import numpy as np

from .affine import turned
from .ifs import SpaceIFS

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [1 / 2, 0, -(3**0.5) / 2], [1 / 2, (2 / 3) ** 0.5, -(3**0.5) / 6]])
"""Corners, with edges of length 1."""


def towards(scale: float, points: np.ndarray, name: str) -> SpaceIFS:
    """Return the shape of maps that shrink all of space by one scale towards points (N, 3)."""
    points = np.asarray(points, dtype=float)
    linear = np.tile(scale * np.eye(3), (len(points), 1, 1))
    return SpaceIFS(np.concatenate([linear, (1 - scale) * points[..., None]], axis=-1), name=name)


def cells(side: int, occupied, name: str) -> SpaceIFS:
    """Return the maps from the unit cube to (x, y, z) cells of its side x side x side grid."""
    return towards(1 / side, np.array(list(occupied)) / (side - 1), name)


def tetrahedron() -> SpaceIFS:
    """Return Sierpinski's tetrahedron: a tetrahedron as four halves of itself, which touch at their corners.

    Source: Mandelbrot 1982, The Fractal Geometry of Nature, chapter 14.
    """
    return towards(1 / 2, TETRAHEDRON, "Sierpinski tetrahedron")


def turned_tetrahedron() -> SpaceIFS:
    """Return Sierpinski's tetrahedron with its first map turned by a third about the height through its corner.

    The turn leaves the tetrahedron as it is, and so the attractor: only the morph to another shape differs.

    Source: direct construction, after the turned gasket of Burch & Hart 1997.
    """
    maps = tetrahedron().maps.copy()
    axis = TETRAHEDRON[1:].mean(axis=0)
    maps[0, :, :3] = turned(axis / np.linalg.norm(axis), np.array(2 * np.pi / 3)) / 2
    return SpaceIFS(maps, name="turned tetrahedron")


def pyramid() -> SpaceIFS:
    """Return a square pyramid as five halves of itself.

    Source: direct construction; its sides are gaskets.
    """
    corners = [(0, 0, 0), (1, 0, 0), (1, 0, -1), (0, 0, -1), (1 / 2, 2**-0.5, -1 / 2)]
    return towards(1 / 2, corners, "pyramid")


def octahedron() -> SpaceIFS:
    """Return an octahedron as six halves of itself, which touch along their edges.

    Source: direct construction, as the tetrahedron.
    """
    axes = np.eye(3)
    return towards(1 / 2, np.concatenate([axes, -axes]), "octahedron flake")


def sponge() -> SpaceIFS:
    """Return Menger's sponge: a cube of 3 x 3 x 3 cells less its middle and those of its sides.

    Source: Menger 1926, Allgemeine Räume und Cartesische Räume.
    """
    kept = [cell for cell in product(range(3), repeat=3) if cell.count(1) < 2]
    return cells(3, kept, "Menger sponge")


def snowflake() -> SpaceIFS:
    """Return the Mosely snowflake: a cube of 3 x 3 x 3 cells less its corners and its middle.

    Source: Mosely 2006, the lighter of the two.
    """
    kept = [cell for cell in product(range(3), repeat=3) if cell.count(1) in (1, 2)]
    return cells(3, kept, "Mosely snowflake")


def cross() -> SpaceIFS:
    """Return a cube of 3 x 3 x 3 cells of which the middle and those of the sides are kept.

    Source: Vicsek 1983, in the plane; here with six arms.
    """
    kept = [cell for cell in product(range(3), repeat=3) if cell.count(1) >= 2]
    return cells(3, kept, "cross in space")


def fern() -> SpaceIFS:
    """Return a fern whose leaf curls out of the plane, with leaflets to both sides.

    Source: the fern of Barnsley 1988, with a third axis about which all but the stem have a size, and a top that turns
    towards it by 0.1 in 0.85. The stem is longer, for the curl makes the leaf short.
    """
    stem = [[0, 0, 0], [0, 0.4, 0], [0, 0, 0]]
    top = [[0.85, 0, 0], [0, 0.85, 0.1], [0, -0.1, 0.85]]
    right = [[0.2, -0.25, 0], [0.22, 0.22, 0], [0, 0, 0.2]]
    left = [[-0.2, 0.25, 0], [0.22, 0.22, 0], [0, 0, 0.2]]
    shifts = [(0, 0, 0), (0, 1.6, 0), (0, 0.8, 0), (0, 0.8, 0)]
    maps = [np.column_stack([linear, shift]) for linear, shift in zip((stem, top, right, left), shifts, strict=True)]
    return SpaceIFS(np.array(maps), (0.03, 0.75, 0.11, 0.11), "fern in space")


SPACE_SHAPES = {
    ifs.name: ifs
    for ifs in (
        tetrahedron(),
        turned_tetrahedron(),
        pyramid(),
        octahedron(),
        cross(),
        snowflake(),
        sponge(),
        fern(),
    )
}
"""Shapes in space by name, in the order of the menu."""
