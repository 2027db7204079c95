"""The demo scenes that lie in the repository open with what was planned in them, and that still holds."""

import importlib
from pathlib import Path

import bpy
import pytest

from demo_scenes import SCENES
from tests.addon.support import content

FOLDER = Path(__file__).parents[2] / "demo_scenes"
VERSION = (5, 2)
"""Of the Blender that saved them; older ones need not read them."""


@pytest.mark.skipif(bpy.app.version < VERSION, reason="The scenes were saved by a later Blender.")
@pytest.mark.parametrize("name", SCENES)
def test_a_scene_is_finished(extension, name):
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / f"{name}.blend"))
    (owner,) = (each for each in bpy.data.objects if each.ifs_morph.kind != "NONE")
    bpy.context.view_layer.objects.active = owner
    addon, settings = extension.ifs_morph_addon, owner.ifs_morph
    assert addon.locus_picture.is_current(settings)
    assert settings.path.inputs == addon.conversion.path_fingerprint(settings)
    assert "all in one piece" in settings.path.report
    bpy.ops.ifs_morph.check_path()
    assert "all in one piece" in settings.path.report
    bpy.context.scene.frame_set(1)
    initial = content(owner)
    bpy.context.scene.frame_set(bpy.context.scene.frame_end)
    assert content(owner) != initial


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_stands_beside_its_script_and_still(name):
    assert importlib.import_module(f"demo_scenes.{name}").TITLE
    assert all((FOLDER / f"{name}.{kind}").exists() for kind in ("blend", "png"))
