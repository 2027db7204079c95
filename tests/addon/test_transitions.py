"""Recurrent shapes on objects: stored, edited with the list of maps, drawn, read from files and written to them."""

import bpy
import numpy as np
import pytest

from core.cloud import point_cloud
from core.formats import read_shapes
from core.ifs import IFS
from core.shapes import SHAPES
from tests.addon.interface import keys
from tests.addon.support import add, attribute, content, show

TRANSITIONS = np.float32([[0, 1, 0.5], [1, 0, 0.25], [1, 1, 1]])
WHOLE = np.float32([[1, 0.5, 1], [1, 1, 2], [1, 0, 1]])
"""With these the gasket stays in one piece."""

FLAME = """<flame name="chaos"><xform weight="1" linear="1" chaos="0 1 1" coefs="0.5 0 0 0.5 0 0"/>
<xform weight="1" linear="1" chaos="1 0 1" coefs="0.5 0 0 0.5 0.5 0"/>
<xform weight="1" linear="1" coefs="0.5 0 0 0.5 0 0.5"/></flame>"""


def matrix(shape):
    count = len(shape.maps)
    return np.float32([list(item.transitions)[:count] for item in shape.maps])


def set_matrix(shape, values):
    shape.recurrent = True
    for item, row in zip(shape.maps, values, strict=True):
        item.transitions[: len(row)] = row


@pytest.fixture
def conversion(extension):
    return extension.ifs_morph_addon.conversion


@pytest.fixture
def owner(scene):
    owner = add("IMAGE")
    for end in ("INITIAL", "FINAL"):
        bpy.ops.ifs_morph.load_shape(end=end, shape="gasket")
    return owner


def test_transitions_say_what_may_follow_once_they_are_switched_on(owner, conversion):
    initial = owner.ifs_morph.initial
    free = content(owner)
    set_matrix(initial, TRANSITIONS)
    assert np.array_equal(conversion.shape_ifs(initial).transitions, TRANSITIONS)
    show()
    assert content(owner) != free
    initial.recurrent = False
    assert conversion.shape_ifs(initial).transitions is None
    show()
    assert content(owner) == free


def test_the_list_of_maps_takes_rows_and_columns_along(owner):
    shape = owner.ifs_morph.initial
    set_matrix(shape, TRANSITIONS)
    shape.active_index = 0
    bpy.ops.ifs_morph.map_move(end="INITIAL", direction="DOWN")
    order = [1, 0, 2]
    assert np.array_equal(matrix(shape), TRANSITIONS[np.ix_(order, order)])
    bpy.ops.ifs_morph.map_duplicate(end="INITIAL")
    order = [1, 0, 0, 2]
    assert np.array_equal(matrix(shape), TRANSITIONS[np.ix_(order, order)])
    shape.active_index = 1
    bpy.ops.ifs_morph.map_remove(end="INITIAL")
    order = [1, 0, 2]
    assert np.array_equal(matrix(shape), TRANSITIONS[np.ix_(order, order)])
    bpy.ops.ifs_morph.map_add(end="INITIAL")
    assert np.array_equal(matrix(shape)[:3, :3], TRANSITIONS[np.ix_(order, order)])
    assert (matrix(shape)[3] == 1).all()
    assert (matrix(shape)[:, 3] == 1).all()


def test_points_are_those_of_the_recurrent_shape(scene, conversion):
    owner = add("POINTS", points=2000)
    for end in ("INITIAL", "FINAL"):
        bpy.ops.ifs_morph.load_shape(end=end, shape="gasket")
        set_matrix(getattr(owner.ifs_morph, end.lower()), TRANSITIONS)
    show()
    before = attribute(owner, "attractorlet")
    # The same from the numbers alone.
    stored = conversion.shape_ifs(owner.ifs_morph.initial)
    ifs = IFS(stored.maps, stored.weights, transitions=TRANSITIONS)
    assert np.array_equal(before[:, 0], point_cloud(ifs, 2000).attractorlet)
    letters = np.bincount(before[:, 0], minlength=3)
    assert abs(letters[2] - letters[0]) > 20
    owner.ifs_morph.uv = 0.5, 0.5
    show()
    assert np.array_equal(attribute(owner, "attractorlet"), before)


def test_results_are_out_of_date_when_transitions_change(owner, conversion):
    settings = owner.ifs_morph
    stamps = {conversion.fingerprint(settings)}
    set_matrix(settings.initial, TRANSITIONS)
    stamps.add(conversion.fingerprint(settings))
    settings.initial.maps[0].transitions[0] = 1
    stamps.add(conversion.fingerprint(settings))
    assert len(stamps) == 3


def test_a_map_that_nothing_follows_is_said(owner, conversion):
    set_matrix(owner.ifs_morph.initial, [[0, 0, 0], [1, 1, 1], [1, 1, 1]])
    with pytest.raises(ValueError, match="no map may be applied after map 1"):
        conversion.morph_of(owner.ifs_morph)


def test_a_flame_with_chaos_comes_and_goes(owner, conversion, tmp_path):
    path = tmp_path / "some.flame"
    path.write_text(FLAME)
    bpy.ops.ifs_morph.import_shapes(filepath=str(path), target="INITIAL")
    shape = owner.ifs_morph.initial
    assert shape.recurrent
    assert np.array_equal(matrix(shape), [[0, 1, 1], [1, 0, 1], [1, 1, 1]])
    written = tmp_path / "written.flame"
    bpy.ops.ifs_morph.export_shapes(filepath=str(written), shapes={"INITIAL"})
    (read,) = read_shapes(written).values()
    assert np.array_equal(read.transitions, matrix(shape))
    (source,) = read_shapes(path).values()
    for name in ("maps", "weights", "transitions"):
        np.testing.assert_allclose(getattr(read, name), getattr(source, name), atol=1e-7)


def test_a_plain_shape_takes_the_place_of_a_recurrent_one(owner):
    shape = owner.ifs_morph.initial
    set_matrix(shape, TRANSITIONS)
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="square")
    assert not shape.recurrent
    assert (np.float32([item.transitions for item in shape.maps]) == 1).all()
    assert len(shape.maps) == SHAPES["square"].count <= 32


@pytest.fixture
def different(owner):
    """An object whose initial shape allows other transitions than its final one."""
    set_matrix(owner.ifs_morph.initial, TRANSITIONS)
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = 1, 12
    return owner


def test_one_press_morphs_recurrent_shapes(different, conversion, extension):
    settings = different.ifs_morph
    set_matrix(settings.initial, WHOLE)
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape="square")
    bpy.ops.ifs_morph.morph()
    assert len(settings.matching.pairs) >= 4
    assert conversion.pairs_problem(settings) == ""
    morph = conversion.morph_of(settings)
    assert morph.part_of.max() + 1 == len(settings.matching.pairs) < morph.count
    for u, shape in ((0, settings.initial), (1, settings.final)):
        np.testing.assert_allclose(morph.at(u, u).bounds, conversion.shape_ifs(shape).bounds, atol=1e-3)
    assert all(keys(different, extension)[:2])
    assert "12 frames, all in one piece" in settings.path.report


def test_parts_have_the_colors_of_their_maps(different, conversion):
    settings = different.ifs_morph
    part_of = conversion.morph_of(settings).part_of
    assert len(part_of) > 3
    expected = conversion.shape_colors(settings.initial)[part_of]
    np.testing.assert_allclose(conversion.frame_colors(settings)[:, :3], expected)
    show()


def test_points_do_not_jump_where_transitions_begin_to_change(scene):
    owner = add("POINTS", points=2000)
    for end in ("INITIAL", "FINAL"):
        bpy.ops.ifs_morph.load_shape(end=end, shape="gasket")
    set_matrix(owner.ifs_morph.initial, TRANSITIONS)
    found = []
    for u in (0.0, 1e-4):
        owner.ifs_morph.uv = u, u
        show()
        found.append(attribute(owner, "position"))
    assert np.abs(found[1] - found[0]).max() < 1e-2


def test_a_map_splits_into_what_may_follow_it(different, conversion):
    settings = different.ifs_morph
    for number in "123":
        item = settings.matching.pairs.add()
        item.initial = item.final = number
    bpy.ops.ifs_morph.pair_split(end="INITIAL")
    assert [each.initial for each in settings.matching.pairs] == ["1 2", "1 3", "2", "3"]
    assert conversion.pairs_problem(settings) == ""
