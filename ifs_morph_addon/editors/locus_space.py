"""Where things of a locus lie in an Image Editor that shows it, and what of them is under the mouse."""

from itertools import pairwise

import numpy as np

from .. import fcurves
from ..operators.poll import is_changeable

SAMPLES_A_SPAN = 24
"""Points that stand for the curve between two keys."""

CROSS = 10
"""Half the size of the cross at the current (u,v), in pixels at scale 1."""

REACH = 8
"""How near to a key or the curve the mouse has to be, in pixels at scale 1."""


def owner_of_locus(context):
    """Active object, if the Image Editor shows the locus of its morph."""
    owner, space = context.object, context.space_data
    if owner is None or space is None or space.type != "IMAGE_EDITOR" or space.image is None:
        return None
    return owner if owner.ifs_morph.locus.image == space.image else None


def editable_owner(context):
    """Object whose path may be edited in this Image Editor, which must not be one for painting or masks."""
    owner = owner_of_locus(context)
    if owner is None or context.space_data.mode != "VIEW" or not is_changeable(owner):
        return None
    return owner


def to_region(image, region, uv) -> np.ndarray:
    """Pixels (P, 2) in the region of places (u,v) (P, 2) on the picture of a locus."""
    picture = image.ifs_morph_locus
    nodes = (np.asarray(uv) - np.array(picture.lowest)) / picture.spacing
    shares = (nodes + 0.5) / np.array(image.size)
    view = region.view2d
    return np.array([view.view_to_region(x, y, clip=False) for x, y in shares], dtype=np.float32)


def from_region(image, region, pixel) -> np.ndarray:
    """Place (u,v) on the picture of a locus that is at a pixel of the region."""
    picture = image.ifs_morph_locus
    share = np.array(region.view2d.region_to_view(*pixel))
    return (share * np.array(image.size) - 0.5) * picture.spacing + np.array(picture.lowest)


def path_samples(frames) -> np.ndarray:
    """Frames whose places stand for the path between keys at `frames`."""
    spans = [np.linspace(start, end, SAMPLES_A_SPAN) for start, end in pairwise(frames)]
    return np.concatenate(spans) if spans else np.array(frames)


def handle_at(context, pixel):
    """What of a path is under the mouse: ("CURRENT", None), ("KEY", frame), or None.

    A key counts before the cross only where the mouse is nearly on it, since at a key both may be in one place.
    """
    owner = editable_owner(context)
    if owner is None:
        return None
    image, region = context.space_data.image, context.region
    scale = context.preferences.system.ui_scale
    frames = fcurves.key_frames(owner)
    distance, nearest = np.inf, None
    if frames:
        places = to_region(image, region, fcurves.sample_path(owner, frames)[:, :2])
        distances = np.linalg.norm(places - pixel, axis=1)
        nearest = frames[int(distances.argmin())]
        distance = distances.min() / scale
    here = np.linalg.norm(to_region(image, region, [tuple(owner.ifs_morph.uv)])[0] - pixel) / scale
    if distance <= REACH / 2:
        return "KEY", nearest
    if here <= CROSS + 2:
        return "CURRENT", None
    return ("KEY", nearest) if distance <= REACH else None


def frame_at(context, pixel, reach: float = REACH):
    """Whole frame at which the path is nearest to a pixel of the region; None if the path is farther than `reach`."""
    owner = owner_of_locus(context)
    frames = fcurves.key_frames(owner)
    if not frames:
        return None
    inside = np.arange(np.ceil(frames[0]), np.floor(frames[-1]) + 1)
    fine = path_samples(frames)
    places = to_region(context.space_data.image, context.region, fcurves.sample_path(owner, fine)[:, :2])
    if _distance(places, pixel) > reach * context.preferences.system.ui_scale or not len(inside):
        return None
    places = to_region(context.space_data.image, context.region, fcurves.sample_path(owner, inside)[:, :2])
    return int(inside[np.linalg.norm(places - pixel, axis=1).argmin()])


def _distance(places, pixel) -> float:
    """Distance in pixels of a pixel from the line through places."""
    if len(places) == 1:
        return float(np.linalg.norm(places[0] - pixel))
    start, along = places[:-1], np.diff(places, axis=0)
    share = np.einsum("ij,ij->i", pixel - start, along) / np.maximum(np.einsum("ij,ij->i", along, along), 1e-9)
    nearest = start + np.clip(share, 0, 1)[:, None] * along
    return float(np.linalg.norm(nearest - pixel, axis=1).min())
