"""Presets of the output's settings."""

import os
from pathlib import Path

import bpy
import pytest

from tests.addon.support import add


@pytest.fixture
def preset(scene):
    yield "IFS test"
    if bpy.context.object is not None and bpy.ops.ifs_morph.output_preset_add.poll():
        bpy.ops.ifs_morph.output_preset_add(name="IFS test", remove_name=True)


def file_of(name, extension):
    folder = Path(os.environ["BLENDER_USER_RESOURCES"]) / "scripts" / "presets" / "ifs_morph" / "output"
    return folder / f"{name.replace(' ', '_')}.py"


def test_a_preset_brings_all_its_settings_back(preset, extension):
    output = add("IMAGE").ifs_morph.output
    output.mode, output.resolution, output.exposure = "DENSITY", (320, 180), 1.5
    output.background = 0.25, 0.5, 0.75, 1.0
    bpy.ops.ifs_morph.output_preset_add(name=preset)
    assert file_of(preset, extension).exists()
    other = add("IMAGE").ifs_morph.output
    assert other.mode != "DENSITY"
    bpy.ops.script.execute_preset(filepath=str(file_of(preset, extension)), menu_idname="IFSMORPH_PT_output_presets")
    assert (other.mode, tuple(other.resolution), other.exposure) == ("DENSITY", (320, 180), 1.5)
    assert tuple(other.background) == (0.25, 0.5, 0.75, 1.0)


def test_presets_hold_properties_that_are_there(scene, extension):
    output = add("IMAGE").ifs_morph.output
    stored = extension.ifs_morph_addon.ui.presets.STORED
    assert all(hasattr(output, name) for name in stored)
    assert "window" not in stored


def test_presets_can_be_removed(preset, extension):
    add("IMAGE")
    bpy.ops.ifs_morph.output_preset_add(name=preset)
    bpy.ops.ifs_morph.output_preset_add(name=preset, remove_name=True)
    assert not file_of(preset, extension).exists()
