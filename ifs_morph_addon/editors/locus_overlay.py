"""The path, its keys and the current (u,v), drawn over the picture of the locus in Image Editors."""

from itertools import pairwise

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from .. import fcurves

SAMPLES_A_SPAN = 24
"""Points that stand for the curve between two keys."""

LINE = (0.95, 0.25, 0.1, 1.0)
EDGE = (0.0, 0.0, 0.0, 0.8)
CURRENT = (0.1, 0.75, 1.0, 1.0)
CROSS = 10
"""Half the size of the cross at the current (u,v), in pixels at scale 1."""

_handles: list = []


def owner_of_locus(context):
    """Active object, if the Image Editor shows the locus of its morph."""
    owner = context.object
    image = context.space_data.image
    if owner is None or image is None or owner.ifs_morph.locus.image != image:
        return None
    return owner


def to_region(image, region, uv) -> np.ndarray:
    """Pixels (P, 2) in the region of places (u,v) (P, 2) on the picture of a locus."""
    picture = image.ifs_morph_locus
    nodes = (np.asarray(uv) - np.array(picture.lowest)) / picture.spacing
    shares = (nodes + 0.5) / np.array(image.size)
    view = region.view2d
    return np.array([view.view_to_region(x, y, clip=False) for x, y in shares], dtype=np.float32)


def _draw():
    context = bpy.context
    owner = owner_of_locus(context)
    if owner is None:
        return
    image, region = context.space_data.image, context.region
    scale = context.preferences.system.ui_scale
    gpu.state.blend_set("ALPHA")
    frames = fcurves.key_frames(owner)
    if frames:
        curve = fcurves.sample_path(owner, _between(frames))[:, :2]
        keys = fcurves.sample_path(owner, frames)[:, :2]
        line = to_region(image, region, curve)
        _lines(line, EDGE, 5 * scale, "LINE_STRIP")
        _lines(line, LINE, 2.5 * scale, "LINE_STRIP")
        _dots(to_region(image, region, keys), EDGE, 10 * scale)
        _dots(to_region(image, region, keys), LINE, 7 * scale)
    here = to_region(image, region, [tuple(owner.ifs_morph.uv)])[0]
    reach = CROSS * scale
    arms = here + np.float32([(-reach, 0), (reach, 0), (0, -reach), (0, reach)])
    _lines(arms, EDGE, 4 * scale, "LINES")
    _lines(arms, CURRENT, 2 * scale, "LINES")
    gpu.state.blend_set("NONE")


def _between(frames) -> np.ndarray:
    spans = [np.linspace(start, end, SAMPLES_A_SPAN) for start, end in pairwise(frames)]
    return np.concatenate(spans) if spans else np.array(frames)


def _lines(points, color, width, kind) -> None:
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    shader.uniform_float("color", color)
    batch_for_shader(shader, kind, {"pos": np.insert(points, 2, 0, axis=1)}).draw(shader)


def _dots(points, color, size) -> None:
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("color", color)
    gpu.state.point_size_set(size)
    batch_for_shader(shader, "POINTS", {"pos": points}).draw(shader)


def register():
    """Draw in all Image Editors from now on."""
    _handles.append(bpy.types.SpaceImageEditor.draw_handler_add(_draw, (), "WINDOW", "POST_PIXEL"))


def unregister():
    """Stop drawing."""
    while _handles:
        bpy.types.SpaceImageEditor.draw_handler_remove(_handles.pop(), "WINDOW")
