"""What is drawn and dragged in editors, in a Blender with a window only."""

import bpy

from . import locus_overlay

MODULES = (locus_overlay,)


def register():
    """Register what editors draw, unless there is no window to draw in."""
    if not bpy.app.background:
        for module in MODULES:
            module.register()


def unregister():
    """Unregister it."""
    if not bpy.app.background:
        for module in reversed(MODULES):
            module.unregister()
