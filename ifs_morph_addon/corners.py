"""Maps as triangles: three points, and so all of an affine map, shear included."""

import numpy as np

from ..core.affine import through, transform
from .conversion import edited_shape, shape_maps
from .outputs.placing import frame_size

NAMES = ("ORIGIN", "X", "Y", "WHOLE")
"""What of a triangle can be dragged; WHOLE is its middle."""


def unit_triangle(owner) -> np.ndarray:
    """Triangle (3, 2) whose images show the maps: the origin, and a place on the x and on the y axis."""
    size = frame_size(owner.ifs_morph.output.window)
    return np.array([(0.0, 0.0), (size, 0.0), (0.0, size)])


def places(owner) -> np.ndarray:
    """Places (N, 4, 2) of what can be dragged of the edited maps, in the plane of the attractor."""
    triangles = transform(shape_maps(edited_shape(owner))[:, None], unit_triangle(owner))
    return np.concatenate([triangles, triangles.mean(axis=1, keepdims=True)], axis=1)


def drag(owner, item, name: str, place) -> None:
    """Change a map so that a corner of its triangle is at a place (2,), or all of it by its middle."""
    unit = unit_triangle(owner)
    triangle = transform(np.array(item.matrix, dtype=float), unit)
    if name == "WHOLE":
        triangle += place - triangle.mean(axis=0)
    else:
        triangle[NAMES.index(name)] = place
    item.matrix = through(unit, triangle)
