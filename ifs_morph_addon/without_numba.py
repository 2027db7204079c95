"""The sidebar tab of a Blender without numba: one sentence that says what to do."""

import bpy


class IFSMORPH_PT_missing(bpy.types.Panel):
    """Says that numba is missing."""

    bl_label = "IFS Morph"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "IFS Morph"

    def draw(self, context):
        """Draw the sentence, broken into lines that fit a sidebar."""
        column = self.layout.column(align=True)
        column.label(text="IFS Morph needs the Python module", icon="ERROR")
        column.label(text="numba: install the zip for your", icon="BLANK1")
        column.label(text="platform, or numba for this Blender.", icon="BLANK1")


def register():
    """Register the panel."""
    bpy.utils.register_class(IFSMORPH_PT_missing)


def unregister():
    """Unregister the panel."""
    bpy.utils.unregister_class(IFSMORPH_PT_missing)
