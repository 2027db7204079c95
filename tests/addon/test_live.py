"""The picture of the locus follows the maps; stepped by hand, where in the window a timer does it."""

import bpy
import numpy as np
import pytest

from core.locus import compute_locus
from tests.addon.interface import sidebar
from tests.addon.support import activate, add, pixels, show


class Clock:
    """A time that passes only when told to."""

    now = 100.0

    def __call__(self):
        return self.now


@pytest.fixture
def live(extension):
    module = extension.ifs_morph_addon.live
    yield module
    module.forget()


@pytest.fixture
def owner(scene):
    owner = add("POINTS")
    owner.ifs_morph.locus.resolution = 256
    bpy.ops.ifs_morph.compute_locus()
    return owner


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def follower(live, owner, clock):
    """A follower of the object, known to the panels as one that the handler made is."""
    follower = live.Follower(owner, clock)
    live._followers[owner.session_uid] = follower
    return follower


def locus(owner, extension, resolution=256):
    return compute_locus(extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph), resolution)


def shown(owner):
    return pixels(owner.ifs_morph.locus.image)


def is_current(owner, extension):
    return extension.ifs_morph_addon.locus_picture.is_current(owner.ifs_morph)


def edit(owner, follower, extension, value=0.3):
    owner.ifs_morph.final.maps[0].translation = value, 0.0
    follower.notice(extension.ifs_morph_addon.conversion.locus_fingerprint(owner.ifs_morph))


def until_preview(follower):
    while not follower.shows_preview:
        follower.step()


def until_done(follower, clock):
    while follower.is_busy:
        clock.now += follower.step()


def assert_is_preview(picture, owner, extension):
    """Each pixel has the color of the preview's node next to it."""
    coarse = locus(owner, extension, 130).picture()
    nearest = np.clip(np.rint(np.arange(256) * 129 / 255), 0, 129).astype(int)
    np.testing.assert_allclose(picture, coarse[nearest][:, nearest], atol=1 / 255)


def test_a_change_shows_a_preview_and_after_a_pause_the_full_locus(owner, follower, clock, extension):
    edit(owner, follower, extension)
    until_preview(follower)
    assert_is_preview(shown(owner), owner, extension)
    for _ in range(5):
        follower.step()
    assert follower.shows_preview
    assert not is_current(owner, extension)
    until_done(follower, clock)
    np.testing.assert_allclose(shown(owner), locus(owner, extension).picture(), atol=1 / 255)
    assert is_current(owner, extension)
    assert not follower.shows_preview


def test_the_panel_says_what_is_shown(owner, follower, clock, extension):
    assert "preview" not in sidebar(owner, extension)
    edit(owner, follower, extension)
    assert "out of date" in sidebar(owner, extension)
    until_preview(follower)
    assert "preview" in sidebar(owner, extension)
    assert "out of date: the morph" not in sidebar(owner, extension)
    until_done(follower, clock)
    assert "preview" not in sidebar(owner, extension)


def test_a_change_in_the_pause_begins_again(owner, follower, clock, extension):
    edit(owner, follower, extension)
    until_preview(follower)
    edit(owner, follower, extension, 0.6)
    follower.shows_preview = False
    until_preview(follower)
    assert_is_preview(shown(owner), owner, extension)


def test_who_drags_without_a_rest_sees_previews(owner, follower, extension):
    for value in np.linspace(0.1, 0.9, 200):
        edit(owner, follower, extension, value)
        follower.step()
        if follower.shows_preview:
            return
    raise AssertionError("There was no preview in 200 steps.")


def test_a_change_drops_the_full_locus(owner, follower, clock, extension, live, monkeypatch):
    dropped = []

    def endless(settings):
        try:
            while True:
                yield 0.5
        finally:
            dropped.append(True)

    monkeypatch.setattr(live.locus_picture, "locus_steps", endless)
    edit(owner, follower, extension)
    until_preview(follower)
    clock.now += 10
    for _ in range(5):
        follower.step()
    assert not dropped
    edit(owner, follower, extension, 0.7)
    follower.shows_preview = False
    until_preview(follower)
    assert dropped
    assert_is_preview(shown(owner), owner, extension)


def test_what_the_locus_does_not_depend_on_is_no_work(owner, live):
    live.notice(owner)
    owner.ifs_morph.uv = 0.5, 0.5
    owner.ifs_morph.initial.maps[0].color = 1, 0, 0
    live.notice(owner)
    assert not live._followers


@pytest.fixture
def watching(live):
    """Have edits noticed, as in a window."""
    handlers = bpy.app.handlers.depsgraph_update_post
    handlers.append(live.on_edit)
    yield
    handlers.remove(live.on_edit)


def test_changes_of_an_object_are_noticed(owner, live, watching):
    owner.ifs_morph.final.maps[0].winding = 1
    show()
    follower = live._followers[owner.session_uid]
    assert follower.is_busy
    live.notice(owner)
    assert live._followers[owner.session_uid] is follower


@pytest.mark.parametrize("reason", ["switched off", "no picture", "no morph"])
def test_some_are_left_alone(owner, live, reason):
    owner.ifs_morph.final.maps[0].winding = 1
    if reason == "switched off":
        owner.ifs_morph.locus.live = False
    if reason == "no picture":
        bpy.data.images.remove(owner.ifs_morph.locus.image)
    if reason == "no morph":
        owner.ifs_morph.kind = "NONE"
    live.notice(owner)
    assert not live._followers


def test_switching_off_shows_what_is_in_the_file(owner, follower, extension, clock):
    before = shown(owner)
    edit(owner, follower, extension)
    until_preview(follower)
    assert not np.array_equal(shown(owner), before)
    owner.ifs_morph.locus.live = False
    until_done(follower, clock)
    np.testing.assert_array_equal(shown(owner), before)
    owner.ifs_morph.locus.live = True
    follower.notice(extension.ifs_morph_addon.conversion.locus_fingerprint(owner.ifs_morph))
    assert follower.is_busy


def test_shapes_that_do_not_fit_are_tried_once(owner, follower, extension, clock):
    before = shown(owner)
    bpy.ops.ifs_morph.map_add(end="FINAL")
    fingerprint = extension.ifs_morph_addon.conversion.locus_fingerprint(owner.ifs_morph)
    follower.notice(fingerprint)
    until_done(follower, clock)
    follower.notice(fingerprint)
    assert not follower.is_busy
    np.testing.assert_array_equal(shown(owner), before)


def test_an_object_that_is_gone_ends_the_work(owner, follower, extension, clock):
    edit(owner, follower, extension)
    follower.step()
    bpy.data.objects.remove(owner)
    until_done(follower, clock)


def test_a_preview_is_not_saved(owner, follower, live, extension, tmp_path):
    before = shown(owner)
    edit(owner, follower, extension)
    until_preview(follower)
    live.on_save()
    file = str(tmp_path / "live.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    live.forget()
    bpy.ops.wm.open_mainfile(filepath=file)
    owner = next(each for each in bpy.data.objects if each.ifs_morph.kind != "NONE")
    np.testing.assert_array_equal(shown(owner), before)
    assert not is_current(owner, extension)


def test_undo_and_redo_keep_picture_and_maps_together(owner, clock, live, extension):
    bpy.context.preferences.edit.use_global_undo = True
    name = owner.name
    picture = extension.ifs_morph_addon.locus_picture
    bpy.ops.ed.undo_push(message="before")
    old = shown(owner)
    follower = live.Follower(owner, clock)
    live._followers[owner.session_uid] = follower
    edit(owner, follower, extension)
    until_preview(follower)
    bpy.ops.ed.undo_push(message="edit, with a preview")
    until_done(follower, clock)
    bpy.ops.ed.undo_push(message="something else, with the full locus")
    new = shown(owner)
    assert not np.array_equal(old, new)
    for step in (bpy.ops.ed.undo, bpy.ops.ed.undo, bpy.ops.ed.redo, bpy.ops.ed.redo, bpy.ops.ed.undo):
        step()
        live.on_undo()
        owner = bpy.data.objects[name]
        # The pixels are those that the image says they are.
        inputs = owner.ifs_morph.locus.image.ifs_morph_locus.inputs
        owner_is_new = owner.ifs_morph.final.maps[0].translation[0] == pytest.approx(0.3)
        np.testing.assert_array_equal(shown(owner), new if picture.is_current(owner.ifs_morph) == owner_is_new else old)
        assert inputs
        for follower in live._followers.values():
            follower._clock = clock
            until_done(follower, clock)
        assert picture.is_current(owner.ifs_morph)
        np.testing.assert_array_equal(shown(owner), new if owner_is_new else old)


def test_another_resolution_makes_another_picture_in_the_same_image(owner, follower, extension, clock):
    image = owner.ifs_morph.locus.image
    owner.ifs_morph.locus.resolution = 64
    owner.ifs_morph.locus.domain = -0.5, 1.0
    follower.notice(extension.ifs_morph_addon.conversion.locus_fingerprint(owner.ifs_morph))
    until_done(follower, clock)
    morph = extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph)
    expected = compute_locus(morph, 64, domain=(-0.5, 1.0))
    assert owner.ifs_morph.locus.image == image
    np.testing.assert_allclose(shown(owner), expected.picture(), atol=1 / 255)
    np.testing.assert_allclose(image.ifs_morph_locus.lowest, (expected.u[0], expected.v[0]), atol=1e-6)
    assert image.ifs_morph_locus.spacing == pytest.approx(expected.u[1] - expected.u[0])


def test_copies_do_not_draw_into_the_picture_of_the_original(owner, live, extension, clock):
    image, before = owner.ifs_morph.locus.image, shown(owner)
    activate(owner)
    bpy.ops.object.duplicate()
    copy = bpy.context.view_layer.objects.active
    assert copy.ifs_morph.locus.image == image
    follower = live.Follower(copy, clock)
    edit(copy, follower, extension)
    until_done(follower, clock)
    assert copy.ifs_morph.locus.image != image
    assert owner.ifs_morph.locus.image == image
    np.testing.assert_array_equal(shown(owner), before)
    assert not np.array_equal(shown(copy), before)


def test_large_pictures_stay_previews(owner, follower, extension, clock, live, monkeypatch):
    monkeypatch.setattr(live, "MOST_NODES", 200)
    edit(owner, follower, extension)
    until_done(follower, clock)
    assert follower.shows_preview
    assert "Compute the locus for the full" in sidebar(owner, extension)
    bpy.ops.ifs_morph.compute_locus()
    assert "preview" not in sidebar(owner, extension)
