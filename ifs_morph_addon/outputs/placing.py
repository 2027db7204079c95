"""Where the plane of the attractor lies in the object: the window's middle at the origin, its larger side of length 1.

So every morph has the same size in the scene, whatever the units of its maps, and a camera that frames one frames all.
"""

import numpy as np


def unit(window) -> float:
    """Length in the plane of the attractor that has length 1 in the object."""
    left, bottom, right, top = window
    length = max(right - left, top - bottom)
    return length if length > 0 else 1.0


def middle(window) -> tuple[float, float]:
    """Place in the plane of the attractor that is the object's origin."""
    left, bottom, right, top = window
    return (left + right) / 2, (bottom + top) / 2


def in_object(points: np.ndarray, window) -> np.ndarray:
    """Points (P, 2) of the plane of the attractor in the object's space, float32 (P, 3)."""
    placed = np.zeros((len(points), 3), dtype=np.float32)
    placed[:, :2] = (points - np.float32(middle(window))) / np.float32(unit(window))
    return placed
