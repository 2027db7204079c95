"""The sidebar tab in the Image Editor, beside the picture of the locus."""

import bpy

from ..conversion import state_sentence
from ..editors.locus_space import owner_of_locus
from .panels import draw_locus_state
from .text import sentence


class IFSMORPH_PT_on_locus(bpy.types.Panel):
    """The place in the morph, and the path through the locus"""

    bl_label = "IFS Morph"
    bl_space_type = "IMAGE_EDITOR"
    bl_region_type = "UI"
    bl_category = "IFS Morph"

    @classmethod
    def poll(cls, context):
        """Show beside the locus of the active morph only."""
        return owner_of_locus(context) is not None

    def draw(self, context):
        """Draw the place, what the shape is there, and the buttons for the locus and the path."""
        layout = self.layout
        layout.use_property_split = True
        settings = context.object.ifs_morph
        column = layout.column(align=True)
        column.prop(settings, "uv", index=0, text="U")
        column.prop(settings, "uv", index=1, text="V")
        column.prop(settings, "swell")
        sentence(layout, context, state_sentence(settings))
        column = layout.column()
        column.use_property_decorate = False
        column.prop(settings.locus, "live")
        column.operator("ifs_morph.compute_locus", icon="IMAGE_DATA")
        draw_locus_state(column, context)
        column = layout.column(align=True)
        column.operator("ifs_morph.plan_path", icon="ANIM")
        column.operator("ifs_morph.check_path", icon="CHECKMARK")
        column.operator("ifs_morph.remove_path_keys", icon="KEYFRAME")
        column.operator("ifs_morph.clear_path", icon="X")
        column = layout.column(align=True)
        column.active = False
        for line in (
            "Drag the cross: morph",
            "Drag a key: move the path",
            "Ctrl-click the path: add a key",
            "X: remove",
        ):
            column.label(text=line)


register, unregister = bpy.utils.register_classes_factory((IFSMORPH_PT_on_locus,))
