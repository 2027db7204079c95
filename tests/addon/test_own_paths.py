"""Paths that maps have of their own go with their maps and pairs, whatever is done to the lists."""

import bpy
import numpy as np
import pytest

from tests.addon.support import add

FIRST, LAST = 1, 24


@pytest.fixture
def owner(scene):
    """Three maps, each with offsets of its own: a property, keys in u, and keys in v of another kind."""
    owner = add("POINTS")
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = FIRST, LAST
    for k in range(3):
        owner.ifs_morph.offset_u[k] = 0.1 * (k + 1)
        owner.keyframe_insert("ifs_morph.offset_u", index=k, frame=FIRST)
        owner.ifs_morph.offset_u[k] = 0.2 * (k + 1)
        owner.keyframe_insert("ifs_morph.offset_u", index=k, frame=LAST)
    owner.ifs_morph.offset_v[1] = 0.05
    return owner


def offsets(owner, extension):
    """Offsets in u at the first and last frame, and in v, of the rows that have any, as hundredths."""
    found = np.round(100 * extension.ifs_morph_addon.fcurves.sample_path(owner, [FIRST, LAST])[:, 3:]).astype(int)
    rows = np.stack([found[0, :32], found[1, :32], found[0, 32:]], axis=1)
    return [tuple(row) for row in rows.tolist() if any(row)]


ONE, TWO, THREE = (10, 20, 0), (20, 40, 5), (30, 60, 0)


def pairs_in_order(owner):
    bpy.ops.ifs_morph.pair_add()
    owner.ifs_morph.matching.active_index = 1


@pytest.mark.parametrize(
    ("operator", "options", "expected"),
    [
        ("pair_remove", {}, [ONE, THREE]),
        ("pair_add", {}, [ONE, TWO, THREE, TWO]),
        ("pair_split", {"end": "INITIAL"}, [ONE, TWO, TWO, TWO, THREE]),
        ("pair_swap", {"direction": "DOWN"}, [ONE, TWO, THREE]),
        ("clear_pairs", {}, []),
        ("match_pairs", {}, []),
    ],
)
def test_they_go_with_their_pairs(owner, extension, operator, options, expected):
    pairs_in_order(owner)
    assert offsets(owner, extension) == [ONE, TWO, THREE]
    assert getattr(bpy.ops.ifs_morph, operator)(**options) == {"FINISHED"}
    assert offsets(owner, extension) == expected


def test_parts_that_are_joined_go_where_the_first_went(owner, extension):
    pairs_in_order(owner)
    bpy.ops.ifs_morph.pair_split(end="FINAL")
    bpy.ops.ifs_morph.pair_join(end="FINAL")
    assert offsets(owner, extension) == [ONE, TWO, THREE]


@pytest.mark.parametrize(
    ("operator", "options", "expected"),
    [
        ("map_move", {"direction": "DOWN"}, [ONE, THREE, TWO]),
        ("map_remove", {}, [ONE, THREE]),
        ("map_duplicate", {}, [ONE, TWO, TWO, THREE]),
    ],
)
def test_without_pairs_they_go_with_the_initial_maps(owner, extension, operator, options, expected):
    for end, found in (("FINAL", [ONE, TWO, THREE]), ("INITIAL", expected)):
        getattr(owner.ifs_morph, end.lower()).active_index = 1
        assert getattr(bpy.ops.ifs_morph, operator)(end=end, **options) == {"FINISHED"}
        assert offsets(owner, extension) == found


def test_keys_keep_their_shape(owner, extension):
    fcurves, compat = extension.ifs_morph_addon.fcurves, extension.ifs_morph_addon.compat
    curve = compat.ensure_fcurve(owner, "ifs_morph.offset_u", 2)
    point = curve.keyframe_points[0]
    point.interpolation, point.handle_left_type, point.handle_right_type = "BEZIER", "FREE", "FREE"
    point.handle_right = FIRST + 5, 0.9
    between = [curve.evaluate(frame) for frame in range(FIRST, LAST)]
    fcurves.rearrange_offsets(owner, [2, 0])
    moved = compat.ensure_fcurve(owner, "ifs_morph.offset_u", 0)
    assert [moved.evaluate(frame) for frame in range(FIRST, LAST)] == pytest.approx(between)
    assert offsets(owner, extension) == [THREE, ONE]


def test_what_is_locked_stays(owner, extension):
    pairs_in_order(owner)
    extension.ifs_morph_addon.compat.ensure_fcurve(owner, "ifs_morph.offset_u", 0).lock = True
    bpy.ops.ifs_morph.pair_remove()
    assert offsets(owner, extension) == [ONE, TWO, THREE]


def test_lists_without_such_paths_get_none(scene, extension):
    owner = add("POINTS")
    pairs_in_order(owner)
    bpy.ops.ifs_morph.pair_remove()
    assert owner.animation_data is None


def test_a_map_that_is_moved_in_both_lists_changes_no_frame(scene, extension):
    owner = add("POINTS")
    owner.ifs_morph.path.method = "PER_MAP"
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="terdragon")
    bpy.ops.ifs_morph.plan_path()
    assert "all in one piece" in owner.ifs_morph.path.report.splitlines()[0]
    for end in ("INITIAL", "FINAL"):
        bpy.ops.ifs_morph.map_move(end=end, direction="DOWN")
    bpy.ops.ifs_morph.check_path()
    assert "all in one piece" in owner.ifs_morph.path.report.splitlines()[0]
