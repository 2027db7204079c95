"""Compute the connectedness locus of a morph, and show it in an Image Editor."""

import bpy

from ...core.connectedness import Connectedness
from .. import locus_picture
from ..tasks import LongTask
from .poll import editable_morph, sound_morph


class IFSMORPH_OT_compute_locus(LongTask, bpy.types.Operator):
    """Find for which (u,v) the shape is in one piece, and keep a picture of it"""

    bl_idname = "ifs_morph.compute_locus"
    bl_label = "Compute Locus"
    bl_options = {"REGISTER", "UNDO"}

    poll = classmethod(sound_morph)

    def work(self, context):
        """Compute, then keep the picture."""
        locus = yield from locus_picture.compute_steps(context.object)
        self.report(
            {"INFO"}, f"The shape is connected at {100 * locus.share(Connectedness.CONNECTED):.1f} % of the locus"
        )


class IFSMORPH_OT_show_locus(bpy.types.Operator):
    """Show the locus in an Image Editor, in a window of its own if there is no Image Editor"""

    bl_idname = "ifs_morph.show_locus"
    bl_label = "Show Locus"

    @classmethod
    def poll(cls, context):
        """Need a locus."""
        if not editable_morph(cls, context):
            return False
        if context.object.ifs_morph.locus.image is None:
            cls.poll_message_set("Compute the locus first")
            return False
        return not bpy.app.background

    def execute(self, context):
        """Use an Image Editor that is open, or open one."""
        area = next((area for area in context.screen.areas if area.type == "IMAGE_EDITOR"), None)
        if area is None:
            bpy.ops.wm.window_new()
            area = context.window_manager.windows[-1].screen.areas[0]
            area.type = "IMAGE_EDITOR"
        area.spaces.active.image = context.object.ifs_morph.locus.image
        return {"FINISHED"}


CLASSES = (IFSMORPH_OT_compute_locus, IFSMORPH_OT_show_locus)


def register():
    """Register the operators."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    """Unregister the operators and let go of the last locus."""
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    locus_picture.forget()
