"""The panel of the path through the locus, and of the paths that maps have beside it."""

import bpy

from .. import fcurves
from .sidebar import SidebarPanel
from .text import sentence


class IFSMORPH_PT_path(SidebarPanel, bpy.types.Panel):
    """The path through the locus."""

    bl_label = "Path"
    bl_parent_id = "IFSMORPH_PT_main"

    def draw(self, context):
        """Draw the settings and the buttons."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        path = context.object.ifs_morph.path
        layout.prop(path, "method")
        column = layout.column(align=True)
        column.prop(path, "frame_start")
        column.prop(path, "frame_end")
        column = layout.column(align=True)
        column.operator("ifs_morph.plan_path", icon="ANIM")
        column.operator("ifs_morph.key_straight", icon="IPO_LINEAR")
        row = layout.row(align=True)
        row.operator("ifs_morph.check_path", icon="CHECKMARK")
        row.operator("ifs_morph.clear_path", icon="X")


class IFSMORPH_PT_offsets(SidebarPanel, bpy.types.Panel):
    """How far each map is from the path of all."""

    bl_label = "Offsets of the Maps"
    bl_parent_id = "IFSMORPH_PT_path"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        """Draw two numbers a map, which can be keyed."""
        layout = self.layout
        settings = context.object.ifs_morph
        sentence(layout, context, "How much further in u and in v each map is than the path.")
        layout.use_property_split = True
        count = len(settings.matching.pairs) or len(settings.final.maps)
        for k in range(min(count, fcurves.MOST_OFFSETS)):
            column = layout.column(align=True)
            column.prop(settings, "offset_u", index=k, text=f"{k + 1}  U")
            column.prop(settings, "offset_v", index=k, text="V")
