"""Maps as matrices and as turn, stretch and shear; and the lists of them."""

import math

import bpy
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core.affine import rotation
from core.shapes import SHAPES
from tests.addon.support import add, content, show

ENDS = {"INITIAL": "initial", "FINAL": "final"}


def _matrix(item):
    return np.array([list(row) for row in item.matrix])


@pytest.fixture
def owner(scene):
    return add("POINTS")


@pytest.fixture
def item(scene):
    """Give a map of an object that shows nothing, so that its many edits draw nothing."""
    return bpy.data.objects.new("Unseen", None).ifs_morph.initial.maps.add()


numbers = st.floats(-2, 2, width=32)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=30)
@given(
    angle=st.floats(-3.125, 3.125, width=32),
    scale=st.tuples(st.floats(0.125, 2, width=32), st.floats(0.125, 2, width=32)),
    reflect=st.booleans(),
    shear=numbers,
    translation=st.tuples(numbers, numbers),
)
def test_numbers_and_matrix_are_one(item, angle, scale, reflect, shear, translation):
    scale = scale[0], -scale[1] if reflect else scale[1]
    item.matrix = ((0.5, 0, 0), (0, 0.5, 0))
    item.rotation, item.scale, item.shear, item.translation = angle, scale, shear, translation
    np.testing.assert_allclose(item.rotation, angle, atol=1e-4)
    np.testing.assert_allclose(item.scale, scale, atol=1e-4)
    np.testing.assert_allclose(item.shear, shear, atol=2e-3)
    np.testing.assert_allclose(item.translation, translation, atol=1e-6)
    # The lengths that the map gives to the axes, and where it takes the origin.
    matrix = _matrix(item)
    np.testing.assert_allclose(matrix[:, 2], translation, atol=1e-6)
    np.testing.assert_allclose(np.hypot(*matrix[:, 0]), scale[0], atol=1e-4)
    np.testing.assert_allclose(np.linalg.det(matrix[:, :2]), scale[0] * scale[1], atol=1e-3)
    np.testing.assert_allclose(matrix[:, 0], scale[0] * rotation(angle)[:, 0], atol=1e-4)


def test_one_number_leaves_the_others(owner):
    item = owner.ifs_morph.initial.maps[0]
    item.matrix = ((0.3, -0.2, 0.7), (0.1, 0.4, -0.9))
    before = item.rotation, tuple(item.scale), item.shear
    item.translation = 5, 6
    np.testing.assert_allclose(_matrix(item), [[0.3, -0.2, 5], [0.1, 0.4, 6]], rtol=1e-5)
    item.rotation += math.pi / 3
    np.testing.assert_allclose(item.rotation, before[0] + math.pi / 3, rtol=1e-5)
    np.testing.assert_allclose((*item.scale, item.shear), (*before[1], before[2]), rtol=1e-4)
    np.testing.assert_allclose(item.translation, (5, 6), rtol=1e-6)


def test_numbers_edit_the_picture(owner):
    seen = {content(owner)}
    item = owner.ifs_morph.initial.maps[1]
    for name, value in (("rotation", 0.5), ("scale", (0.4, 0.3)), ("shear", 0.2), ("translation", (0.3, 0.1))):
        setattr(item, name, value)
        show()
        seen.add(content(owner))
    assert len(seen) == 5


@pytest.mark.parametrize("end", ENDS)
def test_shapes_of_the_library_are_loaded(owner, end):
    shape, other = (
        getattr(owner.ifs_morph, name) for name in (ENDS[end], ENDS["FINAL" if end == "INITIAL" else "INITIAL"])
    )
    before = [_matrix(item).tolist() for item in other.maps]
    for name, ifs in SHAPES.items():
        assert bpy.ops.ifs_morph.load_shape(end=end, shape=name) == {"FINISHED"}
        assert shape.name == name
        np.testing.assert_array_equal([_matrix(item) for item in shape.maps], ifs.maps.astype(np.float32))
        assert shape.active_index == 0
    assert [_matrix(item).tolist() for item in other.maps] == before


def test_weights_of_the_library_are_kept(owner, extension):
    for name, ifs in SHAPES.items():
        bpy.ops.ifs_morph.load_shape(end="FINAL", shape=name)
        stored = extension.ifs_morph_addon.conversion.shape_ifs(owner.ifs_morph.final)
        np.testing.assert_allclose(stored.weights, ifs.weights, atol=1e-6, err_msg=name)


def test_unknown_shape_is_refused(owner):
    before = [item.name for item in owner.ifs_morph.initial.maps], owner.ifs_morph.initial.name
    with pytest.raises(RuntimeError, match="no shape “teapot”"):
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="teapot")
    assert ([item.name for item in owner.ifs_morph.initial.maps], owner.ifs_morph.initial.name) == before


@pytest.mark.parametrize("end", ENDS)
def test_adding_appends_and_selects(owner, end):
    shape = getattr(owner.ifs_morph, ENDS[end])
    bpy.ops.ifs_morph.map_add(end=end)
    assert len(shape.maps) == 4
    assert shape.active_index == 3
    np.testing.assert_array_equal(_matrix(shape.maps[3]), [[0.5, 0, 0], [0, 0.5, 0]])


@pytest.mark.parametrize("end", ENDS)
def test_removing_keeps_the_others_and_a_selection(owner, end):
    shape = getattr(owner.ifs_morph, ENDS[end])
    matrices = [_matrix(item) for item in shape.maps]
    shape.active_index = 1
    bpy.ops.ifs_morph.map_remove(end=end)
    np.testing.assert_array_equal([_matrix(item) for item in shape.maps], [matrices[0], matrices[2]])
    assert shape.active_index == 1
    bpy.ops.ifs_morph.map_remove(end=end)
    assert shape.active_index == 0
    np.testing.assert_array_equal([_matrix(item) for item in shape.maps], [matrices[0]])


def test_removing_from_an_empty_list_is_refused(owner):
    for _ in range(3):
        bpy.ops.ifs_morph.map_remove(end="FINAL")
    assert len(owner.ifs_morph.final.maps) == 0
    for operator in (bpy.ops.ifs_morph.map_remove, bpy.ops.ifs_morph.map_duplicate, bpy.ops.ifs_morph.map_move):
        try:
            assert operator(end="FINAL") == {"CANCELLED"}
        except RuntimeError as error:
            assert "Traceback" not in str(error)
    bpy.ops.ifs_morph.map_add(end="FINAL")
    assert owner.ifs_morph.final.active_index == 0


def test_duplicate_is_like_its_source_and_follows_it(owner):
    shape = owner.ifs_morph.initial
    source = shape.maps[1]
    source.weight, source.color, source.winding = 0.25, (1, 0.5, 0), 2
    shape.active_index = 1
    bpy.ops.ifs_morph.map_duplicate(end="INITIAL")
    assert (len(shape.maps), shape.active_index) == (4, 2)
    source, copy = shape.maps[1], shape.maps[2]
    np.testing.assert_array_equal(_matrix(copy), _matrix(source))
    assert (copy.weight, tuple(copy.color), copy.winding) == (source.weight, tuple(source.color), source.winding)
    copy.translation = 9, 9
    assert tuple(source.translation) != (9, 9)


def test_moving_reorders_and_the_selection_follows(owner):
    shape = owner.ifs_morph.initial
    matrices = [_matrix(item) for item in shape.maps]
    shape.active_index = 0
    bpy.ops.ifs_morph.map_move(end="INITIAL", direction="DOWN")
    assert shape.active_index == 1
    np.testing.assert_array_equal([_matrix(item) for item in shape.maps], [matrices[k] for k in (1, 0, 2)])
    bpy.ops.ifs_morph.map_move(end="INITIAL", direction="UP")
    assert shape.active_index == 0
    np.testing.assert_array_equal([_matrix(item) for item in shape.maps], matrices)
    with pytest.raises(RuntimeError, match="end of the list"):
        bpy.ops.ifs_morph.map_move(end="INITIAL", direction="UP")
    np.testing.assert_array_equal([_matrix(item) for item in shape.maps], matrices)


def test_reordering_changes_what_is_on_the_way_and_not_the_ends(owner):
    def positions(u, v):
        owner.ifs_morph.uv = u, v
        show()
        points = np.array([vertex.co for vertex in owner.data.vertices])
        return points[np.lexsort(points.T)]

    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="gasket")
    ends, between = [positions(0, 0), positions(1, 1)], positions(0.5, 0.5)
    owner.ifs_morph.final.active_index = 0
    bpy.ops.ifs_morph.map_move(end="FINAL", direction="DOWN")
    assert not np.allclose(positions(0.5, 0.5), between, atol=1e-3)
    assert len(positions(1, 1)) == len(ends[1])
