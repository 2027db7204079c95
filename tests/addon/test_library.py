"""Morphs of other files: appended, linked, overridden; and copies by every way there is."""

import bpy
import numpy as np
import pytest

from tests.addon.interface import keys, reason, sidebar
from tests.addon.support import activate, add, content, show

KINDS = ("IMAGE", "POINTS")
PATH = ("compute_locus", "plan_path", "key_straight", "check_path", "clear_path")
EDITS = (*PATH, "load_shape", "map_add", "map_remove", "map_duplicate", "map_move", "repair_output")


@pytest.fixture(params=KINDS)
def library(request, scene, tmp_path):
    """A saved file with a keyed morph, the contents of it at frame 9, and the morph's name."""
    owner = add(request.param)
    bpy.ops.ifs_morph.key_straight()
    scene.frame_set(9)
    before, name = content(owner), owner.name
    file = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return file, name, before


def bring(file, name, link):
    """Bring an object of another file into the scene."""
    with bpy.data.libraries.load(file, link=link) as (_, into):
        into.objects = [name]
    bpy.context.scene.collection.objects.link(into.objects[0])
    activate(into.objects[0])
    show()
    return into.objects[0]


def at(owner, frame):
    bpy.context.scene.frame_set(frame)
    return content(owner)


@pytest.mark.parametrize("link", [False, True])
def test_morph_of_another_file_shows_its_frames(library, link):
    file, name, before = library
    owner = bring(file, name, link)
    assert at(owner, 9) == before
    assert at(owner, 10) != before
    assert at(owner, 9) == before


def test_appended_twice_each_has_its_own_output(library):
    file, name, before = library
    first, second = bring(file, name, False), bring(file, name, False)
    activate(second)
    second.animation_data_clear()
    second.ifs_morph.uv = 1, 1
    show()
    assert at(first, 9) == before
    assert at(second, 9) != before
    assert at(first, 9) == before


def test_linked_morph_says_that_it_cannot_be_changed(library, extension):
    file, name, _ = library
    bring(file, name, True)
    owner = bpy.context.view_layer.objects.active
    assert owner.library is not None
    for operator in EDITS:
        assert "linked from a library" in reason(getattr(bpy.ops.ifs_morph, operator)), operator
    assert "linked from a library" in sidebar(owner, extension)


def test_linked_morph_made_local_can_be_changed(library):
    file, name, _ = library
    owner = bring(file, name, True)
    bpy.ops.object.make_local(type="ALL")
    owner = bpy.context.view_layer.objects.active
    assert owner.library is None
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape="terdragon")
    show()
    assert len(owner.ifs_morph.final.maps) == 3
    assert at(owner, 3) != at(owner, 4)


def override(file, name):
    linked = bring(file, name, True)
    owner = linked.override_create(remap_local_usages=True)
    if owner.name not in bpy.context.scene.objects:
        bpy.context.scene.collection.objects.link(owner)
    bpy.context.view_layer.update()
    activate(owner)
    show()
    return owner


def test_override_can_be_placed_and_animated(library, extension):
    file, name, before = library
    owner = override(file, name)
    assert owner.override_library is not None
    assert at(owner, 9) == before
    owner.animation_data.action = None
    owner.ifs_morph.path.frame_end = 12
    assert bpy.ops.ifs_morph.key_straight() == {"FINISHED"}
    assert [(channel[0][0], channel[-1][0]) for channel in keys(owner, extension)] == [(1, 12)] * 3
    assert at(owner, 9) != before
    assert at(owner, 12) == at(owner, 20)


def test_override_with_a_linked_action_says_why_it_cannot_be_keyed(library):
    file, name, _ = library
    owner = override(file, name)
    assert owner.animation_data.action.library is not None
    assert "linked from a library" in reason(bpy.ops.ifs_morph.key_straight)


def test_override_is_saved(library, tmp_path):
    file, name, before = library
    owner = override(file, name)
    owner.animation_data.action = None
    owner.ifs_morph.uv = 1, 1
    owner.ifs_morph.initial.maps[0].translation = 0.25, 0
    owner.ifs_morph.output.resolution = 40, 40
    show()
    here = content(owner)
    assert here != before
    local = str(tmp_path / "shot.blend")
    bpy.ops.wm.save_as_mainfile(filepath=local)
    bpy.ops.wm.open_mainfile(filepath=local)
    owner = next(each for each in bpy.data.objects if each.override_library)
    show()
    assert tuple(owner.ifs_morph.uv) == (1, 1)
    np.testing.assert_allclose(owner.ifs_morph.initial.maps[0].translation, (0.25, 0))
    assert content(owner) == here


def test_override_and_its_library_show_different_places_at_once(library):
    file, name, before = library
    owner = override(file, name)
    linked = next(each for each in bpy.data.objects if each.library)
    if linked.name not in [each.name for each in bpy.context.scene.objects if each.library]:
        bpy.context.scene.collection.objects.link(linked)
    owner.animation_data.action = None
    owner.ifs_morph.uv = 1, 1
    show()
    bpy.context.scene.frame_set(9)
    assert content(linked) == before
    assert content(owner) != before


def _copied(owner):
    copy = owner.copy()
    bpy.context.scene.collection.objects.link(copy)
    return copy


def _duplicated(owner, linked):
    activate(owner)
    bpy.ops.object.duplicate(linked=linked)
    return bpy.context.view_layer.objects.active


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "duplicate",
    [_copied, lambda owner: _duplicated(owner, True), lambda owner: _duplicated(owner, False)],
    ids=["copy", "linked", "duplicate"],
)
def test_copies_of_copies_show_places_of_their_own(scene, kind, duplicate):
    owners = [add(kind)]
    for _ in range(3):
        owners.append(duplicate(owners[-1]))
    for k, owner in enumerate(owners):
        owner.ifs_morph.uv = k / 3, k / 3
    show()
    alone = []
    for k in range(4):
        owners[0].ifs_morph.uv = k / 3, k / 3
        show()
        alone.append(content(owners[0]))
    owners[0].ifs_morph.uv = 0, 0
    show()
    assert [content(owner) for owner in owners] == alone
    assert len(set(alone)) == 4


@pytest.mark.parametrize("kind", KINDS)
def test_copies_can_have_shapes_of_their_own(scene, kind):
    owner = add(kind)
    copy = _copied(owner)
    show()
    before = content(owner)
    activate(copy)
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Barnsley fern")
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape="maple leaf")
    show()
    assert content(owner) == before
    assert len(owner.ifs_morph.initial.maps) == 3
    assert len(copy.ifs_morph.initial.maps) == 4
    assert content(copy) != before


@pytest.mark.parametrize("kind", KINDS)
def test_the_original_may_go(scene, kind):
    owner = add(kind)
    copy = _copied(owner)
    show()
    before = content(copy)
    bpy.data.objects.remove(owner)
    bpy.ops.outliner.orphans_purge(do_recursive=True)
    copy.ifs_morph.uv = 1, 1
    show()
    assert content(copy) != before
    copy.ifs_morph.uv = 0, 0
    show()
    assert content(copy) == before
