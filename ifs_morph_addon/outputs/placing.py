"""Where the plane of the attractor lies in the object: the window's middle at the origin, its larger side of length 1.

So every morph has the same size in the scene, whatever the units of its maps, and a camera that frames one frames all.
"""

import numpy as np

WINDOW_OF_UNIT = 1.1
"""Size of the window of a shape of size one, margins included."""


def unit(window) -> float:
    """Length in the plane of the attractor that has length 1 in the object."""
    left, bottom, right, top = window
    length = max(right - left, top - bottom)
    return length if length > 0 else 1.0


def middle(window) -> tuple[float, float]:
    """Place in the plane of the attractor that is the object's origin."""
    left, bottom, right, top = window
    return (left + right) / 2, (bottom + top) / 2


def origin_and_unit(window, depth) -> tuple[float, float, float, float]:
    """Place in the space of the attractor that is the object's origin, and the length there of 1 in the object."""
    nearest, furthest = depth
    return (*middle(window), (nearest + furthest) / 2, max(unit(window), furthest - nearest))


def in_object(points: np.ndarray, window) -> np.ndarray:
    """Points (P, 2) of the plane of the attractor in the object's space, float32 (P, 3)."""
    placed = np.zeros((len(points), 3), dtype=np.float32)
    placed[:, :2] = (points - np.float32(middle(window))) / np.float32(unit(window))
    return placed


def in_plane(points: np.ndarray, window) -> np.ndarray:
    """Points (P, 2) in the plane of the attractor of points (P, 2) or (P, 3) in the object: `in_object` backwards."""
    return np.asarray(points, dtype=float)[:, :2] * unit(window) + middle(window)


def frame_size(window) -> float:
    """Size of the triangle whose images show the maps: the power of eight nearest to that of the window.

    It is one for shapes about as large as the unit square, as most are. The steps are wide, since the triangles change
    with every step, and a drag that makes the window a little larger should not.
    """
    return float(8.0 ** np.round(np.log2(unit(window) / WINDOW_OF_UNIT) / 3))
