"""The path, its keys and the current (u,v), drawn over the picture of the locus in Image Editors."""

import bpy
import gpu
import numpy as np

from .. import fcurves, path_keys
from . import drawing, locus_space

LINE = (0.95, 0.25, 0.1, 1.0)
EDGE = (0.0, 0.0, 0.0, 0.8)
SELECTED = (1.0, 0.85, 0.3, 1.0)
CURRENT = (0.1, 0.75, 1.0, 1.0)

_handles: list = []


def _draw():
    context = bpy.context
    owner = locus_space.owner_of_locus(context)
    if owner is None:
        return
    image, region = context.space_data.image, context.region
    scale = context.preferences.system.ui_scale
    gpu.state.blend_set("ALPHA")
    frames = fcurves.key_frames(owner)
    if frames:
        places = fcurves.sample_path(owner, locus_space.path_samples(frames))
        for own in _own_paths(places):
            drawing.lines(locus_space.to_region(image, region, own), LINE, scale, "LINE_STRIP")
        line = locus_space.to_region(image, region, places[:, :2])
        drawing.lines(line, EDGE, 5 * scale, "LINE_STRIP")
        drawing.lines(line, LINE, 2.5 * scale, "LINE_STRIP")
        keys = locus_space.to_region(image, region, fcurves.sample_path(owner, frames)[:, :2])
        drawing.dots(keys, EDGE, 10 * scale)
        drawing.dots(keys, LINE, 7 * scale)
        selected = np.isin(frames, path_keys.selected_frames(owner))
        if selected.any():
            drawing.dots(keys[selected], SELECTED, 7 * scale)
    here = locus_space.to_region(image, region, [tuple(owner.ifs_morph.uv)])[0]
    reach = locus_space.CROSS * scale
    arms = here + np.float32([(-reach, 0), (reach, 0), (0, -reach), (0, reach)])
    drawing.lines(arms, EDGE, 4 * scale)
    drawing.lines(arms, CURRENT, 2 * scale)
    gpu.state.blend_set("NONE")


def _own_paths(places) -> list:
    """Places (F, 2) of each map that leaves the path."""
    offsets = places[:, 3:].reshape(len(places), 2, -1)
    return [places[:, :2] + own for own in np.moveaxis(offsets, 2, 0) if own.any()]


def register():
    """Draw in all Image Editors from now on."""
    _handles.append(bpy.types.SpaceImageEditor.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL"))


def unregister():
    """Stop drawing."""
    while _handles:
        bpy.types.SpaceImageEditor.draw_handler_remove(_handles.pop(), "WINDOW")
