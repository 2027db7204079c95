"""Keys of the path moved, added and removed by hand, and (u,v) set, by what the mouse calls."""

import bpy
import numpy as np
import pytest

from core.connectedness import Connectedness
from core.locus import compute_locus
from tests.addon.interface import keys, reason, sidebar
from tests.addon.support import activate, add, show

FRAMES = np.linspace(1, 24, 93)


@pytest.fixture
def owner(scene):
    owner = add("POINTS")
    bpy.ops.ifs_morph.key_straight()
    return owner


@pytest.fixture
def course(extension):
    return lambda owner: extension.ifs_morph_addon.fcurves.sample_path(owner, FRAMES)[:, :2]


@pytest.fixture
def bend(owner, extension):
    """Bend the path, so that it is not straight anywhere."""
    for curve, height in zip(extension.ifs_morph_addon.fcurves.path_curves(owner)[:2], (0.3, -0.4), strict=True):
        start, end = curve.keyframe_points
        start.handle_right.y += height
        end.handle_left.y -= height
        curve.update()


def test_a_moved_key_is_where_it_was_moved_to(owner, scene, extension):
    bpy.ops.ifs_morph.add_path_key(frame=12)
    assert bpy.ops.ifs_morph.drag_on_locus(key=True, frame=12, uv=(0.9, 0.2)) == {"FINISHED"}
    u, v, _ = keys(owner, extension)
    assert [frame for frame, _ in u] == [frame for frame, _ in v] == [1, 12, 24]
    assert (u[1][1], v[1][1]) == pytest.approx((0.9, 0.2))
    scene.frame_set(12)
    assert tuple(owner.ifs_morph.uv) == pytest.approx((0.9, 0.2))


def test_straight_paths_stay_straight(owner, course):
    bpy.ops.ifs_morph.add_path_key(frame=12)
    bpy.ops.ifs_morph.drag_on_locus(key=True, frame=12, uv=(0.9, 0.2))
    corner = np.stack([np.interp(FRAMES, [1, 12, 24], values) for values in ((0, 0.9, 1), (0, 0.2, 1))], axis=1)
    np.testing.assert_allclose(course(owner), corner, atol=2e-3)


def test_adding_a_key_keeps_the_course(owner, bend, course, extension):
    before = course(owner)
    assert np.abs(before - np.linspace(0, 1, len(FRAMES))[:, None]).max() > 0.05
    bpy.ops.ifs_morph.add_path_key(frame=7)
    np.testing.assert_allclose(course(owner), before, atol=1e-4)
    assert [len(column) for column in keys(owner, extension)[:2]] == [3, 3]
    assert extension.ifs_morph_addon.path_keys.selected_frames(owner) == [7]


def test_adding_a_key_at_a_key_adds_none(owner, extension):
    bpy.ops.ifs_morph.add_path_key(frame=7)
    bpy.ops.ifs_morph.add_path_key(frame=7)
    assert len(keys(owner, extension)[0]) == 3


@pytest.mark.parametrize("frame", [0, 1, 24, 99])
def test_keys_are_added_inside_the_path(owner, frame, extension):
    before = keys(owner, extension)
    with pytest.raises(RuntimeError, match="from frame 1 to 24"):
        bpy.ops.ifs_morph.add_path_key(frame=frame)
    assert keys(owner, extension) == before


def test_removing_an_added_key_gives_the_straight_path_back(owner, course, extension):
    before = course(owner)
    bpy.ops.ifs_morph.add_path_key(frame=7)
    bpy.ops.ifs_morph.drag_on_locus(key=True, frame=7, uv=(-0.5, 0.5))
    assert np.abs(course(owner) - before).max() > 0.3
    assert bpy.ops.ifs_morph.remove_path_keys() == {"FINISHED"}
    np.testing.assert_allclose(course(owner), before, atol=2e-3)
    assert len(keys(owner, extension)[0]) == 2


def test_removing_all_keys_removes_the_path_and_nothing_else(owner, extension):
    owner.keyframe_insert("location", frame=3)
    for curve in extension.ifs_morph_addon.fcurves.path_curves(owner)[:2]:
        for point in curve.keyframe_points:
            point.select_control_point = True
    bpy.ops.ifs_morph.remove_path_keys()
    assert not extension.ifs_morph_addon.fcurves.has_path(owner)
    assert extension.ifs_morph_addon.compat.fcurves(owner).find("location", index=0) is not None


def test_only_selected_keys_are_removed(owner, extension):
    extension.ifs_morph_addon.path_keys.select(owner, -1)
    assert not bpy.ops.ifs_morph.remove_path_keys.poll()
    if not bpy.app.background:
        assert "Click a key" in reason(bpy.ops.ifs_morph.remove_path_keys)


def test_u_alone_keyed_becomes_a_path(owner, extension):
    bpy.ops.ifs_morph.clear_path()
    owner.ifs_morph.uv = 0.0, 0.25
    owner.keyframe_insert("ifs_morph.uv", index=0, frame=1)
    owner.ifs_morph.uv = 1.0, 0.25
    owner.keyframe_insert("ifs_morph.uv", index=0, frame=24)
    bpy.ops.ifs_morph.drag_on_locus(key=True, frame=24, uv=(0.8, 0.75))
    assert keys(owner, extension)[0] == [(1, 0), (24, pytest.approx(0.8))]
    assert keys(owner, extension)[1] == [(1, 0.25), (24, 0.75)]


def test_keys_at_different_frames_are_filled_in(owner, course, extension):
    curve = extension.ifs_morph_addon.fcurves.path_curves(owner)[0]
    curve.keyframe_points.insert(9, curve.evaluate(9))
    before = course(owner)
    extension.ifs_morph_addon.path_keys.prepare(owner)
    np.testing.assert_allclose(course(owner), before, atol=1e-4)
    assert [[frame for frame, _ in column] for column in keys(owner, extension)[:2]] == [[1, 9, 24]] * 2


def test_handles_far_away_keep_their_times(owner, bend, extension):
    """Only what is beside the key changes, also where somebody made the handles longer in the Graph Editor."""
    bpy.ops.ifs_morph.add_path_key(frame=7)
    bpy.ops.ifs_morph.add_path_key(frame=15)
    curve = extension.ifs_morph_addon.fcurves.path_curves(owner)[0]
    curve.keyframe_points[0].handle_right.x = 2.0
    curve.update()
    bpy.ops.ifs_morph.drag_on_locus(key=True, frame=24, uv=(0.9, 0.9))
    curve = extension.ifs_morph_addon.fcurves.path_curves(owner)[0]
    assert curve.keyframe_points[0].handle_right.x == pytest.approx(2.0)


def test_the_report_is_out_of_date_after_a_moved_key(owner, extension):
    bpy.ops.ifs_morph.check_path()
    assert "out of date" not in sidebar(owner, extension)
    bpy.ops.ifs_morph.drag_on_locus(key=True, frame=24, uv=(0.9, 0.9))
    assert "report is out of date" in sidebar(owner, extension)


def test_the_window_holds_the_shapes_of_the_new_path(scene):
    owner = add("IMAGE")
    bpy.ops.ifs_morph.key_straight()
    before = tuple(owner.ifs_morph.output.window)
    bpy.ops.ifs_morph.drag_on_locus(key=True, frame=24, uv=(1, 3))
    left, bottom, right, top = owner.ifs_morph.output.window
    assert right - left > 1.5 * (before[2] - before[0])
    assert top - bottom > 1.5 * (before[3] - before[1])


def test_dragging_the_cross_sets_the_place(owner, extension):
    before = keys(owner, extension)
    bpy.ops.ifs_morph.drag_on_locus(uv=(0.25, 0.75))
    show()
    assert tuple(owner.ifs_morph.uv) == (0.25, 0.75)
    assert keys(owner, extension) == before


def test_linked_actions_are_left_alone(owner, extension):
    extension.ifs_morph_addon.fcurves.path_curves(owner)[0].lock = True
    before = keys(owner, extension)
    with pytest.raises(RuntimeError, match="locked"):
        bpy.ops.ifs_morph.drag_on_locus(key=True, frame=24, uv=(0.9, 0.9))
    assert not bpy.ops.ifs_morph.add_path_key.poll()
    assert keys(owner, extension) == before


def test_one_undo_step_brings_a_key_back(owner, extension):
    bpy.context.preferences.edit.use_global_undo = True
    name = owner.name
    bpy.ops.ed.undo_push(message="before")
    before = keys(owner, extension)
    bpy.ops.ifs_morph.drag_on_locus(key=True, frame=24, uv=(0.9, 0.9))
    bpy.ops.ed.undo_push(message="moved")
    bpy.ops.ed.undo()
    assert keys(bpy.data.objects[name], extension) == before


def test_nothing_to_drag_without_a_morph(owner, scene):
    activate(scene.camera)
    assert not bpy.ops.ifs_morph.drag_on_locus.poll()
    assert not bpy.ops.ifs_morph.add_path_key.poll()


@pytest.mark.parametrize(
    ("state", "sentence"), [("CONNECTED", "is in one piece"), ("DISCONNECTED", "in pieces; the gap is")]
)
def test_the_state_is_said(owner, state, sentence, extension):
    conversion = extension.ifs_morph_addon.conversion
    locus = compute_locus(conversion.morph_of(owner.ifs_morph), 31)
    row, column = np.argwhere(locus.state == Connectedness[state])[0]
    owner.ifs_morph.uv = locus.u[column], locus.v[row]
    assert sentence in conversion.state_sentence(owner.ifs_morph)


def test_no_shape_and_no_morph_are_said(owner, extension):
    say = extension.ifs_morph_addon.conversion.state_sentence
    owner.ifs_morph.initial.maps[0].scale = 2, 2
    assert "no shape" in say(owner.ifs_morph)
    bpy.ops.ifs_morph.map_add(end="FINAL")
    assert "maps" in say(owner.ifs_morph)
