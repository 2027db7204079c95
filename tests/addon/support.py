"""What the tests of the add-on have in common: small morph objects, and their pictures as arrays."""

import bpy
import numpy as np


def add(kind, size=48, points=400):
    """Add a small morph object; it is the active one."""
    bpy.ops.object.ifs_morph_add(kind=kind)
    owner = bpy.context.object
    output = owner.ifs_morph.output
    output.resolution = size, size
    output.point_count = points
    owner.ifs_morph.locus.resolution = 64
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = 1, 24
    show()
    return owner


def show():
    """Have Blender evaluate what was edited."""
    bpy.context.view_layer.update()


def activate(owner):
    """Make an object the active one and the only one selected."""
    bpy.ops.object.select_all(action="DESELECT")
    owner.select_set(True)
    bpy.context.view_layer.objects.active = owner


def pixels(image):
    """Pixels (H, W, 4) of an image."""
    flat = np.empty(4 * image.size[0] * image.size[1], dtype=np.float32)
    image.pixels.foreach_get(flat)
    return flat.reshape(image.size[1], image.size[0], 4)


def picture(owner):
    """Pixels of the output of an image plane."""
    return pixels(owner.ifs_morph.output.image)


def attribute(owner, name):
    """Values of an attribute of a point cloud."""
    field, width, dtype = {
        "position": ("vector", 3, np.float32),
        "color": ("color", 4, np.float32),
        "radius": ("value", 1, np.float32),
        "attractorlet": ("value", 1, np.int32),
    }[name]
    values = np.empty(width * len(owner.data.vertices), dtype=dtype)
    owner.data.attributes[name].data.foreach_get(field, values)
    return values.reshape(-1, width)


def content(owner):
    """All that the output of an object shows, as bytes."""
    if owner.ifs_morph.kind == "IMAGE":
        return picture(owner).tobytes()
    return b"".join(attribute(owner, name).tobytes() for name in ("position", "color", "radius", "attractorlet"))
