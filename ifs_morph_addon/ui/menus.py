"""The entry of the Add menu and the library of shapes as menus."""

import bpy

from ...core.recurrent_shapes import RECURRENT_SHAPES
from ...core.shapes import SHAPES
from ...core.space.shapes import SPACE_SHAPES


class IFSMORPH_MT_add(bpy.types.Menu):
    """Kinds of objects that show a morph."""

    bl_idname = "IFSMORPH_MT_add"
    bl_label = "IFS Morph"

    def draw(self, context):
        """Draw one entry for each kind."""
        self.layout.operator_context = "INVOKE_REGION_WIN"
        self.layout.operator("object.ifs_morph_add", text="Image Plane", icon="FILE_IMAGE").kind = "IMAGE"
        self.layout.operator("object.ifs_morph_add", text="Point Cloud", icon="POINTCLOUD_DATA").kind = "POINTS"


class _Library:
    bl_label = "Library"

    def draw(self, context):
        """Draw one entry for each shape of the library."""
        self.draw_shapes(self.layout, SHAPES)
        self.layout.separator()
        self.layout.label(text="Recurrent")
        self.draw_shapes(self.layout, RECURRENT_SHAPES)
        self.layout.separator()
        in_space = self.layout.column()
        in_space.enabled = context.object is not None and context.object.ifs_morph.kind == "POINTS"
        in_space.label(text="In space" if in_space.enabled else "In space: for point clouds")
        self.draw_shapes(in_space, SPACE_SHAPES)

    def draw_shapes(self, layout, shapes):
        """Draw one entry for each of some shapes."""
        for name, ifs in shapes.items():
            maps = "map" if ifs.count == 1 else "maps"
            text = f"{name[0].upper()}{name[1:]}  ({ifs.count} {maps})"
            button = layout.operator("ifs_morph.load_shape", text=text)
            button.shape, button.end = name, self.end


class IFSMORPH_MT_library_initial(_Library, bpy.types.Menu):
    """Shapes to start from."""

    bl_idname = "IFSMORPH_MT_library_initial"
    end = "INITIAL"


class IFSMORPH_MT_library_final(_Library, bpy.types.Menu):
    """Shapes to end with."""

    bl_idname = "IFSMORPH_MT_library_final"
    end = "FINAL"


CLASSES = (IFSMORPH_MT_add, IFSMORPH_MT_library_initial, IFSMORPH_MT_library_final)


def _draw_in_add_menu(self, context):
    self.layout.menu(IFSMORPH_MT_add.bl_idname, icon="OUTLINER_OB_POINTCLOUD")


def register():
    """Register the menus and add the entry."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.VIEW3D_MT_add.append(_draw_in_add_menu)


def unregister():
    """Remove the entry and unregister the menus."""
    bpy.types.VIEW3D_MT_add.remove(_draw_in_add_menu)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
