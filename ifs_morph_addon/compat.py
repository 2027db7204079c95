"""Every difference between the Blender versions that are supported, and nothing else."""

import bpy

NOTICES_IMAGES = bpy.app.version >= (5, 2)
"""Whether Cycles with Persistent Data sees new pixels in an image; before, only another image is seen."""


def use_nodes(material):
    """Give a new material its node tree; since 5.0 it always has one, and asking is deprecated."""
    if bpy.app.version < (5, 0):
        material.use_nodes = True


def fcurves(owner):
    """All F-curves of a datablock's own action: a collection with ``find`` and ``remove``, or None.

    Since 4.4 an action holds them by slot, in layers.
    """
    data = owner.animation_data
    if data is None or data.action is None:
        return None
    if bpy.app.version < (4, 4):
        return data.action.fcurves
    for layer in data.action.layers:
        for strip in layer.strips:
            bag = strip.channelbag(data.action_slot) if data.action_slot else None
            if bag is not None:
                return bag.fcurves
    return None


def ensure_fcurve(owner, data_path, index):
    """F-curve of one property of a datablock, made with its action and slot where they do not exist."""
    data = owner.animation_data or owner.animation_data_create()
    if data.action is None:
        data.action = bpy.data.actions.new(f"{owner.name}Action")
    if bpy.app.version < (4, 4):
        curve = data.action.fcurves.find(data_path, index=index)
        return curve or data.action.fcurves.new(data_path, index=index)
    return data.action.fcurve_ensure_for_datablock(owner, data_path, index=index)
