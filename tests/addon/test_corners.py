"""Maps changed by the corners of their triangles."""

import bpy
import numpy as np
import pytest

from core.affine import transform
from tests.addon.support import activate, add, content, show


@pytest.fixture
def owner(scene):
    return add("IMAGE")


@pytest.fixture
def corners(extension):
    return extension.ifs_morph_addon.corners


def matrix(owner, index=1, end="initial"):
    return np.array(getattr(owner.ifs_morph, end).maps[index].matrix)


def test_corners_are_images_of_the_unit_triangle(owner, corners):
    places = corners.places(owner)
    assert places.shape == (3, 4, 2)
    for index in range(3):
        expected = transform(matrix(owner, index), [(0, 0), (1, 0), (0, 1)])
        np.testing.assert_allclose(places[index, :3], expected, atol=1e-6)
        np.testing.assert_allclose(places[index, 3], expected.mean(axis=0), atol=1e-6)


def test_the_triangle_is_as_large_as_the_shape(owner, corners):
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Barnsley fern")
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape="Barnsley fern")
    assert corners.unit_triangle(owner).max() == 8


@pytest.mark.parametrize("corner", [0, 1, 2])
def test_a_dragged_corner_is_where_it_was_dragged_to_and_the_others_stay(owner, corners, corner):
    before = corners.places(owner)
    place = before[1, corner] + (0.1, -0.05)
    bpy.ops.ifs_morph.drag_map(end="INITIAL", index=1, corner=corners.NAMES[corner], place=place)
    expected = before.copy()
    expected[1, corner] = place
    expected[1, 3] = expected[1, :3].mean(axis=0)
    np.testing.assert_allclose(corners.places(owner), expected, atol=1e-6)


def test_the_middle_moves_the_whole_map(owner, corners):
    before, linear = corners.places(owner), matrix(owner)[:, :2]
    bpy.ops.ifs_morph.drag_map(end="INITIAL", index=1, corner="WHOLE", place=before[1, 3] + (0.2, 0.1))
    np.testing.assert_allclose(corners.places(owner)[1], before[1] + (0.2, 0.1), atol=1e-6)
    np.testing.assert_allclose(matrix(owner)[:, :2], linear, atol=1e-6)


def test_any_affine_map_can_be_made(owner):
    """A reflection with shear, which no other widget of Blender's makes."""
    for corner, place in (("ORIGIN", (0.1, 0.2)), ("X", (0.5, 0.3)), ("Y", (0.3, -0.1))):
        bpy.ops.ifs_morph.drag_map(end="FINAL", index=0, corner=corner, place=place)
    np.testing.assert_allclose(matrix(owner, 0, "final"), [[0.4, 0.2, 0.1], [0.1, -0.3, 0.2]], atol=1e-6)


def test_the_picture_follows(owner):
    before = content(owner)
    bpy.ops.ifs_morph.drag_map(end="INITIAL", index=0, corner="WHOLE", place=(0.4, 0.4))
    show()
    assert content(owner) != before


def test_the_window_waits_for_the_end_of_a_drag(owner, extension):
    options = extension.ifs_morph_addon.property_options
    before = tuple(owner.ifs_morph.output.window)
    options.hold_window(owner)
    owner.ifs_morph.initial.maps[0].translation = 3, 0
    assert tuple(owner.ifs_morph.output.window) == before
    options.release_window(owner)
    assert owner.ifs_morph.output.window[2] > before[2] + 1
    owner.ifs_morph.initial.maps[0].translation = 0, 0
    assert owner.ifs_morph.output.window[2] < before[2] + 1


def test_a_map_that_is_not_there_is_refused(owner):
    with pytest.raises(RuntimeError, match="has 3 maps"):
        bpy.ops.ifs_morph.drag_map(end="INITIAL", index=3, corner="X", place=(0, 0))


def test_editing_shows_the_edited_shape_while_nothing_is_keyed(owner):
    settings = owner.ifs_morph
    settings.uv, settings.swell = (0.5, 0.5), 0.1
    settings.edited_end = "FINAL"
    assert tuple(settings.uv) == (0.5, 0.5)
    settings.edit_maps = True
    assert (tuple(settings.uv), settings.swell) == ((1, 1), 0)
    settings.edited_end = "INITIAL"
    assert tuple(settings.uv) == (0, 0)


def test_editing_leaves_the_frame_of_a_keyed_path(owner, scene):
    bpy.ops.ifs_morph.key_straight()
    scene.frame_set(12)
    before = tuple(owner.ifs_morph.uv)
    owner.ifs_morph.edit_maps = True
    owner.ifs_morph.edited_end = "FINAL"
    assert tuple(owner.ifs_morph.uv) == before


def test_placing_is_undone_by_its_inverse(owner, extension):
    placing = extension.ifs_morph_addon.outputs.placing
    window = (-2.0, 1.0, 5.0, 3.0)
    places = np.random.default_rng(0).uniform(-3, 3, (20, 2))
    np.testing.assert_allclose(placing.in_plane(placing.in_object(places, window), window), places, atol=1e-5)


def test_triangles_show_while_they_are_edited(owner, scene, extension):
    edited_owner = extension.ifs_morph_addon.editors.map_space.edited_owner
    assert edited_owner(bpy.context) is None
    owner.ifs_morph.edit_maps = True
    assert edited_owner(bpy.context) == owner
    bpy.ops.object.mode_set(mode="EDIT")
    assert edited_owner(bpy.context) is None
    bpy.ops.object.mode_set(mode="OBJECT")
    activate(scene.camera)
    assert edited_owner(bpy.context) is None
