"""Operators do what they say, report what they cannot do, and change nothing then."""

import math

import bpy
import numpy as np
import pytest

from core.affine import from_parameters
from core.connectedness import Connectedness
from core.locus import compute_locus
from core.morph import Morph
from core.path import plan_path
from core.report import check_frames
from core.shapes import SHAPES
from tests.addon.support import activate, add, pixels, show

ENDS = ("INITIAL", "FINAL")


def maps(shape):
    return np.array([item.matrix for item in shape.maps])


def curves(extension, owner):
    return extension.ifs_morph_addon.fcurves.path_curves(owner)


@pytest.mark.parametrize("kind", ["IMAGE", "POINTS"])
def test_added_object_is_framed_lit_and_upright(scene, kind):
    owner = add(kind)
    assert bpy.context.object == owner
    assert owner.select_get()
    assert scene.camera is not None
    assert any(thing.type == "LIGHT" for thing in scene.objects) == (kind == "POINTS")
    assert scene.render.use_lock_interface
    corners = [owner.matrix_world @ type(scene.camera.location)(corner) for corner in owner.bound_box]
    show()
    from bpy_extras.object_utils import world_to_camera_view

    seen = np.array([world_to_camera_view(scene, scene.camera, corner) for corner in corners])
    assert (seen[:, :2] >= 0).all()
    assert (seen[:, :2] <= 1).all()
    assert (seen[:, 2] > 0).all()
    normal = owner.matrix_world.to_quaternion() @ type(scene.camera.location)((0, 0, 1))
    np.testing.assert_allclose(normal, (0, -1, 0), atol=1e-6)


def test_added_object_leaves_a_camera_and_a_light_alone(scene):
    add("POINTS")
    camera, things = scene.camera, len(scene.objects)
    add("POINTS")
    assert scene.camera == camera
    assert len(scene.objects) == things + 1


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("name", ["terdragon", "Barnsley fern", "Heighway dragon"])
def test_shapes_of_the_library_are_loaded(scene, extension, end, name):
    owner = add("IMAGE")
    assert bpy.ops.ifs_morph.load_shape(end=end, shape=name) == {"FINISHED"}
    shape = getattr(owner.ifs_morph, end.lower())
    np.testing.assert_allclose(maps(shape), SHAPES[name].maps, atol=1e-6)
    ifs = extension.ifs_morph_addon.conversion.shape_ifs(shape)
    np.testing.assert_allclose(ifs.weights, SHAPES[name].weights, rtol=1e-5)
    assert shape.name == name


def test_unknown_shape_is_refused(scene):
    owner = add("IMAGE")
    before = maps(owner.ifs_morph.initial)
    with pytest.raises(RuntimeError, match="no shape “nothing”"):
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="nothing")
    np.testing.assert_array_equal(maps(owner.ifs_morph.initial), before)


@pytest.mark.parametrize("end", ENDS)
def test_maps_are_added_duplicated_moved_and_removed(scene, end):
    owner = add("IMAGE")
    shape = getattr(owner.ifs_morph, end.lower())
    before = maps(shape)
    shape.active_index = 1
    shape.maps[1].weight = 0.25
    bpy.ops.ifs_morph.map_duplicate(end=end)
    np.testing.assert_array_equal(maps(shape), before[[0, 1, 1, 2]])
    assert shape.active_index == 2
    assert shape.maps[2].weight == 0.25
    bpy.ops.ifs_morph.map_move(end=end, direction="DOWN")
    np.testing.assert_array_equal(maps(shape), before[[0, 1, 2, 1]])
    with pytest.raises(RuntimeError, match="end of the list"):
        bpy.ops.ifs_morph.map_move(end=end, direction="DOWN")
    bpy.ops.ifs_morph.map_move(end=end, direction="UP")
    bpy.ops.ifs_morph.map_move(end=end, direction="UP")
    assert shape.active_index == 1
    bpy.ops.ifs_morph.map_remove(end=end)
    np.testing.assert_array_equal(maps(shape), before)
    bpy.ops.ifs_morph.map_add(end=end)
    assert len(shape.maps) == 4
    for _ in range(4):
        bpy.ops.ifs_morph.map_remove(end=end)
    with pytest.raises(RuntimeError, match="no active map"):
        bpy.ops.ifs_morph.map_remove(end=end)


def test_maps_are_edited_as_rotation_scale_and_shear(scene):
    item = add("IMAGE").ifs_morph.initial.maps[0]
    item.rotation, item.scale, item.shear, item.translation = 0.4, (0.6, -0.3), 0.2, (1.5, -2)
    np.testing.assert_allclose(item.matrix, from_parameters([0.4, 0.6, -0.3, 0.2, 1.5, -2]), atol=1e-6)
    assert math.isclose(item.rotation, 0.4, abs_tol=1e-6)
    np.testing.assert_allclose(item.scale, (0.6, -0.3), atol=1e-6)
    item.matrix = ((0.5, 0, 3), (0, 0.25, 4))
    np.testing.assert_allclose([*item.scale, item.shear, *item.translation], [0.5, 0.25, 0, 3, 4], atol=1e-7)


def test_winding_turns_maps(scene, extension):
    settings = add("IMAGE").ifs_morph
    settings.final.maps[2].winding = -1
    morph = extension.ifs_morph_addon.conversion.morph_of(settings)
    expected = Morph(SHAPES["turned gasket"], SHAPES["gasket"], winding=[0, 0, -1])
    np.testing.assert_allclose(morph.at(0.4, 0.4).maps, expected.at(0.4, 0.4).maps, atol=1e-6)


def test_locus_is_that_of_core(scene):
    owner = add("IMAGE")
    assert bpy.ops.ifs_morph.compute_locus() == {"FINISHED"}
    locus = compute_locus(Morph(SHAPES["turned gasket"], SHAPES["gasket"]), 64)
    image = owner.ifs_morph.locus.image
    np.testing.assert_allclose(pixels(image), locus.picture(), atol=1 / 255)
    assert image.packed_file is not None
    u, v = np.array(image.ifs_morph_locus.lowest) + image.ifs_morph_locus.spacing * (np.array(image.size) - 1)
    assert (u, v) == pytest.approx((locus.u[-1], locus.v[-1]))


def test_locus_is_replaced_and_known_to_be_out_of_date(scene, extension):
    owner = add("IMAGE")
    fingerprint = extension.ifs_morph_addon.conversion.locus_fingerprint
    bpy.ops.ifs_morph.compute_locus()
    images = len(bpy.data.images)
    first = owner.ifs_morph.locus.image.name
    assert owner.ifs_morph.locus.inputs == fingerprint(owner.ifs_morph)
    owner.ifs_morph.scheme = "ELEMENTWISE"
    assert owner.ifs_morph.locus.inputs != fingerprint(owner.ifs_morph)
    bpy.ops.ifs_morph.compute_locus()
    assert owner.ifs_morph.locus.inputs == fingerprint(owner.ifs_morph)
    assert (len(bpy.data.images), owner.ifs_morph.locus.image.name) == (images, first)


def test_locus_without_extent_is_refused(scene):
    owner = add("IMAGE")
    owner.ifs_morph.locus.domain = 1, 0
    with pytest.raises(RuntimeError, match="domain"):
        bpy.ops.ifs_morph.compute_locus()
    assert owner.ifs_morph.locus.image is None


def test_cancelled_work_changes_nothing(scene, extension, monkeypatch):
    owner = add("IMAGE")
    operators = extension.ifs_morph_addon.operators

    def interrupted(settings):
        yield 0.5
        raise operators.locus.IFSError("stopped")

    monkeypatch.setattr(operators.locus, "locus_steps", interrupted)
    with pytest.raises(RuntimeError, match="stopped"):
        bpy.ops.ifs_morph.compute_locus()
    assert owner.ifs_morph.locus.image is None
    assert owner.ifs_morph.locus.inputs == ""


@pytest.mark.parametrize("method", ["PLANNED", "STRAIGHT", "STRAIGHT_UNSWOLLEN"])
def test_keyed_path_is_that_of_core(scene, extension, method):
    owner = add("IMAGE")
    owner.ifs_morph.path.method = method
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = 11, 50
    assert bpy.ops.ifs_morph.plan_path() == {"FINISHED"}
    morph = extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph)
    locus = compute_locus(morph, 64) if method == "PLANNED" else None
    path = plan_path(morph, locus, 40, method=method.lower().replace("_", " "))
    for frame in (5, *np.linspace(11, 50, 79), 60):
        scene.frame_set(int(frame), subframe=frame - int(frame))
        settings = owner.ifs_morph
        np.testing.assert_allclose(
            (*settings.uv, settings.swell), path.at((frame - 11) / 39), atol=2e-5, err_msg=str(frame)
        )
    assert owner.ifs_morph.path.report == path.report.text()


def test_straight_path_takes_two_keys_and_leaves_other_animation(scene, extension):
    owner = add("IMAGE")
    owner.keyframe_insert("location", index=0, frame=3)
    owner.ifs_morph.path.method = "PLANNED"
    bpy.ops.ifs_morph.plan_path()
    bpy.ops.ifs_morph.key_straight()
    u, v, swell = curves(extension, owner)
    assert [len(curve.keyframe_points) for curve in (u, v, swell)] == [2, 2, 2]
    assert "in pieces" in owner.ifs_morph.path.report
    others = extension.ifs_morph_addon.compat.fcurves(owner)
    assert others.find("location", index=0) is not None
    assert len(others) == 4
    bpy.ops.ifs_morph.clear_path()
    assert curves(extension, owner) == [None] * 3
    assert len(extension.ifs_morph_addon.compat.fcurves(owner)) == 1
    assert owner.ifs_morph.path.report == ""
    assert not bpy.ops.ifs_morph.clear_path.poll()


def test_two_objects_share_no_path(scene):
    first = add("IMAGE")
    bpy.ops.ifs_morph.key_straight()
    second = add("IMAGE")
    scene.frame_set(24)
    assert tuple(first.ifs_morph.uv) == (1, 1)
    assert tuple(second.ifs_morph.uv) == (0, 0)


def test_check_reads_the_keys_and_moves_no_frame(scene, extension):
    owner = add("IMAGE")
    bpy.ops.ifs_morph.key_straight()
    u, v, _ = curves(extension, owner)
    for curve in (u, v):
        curve.keyframe_points[1].co.y = 0.0
        for point in curve.keyframe_points:
            point.handle_left.y = point.handle_right.y = 0.0
        curve.update()
    scene.frame_set(7)
    assert bpy.ops.ifs_morph.check_path() == {"FINISHED"}
    assert scene.frame_current == 7
    morph = extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph)
    still = check_frames(morph, np.zeros((24, 3)))
    assert still.count(Connectedness.CONNECTED) == 24
    assert owner.ifs_morph.path.report == still.text()


def test_path_that_cannot_be_keyed_says_why(scene, extension):
    owner = add("IMAGE")
    assert not bpy.ops.ifs_morph.check_path.poll()
    owner.ifs_morph.path.frame_end = 1
    assert not bpy.ops.ifs_morph.plan_path.poll()
    owner.ifs_morph.path.frame_end = 24
    bpy.ops.ifs_morph.key_straight()
    obstacle = extension.ifs_morph_addon.fcurves.obstacle
    curve = curves(extension, owner)[0]
    curve.lock = True
    assert "locked" in obstacle(owner)
    assert not bpy.ops.ifs_morph.plan_path.poll()
    assert not bpy.ops.ifs_morph.clear_path.poll()
    curve.lock = False
    assert bpy.ops.ifs_morph.plan_path.poll()
    owner.driver_add("ifs_morph.swell")
    assert "driver" in obstacle(owner)
    assert not bpy.ops.ifs_morph.key_straight.poll()


def test_operators_need_a_morph(scene):
    owner = add("IMAGE")
    activate(scene.camera)
    names = [name for name in dir(bpy.ops.ifs_morph) if name != "show_locus"]
    assert len(names) >= 10
    assert not any(getattr(bpy.ops.ifs_morph, name).poll() for name in names)
    activate(owner)
    assert bpy.ops.ifs_morph.load_shape.poll()
    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.object.ifs_morph_add.poll()
    bpy.ops.object.mode_set(mode="OBJECT")


def test_locus_outside_the_ends_does_not_hinder_the_path(scene):
    owner = add("IMAGE")
    owner.ifs_morph.locus.domain = 0.25, 0.75
    assert bpy.ops.ifs_morph.plan_path() == {"FINISHED"}
    assert "all in one piece" in owner.ifs_morph.path.report
