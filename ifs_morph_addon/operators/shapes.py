"""Load a shape of the library as the initial or the final one."""

import bpy

from ...core.ifs import IFSError
from ...core.recurrent_shapes import RECURRENT_SHAPES
from ...core.shapes import SHAPES
from ...core.space.shapes import SPACE_SHAPES
from ..conversion import fit_window, write_shape
from .poll import ENDS, editable_morph, shape_of


class IFSMORPH_OT_load_shape(bpy.types.Operator):
    """Replace the maps of this shape by those of a shape from the library"""

    bl_idname = "ifs_morph.load_shape"
    bl_label = "Load Shape"
    bl_options = {"REGISTER", "UNDO"}

    end: bpy.props.EnumProperty(name="End", description="Which shape to replace", items=ENDS)
    shape: bpy.props.StringProperty(name="Shape", description="Name of a shape in the library", default="gasket")

    poll = classmethod(editable_morph)

    def execute(self, context):
        """Replace the maps."""
        library = SHAPES | RECURRENT_SHAPES | SPACE_SHAPES
        if self.shape not in library:
            names = ", ".join(library)
            self.report({"ERROR"}, f"The library has no shape “{self.shape}”; it has {names}.")
            return {"CANCELLED"}
        try:
            write_shape(shape_of(self, context), library[self.shape])
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        fit_window(context.object)
        context.object.update_tag()
        return {"FINISHED"}


register, unregister = bpy.utils.register_classes_factory((IFSMORPH_OT_load_shape,))
