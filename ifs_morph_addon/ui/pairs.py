"""The list of pairs: which map becomes which, and how."""

import bpy

from ..conversion import has_pairs, pairs_problem
from ..pairs import described, line
from .sidebar import SidebarPanel
from .text import sentence


class IFSMORPH_UL_pairs(bpy.types.UIList):
    """Pairs of maps: what becomes what, through which symmetries, with how many turns, and whether it is locked."""

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0, flt_flag=0):
        """Draw one pair."""
        row = layout.row(align=True)
        row.label(text=line(item))
        row.prop(item, "locked", text="", icon="LOCKED" if item.locked else "UNLOCKED", emboss=False)


class IFSMORPH_PT_pairs(SidebarPanel, bpy.types.Panel):
    """Which map of the initial shape becomes which of the final one."""

    bl_label = "Pairs"
    bl_parent_id = "IFSMORPH_PT_main"

    def draw(self, context):
        """Draw the list, the buttons beside it, and the active pair."""
        layout = self.layout
        settings = context.object.ifs_morph
        matching = settings.matching
        row = layout.row(align=True)
        row.operator("ifs_morph.match_pairs", icon="SHADERFX")
        row.operator("ifs_morph.clear_pairs", text="", icon="X")
        if not has_pairs(settings):
            sentence(layout, context, "There are none: map k of the initial shape becomes map k of the final one.")
        problem = pairs_problem(settings)
        if problem:
            sentence(layout, context, problem, icon="ERROR")
        row = layout.row()
        row.template_list("IFSMORPH_UL_pairs", "", matching, "pairs", matching, "active_index", rows=7)
        column = row.column(align=True)
        column.operator("ifs_morph.pair_add", text="", icon="ADD")
        column.operator("ifs_morph.pair_remove", text="", icon="REMOVE")
        column.separator()
        for direction, icon in (("UP", "TRIA_UP"), ("DOWN", "TRIA_DOWN")):
            column.operator("ifs_morph.pair_swap", text="", icon=icon).direction = direction
        column.separator()
        for action, icon in (("LOCK", "LOCKED"), ("UNLOCK", "UNLOCKED")):
            column.operator("ifs_morph.pairs_lock", text="", icon=icon).action = action
        if 0 <= matching.active_index < len(matching.pairs):
            self.draw_pair(layout, context, matching.pairs[matching.active_index])

    def draw_pair(self, layout, context, item):
        """Draw the active pair: both words, with their buttons, the turns, and the symmetries in words."""
        column = layout.column(align=True)
        column.use_property_split = True
        column.use_property_decorate = False
        for end in ("INITIAL", "FINAL"):
            row = column.row(align=True)
            row.prop(item, end.lower())
            row.operator("ifs_morph.pair_symmetry", text="", icon="FILE_REFRESH").end = end
            row.operator("ifs_morph.pair_split", text="", icon="MOD_EXPLODE").end = end
            part = row.row(align=True)
            part.enabled = len(getattr(item, end.lower()).split()) > 1
            part.operator("ifs_morph.pair_join", text="", icon="AUTOMERGE_ON").end = end
        column.prop(item, "winding")
        symmetries = described(item)
        if symmetries:
            sentence(layout, context, f"{symmetries[0].upper()}{symmetries[1:]}.")


register, unregister = bpy.utils.register_classes_factory((IFSMORPH_UL_pairs,))
