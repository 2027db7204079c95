"""What is done when Blender has evaluated a frame or an edit, loaded a file, or undone something.

Handlers only touch what `outputs` shows. They run for viewports and for renders, in whatever thread that is.
"""

import bpy
from bpy.app.handlers import persistent

from . import outputs, preparation
from .conversion import fit_window

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


def on_prepared():
    """Show what had to wait for kernels."""
    outputs.forget()
    for owner in bpy.data.objects:
        if outputs.is_editable(owner):
            fit_window(owner)
        owner.update_tag()


HANDLERS = {
    "frame_change_post": on_frame,
    "depsgraph_update_post": on_edit,
    "load_post": on_other_data,
    "undo_post": on_other_data,
    "redo_post": on_other_data,
}


def register():
    """Attach the handlers, and have the kernels prepared that they need."""
    for event, handler in HANDLERS.items():
        getattr(bpy.app.handlers, event).append(handler)
    preparation.begin(on_prepared)


def unregister():
    """Take them off, and forget what is shown."""
    preparation.end()
    for event, handler in HANDLERS.items():
        getattr(bpy.app.handlers, event).remove(handler)
    outputs.forget()
