"""Presets of the settings of an output."""

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ..operators.poll import editable_morph

FOLDER = "ifs_morph/output"

STORED = (
    "mode",
    "resolution",
    "antialiasing",
    "color",
    "background",
    "curve",
    "exposure",
    "gamma",
    "fit_window",
    "point_count",
    "point_radius",
    "point_color",
)
"""What a preset holds: what may be wanted again for another shape. A window belongs to its shape."""


class IFSMORPH_PT_output_presets(PresetPanel, bpy.types.Panel):
    """Presets of the output"""

    bl_label = "Output Presets"
    preset_subdir = FOLDER
    preset_operator = "script.execute_preset"
    preset_add_operator = "ifs_morph.output_preset_add"


class IFSMORPH_OT_output_preset_add(AddPresetBase, bpy.types.Operator):
    """Keep the settings of this output as a preset, or remove the active preset"""

    bl_idname = "ifs_morph.output_preset_add"
    bl_label = "Add Output Preset"
    preset_menu = "IFSMORPH_PT_output_presets"
    preset_subdir = FOLDER
    preset_defines = ["output = bpy.context.object.ifs_morph.output"]
    preset_values = [f"output.{name}" for name in STORED]

    poll = classmethod(editable_morph)


register, unregister = bpy.utils.register_classes_factory((IFSMORPH_PT_output_presets, IFSMORPH_OT_output_preset_add))
