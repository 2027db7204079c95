"""Files of shapes in the File menu, and the buttons for files and the clipboard beside a shape."""

import bpy


def draw_file_buttons(layout, end: str) -> None:
    """Draw the buttons that bring a shape in and take it out."""
    layout.operator("ifs_morph.import_shapes", text="", icon="IMPORT").target = end
    layout.operator("ifs_morph.export_shapes", text="", icon="EXPORT").shapes = {end}
    layout.operator("ifs_morph.paste_shape", text="", icon="PASTEDOWN").end = end
    layout.operator_menu_enum("ifs_morph.copy_shape", "format", text="", icon="COPYDOWN").end = end


def _draw_in_import_menu(self, context):
    self.layout.operator("ifs_morph.import_shapes", text="IFS or Fractal Flame (.ifs/.flame)")


def _draw_in_export_menu(self, context):
    self.layout.operator("ifs_morph.export_shapes", text="IFS or Fractal Flame (.ifs/.flame)")


def register():
    """Add the entries of the File menu."""
    bpy.types.TOPBAR_MT_file_import.append(_draw_in_import_menu)
    bpy.types.TOPBAR_MT_file_export.append(_draw_in_export_menu)


def unregister():
    """Remove them."""
    bpy.types.TOPBAR_MT_file_export.remove(_draw_in_export_menu)
    bpy.types.TOPBAR_MT_file_import.remove(_draw_in_import_menu)
