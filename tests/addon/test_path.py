"""Planned and straight paths on F-curves: what is keyed is what core planned, and nothing else is touched."""

from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from core.connectedness import Connectedness
from core.path import METHODS, plan_path
from core.report import check_frames
from tests.addon.interface import keys, reason, sidebar
from tests.addon.support import add, content, show

FIRST, LAST = 3, 27


@pytest.fixture
def owner(scene):
    owner = add("POINTS")
    settings = owner.ifs_morph
    settings.locus.resolution = 40
    settings.path.frame_start, settings.path.frame_end = FIRST, LAST
    return owner


def evaluated(owner, frame, subframe=0.0):
    """u, v and swell as Blender evaluates them."""
    bpy.context.scene.frame_set(frame, subframe=subframe)
    settings = owner.evaluated_get(bpy.context.evaluated_depsgraph_get()).ifs_morph
    return (*settings.uv, settings.swell)


def evaluated_offsets(owner):
    """Offsets (2, 3) of three maps as Blender evaluates them at the current frame."""
    settings = owner.evaluated_get(bpy.context.evaluated_depsgraph_get()).ifs_morph
    assert not any([*settings.offset_u[3:], *settings.offset_v[3:]])
    return np.array([settings.offset_u[:3], settings.offset_v[:3]])


def morph_of(owner, extension):
    return extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph)


def planned(owner, extension, method):
    """The path by core, from the same locus."""
    core = extension.core
    morph = morph_of(owner, extension)
    locus = core.locus.compute_locus(morph, 40) if method == "planned" else None
    return core.path.plan_path(morph, locus, LAST - FIRST + 1, method=method)


@pytest.mark.parametrize("method", METHODS)
def test_keys_give_the_planned_path(owner, extension, method):
    owner.ifs_morph.path.method = method.upper().replace(" ", "_")
    assert bpy.ops.ifs_morph.plan_path() == {"FINISHED"}
    path = planned(owner, extension, method)
    for frame in range(FIRST, LAST):
        for subframe in (0.0, 0.25, 0.7):
            expected = path.sample(np.array([(frame + subframe - FIRST) / (LAST - FIRST)]))[0]
            # Blender stores a handle in single precision and finds the curve's parameter by its time.
            np.testing.assert_allclose(evaluated(owner, frame, subframe), expected[:3], atol=3e-5)
            offsets = expected[3:] if method == "per map" else np.zeros(6)
            np.testing.assert_allclose(evaluated_offsets(owner), offsets.reshape(2, 3), atol=3e-5)
    assert evaluated(owner, FIRST - 2) == (0, 0, 0)
    assert evaluated(owner, LAST) == (1, 1, 0)
    assert evaluated(owner, LAST + 5) == (1, 1, 0)


def test_path_that_needs_swell_is_keyed_with_it(owner, extension):
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="terdragon")
    bpy.ops.ifs_morph.plan_path()
    frames = range(FIRST, LAST + 1)
    places = np.array([evaluated(owner, frame) for frame in frames])
    assert places[:, 2].max() > 0.01
    assert (places[[0, -1], 2] == 0).all()
    check = check_frames(morph_of(owner, extension), places)
    assert check.count(Connectedness.CONNECTED) == len(frames)
    assert "Swell" in owner.ifs_morph.path.report


def test_keys_lie_on_whole_frames_from_end_to_end(owner, extension):
    bpy.ops.ifs_morph.plan_path()
    for channel in keys(owner, extension):
        frames = [frame for frame, _ in channel]
        assert frames == [round(frame) for frame in frames]
        assert frames == sorted(set(frames))
        assert (frames[0], frames[-1]) == (FIRST, LAST)


def test_fit_of_frames_is_reported(owner, extension):
    bpy.ops.ifs_morph.plan_path()
    path = planned(owner, extension, "planned")
    assert owner.ifs_morph.path.report == path.report.text()
    assert "25 frames, all in one piece" in owner.ifs_morph.path.report
    assert path.report.text().splitlines()[0] in sidebar(owner, extension)


@pytest.mark.parametrize(("swell", "method"), [(False, "straight unswollen"), (True, "straight")])
def test_straight_path_runs_straight(owner, extension, swell, method):
    owner.ifs_morph.path.method = "PLANNED"
    bpy.ops.ifs_morph.key_straight(swell=swell)
    places = np.array([evaluated(owner, frame) for frame in range(FIRST, LAST + 1)])
    along = np.linspace(0, 1, len(places))
    np.testing.assert_allclose(places[:, :2], np.stack([along, along], axis=1), atol=1e-5)
    check = check_frames(morph_of(owner, extension), places)
    if swell:
        assert places[:, 2].max() > 0
        assert check.count(Connectedness.DISCONNECTED) == 0
    else:
        assert (places[:, 2] == 0).all()
        assert check.share_disconnected > 0.5
    assert owner.ifs_morph.path.report == planned(owner, extension, method).report.text()


def test_planning_again_replaces_the_keys(owner, extension):
    bpy.ops.ifs_morph.key_straight()
    straight = keys(owner, extension)
    bpy.ops.ifs_morph.plan_path()
    first = keys(owner, extension)
    assert first != straight
    bpy.ops.ifs_morph.plan_path()
    assert keys(owner, extension) == first
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = 10, 12
    bpy.ops.ifs_morph.key_straight()
    assert [(frames[0][0], frames[-1][0]) for frames in keys(owner, extension)] == [(10, 12)] * 3


def test_other_animation_stays(owner, extension):
    owner.location.x = 1
    owner.keyframe_insert("location", index=0, frame=1)
    owner.location.x = 4
    owner.keyframe_insert("location", index=0, frame=31)
    owner.ifs_morph.output.exposure = 2
    owner.keyframe_insert("ifs_morph.output.exposure", frame=1)
    action = owner.animation_data.action

    def others():
        bpy.context.scene.frame_set(16)
        return owner.location.x, owner.ifs_morph.output.exposure

    before = others()
    assert 1 < before[0] < 4
    for operate in (bpy.ops.ifs_morph.plan_path, bpy.ops.ifs_morph.key_straight, bpy.ops.ifs_morph.clear_path):
        operate()
        assert owner.animation_data.action == action
        assert others() == before
    assert keys(owner, extension) == [[], [], []]


def test_hand_made_keys_are_replaced_in_the_same_action(owner, extension):
    for frame, value in ((1, 0.2), (50, 0.8)):
        owner.ifs_morph.uv = value, value
        owner.keyframe_insert("ifs_morph.uv", frame=frame)
    action = owner.animation_data.action
    bpy.ops.ifs_morph.plan_path()
    assert owner.animation_data.action == action
    assert evaluated(owner, FIRST) == (0, 0, 0)
    assert evaluated(owner, 50) == (1, 1, 0)


def test_two_morphs_can_have_paths_of_their_own(owner, extension):
    bpy.ops.ifs_morph.key_straight()
    other = add("IMAGE")
    other.ifs_morph.path.frame_start, other.ifs_morph.path.frame_end = 5, 9
    bpy.ops.ifs_morph.key_straight()
    np.testing.assert_allclose(evaluated(other, 7), (0.5, 0.5, 0), atol=1e-5)
    np.testing.assert_allclose(evaluated(owner, 7), (1 / 6, 1 / 6, 0), atol=1e-5)
    assert other.animation_data.action != owner.animation_data.action


def test_check_reports_on_the_keys_that_are_there(owner, extension):
    bpy.ops.ifs_morph.plan_path()
    fcurves = extension.ifs_morph_addon.fcurves
    for point in fcurves.path_curves(owner)[1].keyframe_points:
        point.interpolation = "CONSTANT"
    scene = bpy.context.scene
    scene.frame_set(6)
    assert bpy.ops.ifs_morph.check_path() == {"FINISHED"}
    assert scene.frame_current == 6
    places = np.array([evaluated(owner, frame) for frame in range(FIRST, LAST + 1)])
    check = check_frames(morph_of(owner, extension), places)
    assert check.share_disconnected > 0
    assert owner.ifs_morph.path.report == check.text()
    assert check.text() in sidebar(owner, extension)


def test_report_is_called_out_of_date_when_the_morph_changes(owner, extension):
    bpy.ops.ifs_morph.plan_path()
    assert "out of date" not in sidebar(owner, extension)
    owner.ifs_morph.final.maps[0].winding = 1
    assert "report is out of date" in sidebar(owner, extension)
    bpy.ops.ifs_morph.check_path()
    assert "report is out of date" not in sidebar(owner, extension)


def test_clearing_removes_keys_and_report(owner, extension):
    still = content(owner)
    bpy.ops.ifs_morph.plan_path()
    bpy.context.scene.frame_set(LAST)
    assert content(owner) != still
    bpy.ops.ifs_morph.clear_path()
    show()
    assert keys(owner, extension) == [[], [], []]
    assert owner.ifs_morph.path.report == ""
    bpy.context.scene.frame_set(LAST)
    assert content(owner) == still
    assert "no keys" in reason(bpy.ops.ifs_morph.clear_path)
    assert "no keys" in reason(bpy.ops.ifs_morph.check_path)


@pytest.mark.parametrize("end", [FIRST, FIRST - 1])
def test_path_that_ends_before_it_starts_is_refused(owner, extension, end):
    bpy.ops.ifs_morph.key_straight()
    before = keys(owner, extension)
    owner.ifs_morph.path.frame_end = end
    for operator in (bpy.ops.ifs_morph.plan_path, bpy.ops.ifs_morph.key_straight):
        assert "must end after" in reason(operator)
    assert keys(owner, extension) == before


def test_locked_curves_and_drivers_are_refused(owner, extension):
    bpy.ops.ifs_morph.key_straight()
    curve = extension.ifs_morph_addon.fcurves.path_curves(owner)[1]
    curve.lock = True
    for operator in (bpy.ops.ifs_morph.plan_path, bpy.ops.ifs_morph.key_straight, bpy.ops.ifs_morph.clear_path):
        assert "locked" in reason(operator)
    curve.lock = False
    bpy.ops.ifs_morph.clear_path()
    owner.driver_add("ifs_morph.uv", 1).driver.expression = "0.5"
    assert "driver" in reason(bpy.ops.ifs_morph.plan_path)


def test_nothing_changes_when_planning_is_cancelled(owner, extension):
    bpy.ops.ifs_morph.key_straight()

    def state():
        settings = owner.ifs_morph
        return (
            keys(owner, extension),
            settings.path.report,
            settings.path.inputs,
            tuple(settings.output.window),
            settings.locus.image,
            len(bpy.data.images),
            len(bpy.data.actions),
        )

    before = state()
    plan = extension.ifs_morph_addon.operators.path.IFSMORPH_OT_plan_path.work
    operator = SimpleNamespace(method=lambda settings: "planned", report=lambda *_: None)
    cancelled_after = 1
    while True:
        work = plan(operator, bpy.context)
        shares = [share for _, share in zip(range(cancelled_after), work, strict=False)]
        if len(shares) < cancelled_after:
            break  # that was the whole plan
        assert all(0 <= share <= 1 for share in shares)
        work.close()
        assert state() == before
        cancelled_after += 1
    assert cancelled_after > 1
    assert state() != before


def test_window_fits_the_path_as_keyed(owner, extension):
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="terdragon")
    bpy.ops.ifs_morph.plan_path()
    left, bottom, right, top = owner.ifs_morph.output.window
    for frame in range(FIRST, LAST + 1):
        x0, y0, x1, y1 = morph_of(owner, extension).at(*evaluated(owner, frame)).bounds
        assert left <= x0 < x1 <= right, frame
        assert bottom <= y0 < y1 <= top, frame


def test_gap_resolution_reaches_the_plan(owner, extension):
    owner.ifs_morph.gap_resolution = 50
    bpy.ops.ifs_morph.key_straight()
    path = plan_path(morph_of(owner, extension), None, LAST - FIRST + 1, 1 / 50, "straight unswollen")
    assert owner.ifs_morph.path.report == path.report.text()
    assert "1/50" in owner.ifs_morph.path.report


@pytest.fixture
def own_paths(owner):
    """The object with a path for each map, where no common one stays connected."""
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="terdragon")
    owner.ifs_morph.path.method = "PER_MAP"
    owner.ifs_morph.path.frame_end = 120
    assert bpy.ops.ifs_morph.plan_path() == {"FINISHED"}
    return owner


def test_paths_of_their_own_are_shown(own_paths, extension):
    """What a frame shows is what the same place shows when it is not keyed, and not the place without the offsets."""
    bpy.context.scene.frame_set(60)
    settings = own_paths.ifs_morph
    place = extension.ifs_morph_addon.fcurves.sample_path(own_paths, [60])[0]
    assert np.abs(place[3:]).max() > 0.02
    shown = content(own_paths)
    settings.output.fit_window = False
    bpy.ops.ifs_morph.clear_path()
    settings.uv, settings.swell = place[:2], place[2]
    show()
    assert content(own_paths) != shown
    settings.offset_u, settings.offset_v = place[3:].reshape(2, -1)
    show()
    assert content(own_paths) == shown


def test_what_is_shown_has_each_map_at_its_own_place(own_paths, extension):
    bpy.context.scene.frame_set(60)
    evaluated = own_paths.evaluated_get(bpy.context.evaluated_depsgraph_get()).ifs_morph
    morph = morph_of(own_paths, extension)
    place = extension.ifs_morph_addon.fcurves.sample_path(own_paths, [60])[0]
    u, v = place[0] + place[3:6], place[1] + place[3 + 32 : 6 + 32]
    found = extension.ifs_morph_addon.conversion.frame_of(evaluated, morph)
    np.testing.assert_allclose(found.maps, morph.at(u, v, place[2]).maps, atol=1e-6)


def test_every_frame_of_paths_of_their_own_is_in_one_piece(own_paths):
    assert "118 frames, all in one piece" in own_paths.ifs_morph.path.report
    assert "a path of its own" in own_paths.ifs_morph.path.report


@pytest.mark.parametrize("operator", ["clear_path", "key_straight"])
def test_another_path_takes_those_of_the_maps_away(own_paths, extension, operator):
    assert len(extension.ifs_morph_addon.compat.fcurves(own_paths)) == 3 + 6
    getattr(bpy.ops.ifs_morph, operator)()
    bpy.context.scene.frame_set(60)
    assert not evaluated_offsets(own_paths).any()
    assert extension.ifs_morph_addon.fcurves.sample_path(own_paths, [60]).shape == (1, 3)


def test_offsets_can_be_set_and_keyed_by_hand(owner, extension):
    before = content(owner)
    owner.ifs_morph.offset_u[0] = 0.3
    show()
    assert content(owner) != before
    owner.keyframe_insert("ifs_morph.offset_u", index=0, frame=FIRST)
    owner.ifs_morph.offset_u[0] = 0.0
    assert extension.ifs_morph_addon.fcurves.sample_path(owner, [FIRST])[0, 3] == pytest.approx(0.3)


def test_offsets_of_more_maps_than_can_be_stored_are_refused(owner, extension):
    keys = extension.core.curve.Keys(np.array([0.0, 1.0]), *np.zeros((3, 2, 2, 33)))
    path = planned(owner, extension, "straight")
    path = type(path)(path.keys, path.swell_keys, keys, path.report)
    with pytest.raises(extension.core.ifs.IFSError, match="33 maps, and 32 at most"):
        extension.ifs_morph_addon.fcurves.write_path(owner, path, FIRST, LAST)
    assert not extension.ifs_morph_addon.fcurves.has_path(owner)
