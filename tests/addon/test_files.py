"""Saving, loading, undo, libraries and overrides keep the morph, and bring its outputs back."""

import bpy
import numpy as np
import pytest

from tests.addon.support import activate, add, content, pixels, show

KINDS = ("IMAGE", "POINTS")


@pytest.fixture
def blend(tmp_path):
    return str(tmp_path / "morph.blend")


def morphs():
    return [thing for thing in bpy.data.objects if thing.ifs_morph.kind != "NONE"]


@pytest.mark.parametrize("kind", KINDS)
def test_outputs_come_back_with_the_file(scene, blend, kind):
    owner = add(kind)
    bpy.ops.ifs_morph.key_straight()
    scene.frame_set(9)
    before, name = content(owner), owner.name
    bpy.ops.wm.save_as_mainfile(filepath=blend)
    bpy.ops.wm.open_mainfile(filepath=blend)
    owner = bpy.data.objects[name]
    assert content(owner) == before
    bpy.context.scene.frame_set(10)
    assert content(owner) != before


def test_locus_and_path_come_back_with_the_file(scene, blend, extension):
    owner = add("IMAGE")
    bpy.ops.ifs_morph.compute_locus()
    bpy.ops.ifs_morph.plan_path()
    before, report = pixels(owner.ifs_morph.locus.image), owner.ifs_morph.path.report
    name, frames = owner.name, np.linspace(1, 24, 40)
    places = extension.ifs_morph_addon.fcurves.sample_path(owner, frames)
    bpy.ops.wm.save_as_mainfile(filepath=blend)
    bpy.ops.wm.open_mainfile(filepath=blend)
    owner = bpy.data.objects[name]
    np.testing.assert_array_equal(pixels(owner.ifs_morph.locus.image), before)
    assert owner.ifs_morph.path.report == report
    np.testing.assert_array_equal(extension.ifs_morph_addon.fcurves.sample_path(owner, frames), places)
    assert extension.ifs_morph_addon.locus_picture.is_current(owner.ifs_morph)


@pytest.mark.parametrize("kind", KINDS)
def test_undo_and_redo_bring_pictures_back(scene, kind):
    owner = add(kind)
    name = owner.name
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    before = content(owner)
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="terdragon")
    bpy.ops.ed.undo_push(message="after")
    show()
    after = content(bpy.data.objects[name])
    assert after != before
    bpy.ops.ed.undo()
    show()
    assert bpy.data.objects[name].ifs_morph.initial.name == "turned gasket"
    assert content(bpy.data.objects[name]) == before
    bpy.ops.ed.redo()
    show()
    assert bpy.data.objects[name].ifs_morph.initial.name == "terdragon"
    assert content(bpy.data.objects[name]) == after


@pytest.fixture
def library(scene, blend):
    """File with one morph of each kind, keyed; names and contents at frame 12 by kind."""
    known = {}
    for kind in KINDS:
        owner = add(kind)
        bpy.ops.ifs_morph.key_straight()
        scene.frame_set(12)
        known[kind] = owner.name, content(owner)
    bpy.ops.wm.save_as_mainfile(filepath=blend)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return blend, known


def load(library, kind, link):
    path, known = library
    name, expected = known[kind]
    with bpy.data.libraries.load(path, link=link) as (_, into):
        into.objects = [name]
    owner = into.objects[0]
    bpy.context.scene.collection.objects.link(owner)
    bpy.context.scene.frame_set(12)
    return owner, expected


@pytest.mark.parametrize("link", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_morphs_are_appended_and_linked(library, kind, link):
    owner, expected = load(library, kind, link)
    assert (owner.library is not None) == link
    assert content(owner) == expected
    activate(owner)
    assert bpy.ops.ifs_morph.compute_locus.poll() == (not link)
    assert bpy.ops.ifs_morph.load_shape.poll() == (not link)


@pytest.mark.parametrize("kind", KINDS)
def test_overrides_have_settings_and_outputs_of_their_own(library, blend, kind):
    linked, expected = load(library, kind, link=True)
    owner = linked.override_create(remap_local_usages=False)
    bpy.context.scene.collection.objects.link(owner)
    activate(owner)
    assert bpy.ops.ifs_morph.load_shape(end="FINAL", shape="terdragon") == {"FINISHED"}
    show()
    changed = content(owner)
    assert changed != expected
    assert content(linked) == expected
    assert bpy.ops.ifs_morph.compute_locus() == {"FINISHED"}
    with pytest.raises(RuntimeError, match="make the object local"):
        bpy.ops.ifs_morph.load_shape(end="FINAL", shape="Heighway dragon")
    with pytest.raises(RuntimeError, match="make the object local"):
        bpy.ops.ifs_morph.map_remove(end="FINAL")
    with pytest.raises(RuntimeError, match="make the object local"):
        bpy.ops.ifs_morph.map_move(end="FINAL", direction="DOWN")
    bpy.ops.ifs_morph.map_duplicate(end="INITIAL")
    assert len(owner.ifs_morph.initial.maps) == 4
    with pytest.raises(RuntimeError, match="make the object local"):
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="gasket")
    bpy.ops.ifs_morph.map_duplicate(end="FINAL")
    show()
    changed = content(owner)
    assert (owner.ifs_morph.final.name, len(owner.ifs_morph.final.maps)) == ("terdragon", 4)

    using = blend.replace("morph", "using")
    bpy.ops.wm.save_as_mainfile(filepath=using)
    bpy.ops.wm.open_mainfile(filepath=using)
    bpy.context.scene.frame_set(12)
    owner = next(thing for thing in morphs() if thing.override_library)
    assert owner.ifs_morph.final.name == "terdragon"
    assert owner.ifs_morph.locus.image is not None
    assert content(owner) == changed
    assert content(next(thing for thing in morphs() if thing.library)) == expected


def test_maps_of_an_override_stay_when_a_shape_has_too_few(library):
    linked, _ = load(library, "POINTS", link=True)
    owner = linked.override_create(remap_local_usages=False)
    bpy.context.scene.collection.objects.link(owner)
    activate(owner)
    for scale in (0.25, 0.125):
        owner.ifs_morph.initial.maps.add().matrix = ((scale, 0, 0), (0, scale, 0))
    before = [[tuple(row) for row in item.matrix] for item in owner.ifs_morph.initial.maps]
    with pytest.raises(RuntimeError, match="make the object local"):
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Hata tree")
    assert [[tuple(row) for row in item.matrix] for item in owner.ifs_morph.initial.maps] == before
