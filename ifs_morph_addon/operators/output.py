"""Mend an output whose parts were deleted or taken apart."""

import bpy

from .. import outputs
from ..conversion import fit_window
from .poll import editable_morph


class IFSMORPH_OT_repair_output(bpy.types.Operator):
    """Make the image, material, modifier and nodes anew where they are missing, and connect them"""

    bl_idname = "ifs_morph.repair_output"
    bl_label = "Repair Output"
    bl_options = {"REGISTER", "UNDO"}

    poll = classmethod(editable_morph)

    def execute(self, context):
        """Make what is missing, connect it, render again."""
        owner = context.object
        output = outputs.KINDS[owner.ifs_morph.kind]
        output.ensure(owner)
        output.repair(owner)
        fit_window(owner)
        outputs.forget()
        owner.update_tag()
        return {"FINISHED"}


CLASSES = (IFSMORPH_OT_repair_output,)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
