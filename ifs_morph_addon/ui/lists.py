"""The lists of maps."""

import bpy


class IFSMORPH_UL_maps(bpy.types.UIList):
    """The maps of a shape, each with its color and name."""

    def draw_item(self, context, layout, data, item, icon, active_data, active_property, index=0, flt_flag=0):
        """Draw one map."""
        row = layout.row(align=True)
        swatch = row.row()
        swatch.ui_units_x = 1.2
        swatch.prop(item, "color", text="")
        row.prop(item, "name", text="", emboss=False)


register, unregister = bpy.utils.register_classes_factory((IFSMORPH_UL_maps,))
