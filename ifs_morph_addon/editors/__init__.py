"""What is drawn in editors and dragged there."""

import bpy

from . import locus_handles, locus_overlay, map_editing, map_triangles, path_editing

OPERATORS = (map_editing, path_editing)
IN_WINDOW = (map_triangles, locus_overlay, locus_handles)
"""What needs a window to be drawn in, and is left out of a Blender that has none."""


def register():
    """Register the operators, and what editors draw."""
    for module in _modules():
        module.register()


def unregister():
    """Unregister them."""
    for module in reversed(_modules()):
        module.unregister()


def _modules():
    return OPERATORS if bpy.app.background else OPERATORS + IN_WINDOW
