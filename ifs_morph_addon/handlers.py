"""What Blender calls when it has evaluated a frame or an edit, loaded a file, or undone something.

Handlers only touch what `outputs` shows. They run for viewports and for renders, in whatever thread that is.
"""

import bpy
from bpy.app.handlers import persistent

from . import outputs

RELEVANT = ("OBJECT", "TEXTURE")
"""Kinds of datablocks whose edit may change a picture; a color ramp lives in a texture."""


@persistent
def on_frame(scene, depsgraph):
    """Show the attractors of the frame that was just evaluated."""
    outputs.refresh(depsgraph)


@persistent
def on_edit(scene, depsgraph):
    """Show the attractors as edited."""
    if any(depsgraph.id_type_updated(kind) for kind in RELEVANT):
        outputs.refresh(depsgraph)


@persistent
def on_other_data(*_):
    """Files hold no pixels of the pictures, and undo may have put older data in place: render all again."""
    outputs.forget()
    # In background nothing would be evaluated by itself.
    outputs.refresh(bpy.context.evaluated_depsgraph_get())


HANDLERS = {
    "frame_change_post": on_frame,
    "depsgraph_update_post": on_edit,
    "load_post": on_other_data,
    "undo_post": on_other_data,
    "redo_post": on_other_data,
}


def register():
    """Attach the handlers."""
    for event, handler in HANDLERS.items():
        getattr(bpy.app.handlers, event).append(handler)


def unregister():
    """Take them off, and forget what is shown."""
    for event, handler in HANDLERS.items():
        getattr(bpy.app.handlers, event).remove(handler)
    outputs.forget()
