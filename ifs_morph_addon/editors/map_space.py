"""Where the triangles of an object's maps lie in a viewport, and which corner of them is under the mouse."""

import numpy as np
from bpy_extras import view3d_utils
from mathutils import Vector

from .. import corners
from ..conversion import edited_shape
from ..operators.poll import is_changeable
from ..outputs.placing import in_object, in_plane

REACH = 9
"""How near to a corner the mouse has to be, in pixels at scale 1."""


def edited_owner(context):
    """Active object, if its maps are shown as triangles."""
    owner = context.object
    if owner is None or owner.ifs_morph.kind == "NONE" or not owner.ifs_morph.edit_maps or context.mode != "OBJECT":
        return None
    shape = edited_shape(owner)
    return owner if is_changeable(owner) and len(shape.maps) and not shape.in_space else None


def to_region(context, owner, places) -> np.ndarray:
    """Pixels (P, 2) in the region of places (P, 2) in the plane of an object's attractor; NaN behind the viewer."""
    points = in_object(np.asarray(places, dtype=float), owner.ifs_morph.output.window)
    view = context.region_data
    pixels = [
        view3d_utils.location_3d_to_region_2d(context.region, view, owner.matrix_world @ Vector(point))
        for point in points.tolist()
    ]
    return np.array([(np.nan, np.nan) if pixel is None else tuple(pixel) for pixel in pixels])


def from_region(context, owner, pixel) -> np.ndarray | None:
    """Place in the plane of an object's attractor that is under a pixel of the region; None if it is seen edge-on."""
    to_object = owner.matrix_world.inverted_safe()
    start = to_object @ view3d_utils.region_2d_to_origin_3d(context.region, context.region_data, pixel)
    along = to_object.to_3x3() @ view3d_utils.region_2d_to_vector_3d(context.region, context.region_data, pixel)
    if abs(along.z) <= 1e-6 * along.length:
        return None
    hit = start - along * (start.z / along.z)
    return in_plane([tuple(hit)], owner.ifs_morph.output.window)[0]


def handle_at(context, pixel):
    """Map and name of the corner under a pixel of the region, or None.

    Of several in one place, as where the maps of a gasket touch, that of the active map counts.
    """
    owner = edited_owner(context)
    if owner is None:
        return None
    places = corners.places(owner)
    distances = np.linalg.norm(to_region(context, owner, places.reshape(-1, 2)) - pixel, axis=1).reshape(
        places.shape[:2]
    )
    distances = np.nan_to_num(distances, nan=np.inf) / context.preferences.system.ui_scale
    active = edited_shape(owner).active_index
    if 0 <= active < len(distances):
        # A pixel is enough to be preferred, and not so much that others could not be reached.
        distances[active] -= 1
    index, corner = np.unravel_index(distances.argmin(), distances.shape)
    return (int(index), corners.NAMES[corner]) if distances[index, corner] <= REACH else None
