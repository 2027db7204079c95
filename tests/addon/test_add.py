"""Add > IFS Morph gives an object that a render shows at once, and what the render needs where it is missing."""

import bpy
import numpy as np
import pytest

from tests.addon.interface import reason
from tests.addon.support import attribute, picture, show

KINDS = ("IMAGE", "POINTS")


@pytest.mark.parametrize("kind", KINDS)
def test_default_morph_is_shown_at_once(scene, kind):
    assert bpy.ops.object.ifs_morph_add(kind=kind) == {"FINISHED"}
    owner = bpy.context.view_layer.objects.active
    show()
    settings = owner.ifs_morph
    assert owner.select_get()
    assert settings.kind == kind
    assert (settings.initial.name, settings.final.name) == ("turned gasket", "gasket")
    assert [len(shape.maps) for shape in (settings.initial, settings.final)] == [3, 3]
    if kind == "IMAGE":
        assert 0.05 < np.mean(picture(owner)[..., 3] > 0) < 0.9
    else:
        assert len(attribute(owner, "position")) == settings.output.point_count
        assert len(np.unique(attribute(owner, "position"), axis=0)) > 1000


@pytest.mark.parametrize("kind", KINDS)
def test_path_spans_the_frames_of_the_scene(scene, kind):
    scene.frame_start, scene.frame_end = 7, 31
    bpy.ops.object.ifs_morph_add(kind=kind)
    path = bpy.context.view_layer.objects.active.ifs_morph.path
    assert (path.frame_start, path.frame_end) == (7, 31)


def _types(scene):
    return sorted(other.type for other in scene.objects)


def test_camera_and_light_are_added_where_missing(scene):
    bpy.ops.object.ifs_morph_add(kind="IMAGE")
    assert _types(scene) == ["CAMERA", "MESH"]
    assert scene.camera is not None
    bpy.ops.object.ifs_morph_add(kind="POINTS")
    assert _types(scene) == ["CAMERA", "LIGHT", "MESH", "MESH"]
    bpy.ops.object.ifs_morph_add(kind="POINTS")
    assert _types(scene) == ["CAMERA", "LIGHT", "MESH", "MESH", "MESH"]


def test_camera_and_light_that_are_there_are_kept(scene):
    camera = bpy.data.objects.new("Mine", bpy.data.cameras.new("Mine"))
    light = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
    for each in (camera, light):
        scene.collection.objects.link(each)
    scene.camera = camera
    bpy.ops.object.ifs_morph_add(kind="POINTS")
    assert scene.camera == camera
    assert _types(scene) == ["CAMERA", "LIGHT", "MESH"]


def test_camera_and_light_can_be_declined(scene):
    bpy.ops.object.ifs_morph_add(kind="POINTS", add_camera=False, add_light=False)
    assert _types(scene) == ["MESH"]
    assert scene.camera is None


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("resolution", [(64, 64), (90, 40), (40, 90)])
def test_camera_sees_all_of_the_fractal(scene, kind, resolution):
    from bpy_extras.object_utils import world_to_camera_view

    scene.render.resolution_x, scene.render.resolution_y = resolution
    scene.cursor.location = 1, 2, 3
    bpy.ops.object.ifs_morph_add(kind=kind, size=5)
    owner = bpy.context.view_layer.objects.active
    show()
    corners = [owner.matrix_world @ vertex.co for vertex in owner.data.vertices]
    if kind == "POINTS":
        corners = corners[:: len(corners) // 200]
    seen = np.array([world_to_camera_view(scene, scene.camera, corner) for corner in corners])
    assert (seen[:, :2] > 0).all()
    assert (seen[:, :2] < 1).all()
    # Most of the picture's shorter side is filled.
    assert np.ptp(seen[:, :2], axis=0).max() > 0.5


def test_object_is_placed_at_the_cursor_in_the_wanted_size(scene):
    scene.cursor.location = 1, 2, 3
    bpy.ops.object.ifs_morph_add(kind="IMAGE", size=4)
    owner = bpy.context.view_layer.objects.active
    show()
    corners = np.array([owner.matrix_world @ vertex.co for vertex in owner.data.vertices])
    np.testing.assert_allclose((corners.max(axis=0) + corners.min(axis=0)) / 2, (1, 2, 3), atol=1e-5)
    np.testing.assert_allclose(np.ptp(corners, axis=0).max(), 4, rtol=1e-5)


def test_operators_that_change_the_file_can_be_undone(scene):
    names = ["object.ifs_morph_add", *(f"ifs_morph.{name}" for name in dir(bpy.ops.ifs_morph))]
    assert len(names) > 8
    for name in names:
        group, function = name.split(".")
        if function in ("show_locus", "copy_shape", "export_shapes", "output_preset_add"):
            continue  # open an editor, fill the clipboard or write other files, and leave this one as it is
        operator = getattr(getattr(bpy.ops, group), function)
        assert "UNDO" in operator.bl_options, name
        assert operator.get_rna_type().description, name


def test_edit_mode_is_refused_with_a_reason(scene):
    bpy.ops.object.ifs_morph_add(kind="IMAGE")
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        assert "Object Mode" in reason(bpy.ops.object.ifs_morph_add, kind="IMAGE")
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
    assert reason(bpy.ops.object.ifs_morph_add) == ""


def test_buttons_ask_for_a_morph(scene):
    for name in ("load_shape", "map_add", "compute_locus", "plan_path", "check_path", "clear_path", "repair_output"):
        assert "Select an IFS Morph object" in reason(getattr(bpy.ops.ifs_morph, name)), name
