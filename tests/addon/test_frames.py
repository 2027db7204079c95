"""A frame is a function of the file and its number: in another Blender, and after jumps, the same bytes."""

import hashlib

import bpy
import pytest

from tests.addon import another_blender
from tests.addon.support import activate, add, content

KINDS = ("IMAGE", "POINTS")

DIGESTS = """
import hashlib
sys.path.insert(0, sys.argv[1])
from tests.addon.support import content
bpy.ops.wm.open_mainfile(filepath=sys.argv[2])
for frame in map(float, sys.argv[3:]):
    bpy.context.scene.frame_set(int(frame), subframe=frame % 1)
    for owner in bpy.data.objects:
        if owner.ifs_morph.kind != "NONE":
            print("FRAME", frame, hashlib.sha256(content(owner)).hexdigest())
"""


def _digests(output):
    """Sets of digests by frame, from lines that start with FRAME."""
    digests = {}
    for line in output.splitlines():
        if line.startswith("FRAME"):
            _, frame, digest = line.split()
            digests.setdefault(float(frame), set()).add(digest)
    return digests


def _digest(owner):
    return hashlib.sha256(content(owner)).hexdigest()


def test_another_blender_shows_the_same_frames(scene, tmp_path, pytestconfig):
    owners = [add("IMAGE"), add("IMAGE"), add("POINTS")]
    owners[1].ifs_morph.output.mode = "DENSITY"
    for owner in owners:
        activate(owner)
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Barnsley fern")
        bpy.ops.ifs_morph.load_shape(end="FINAL", shape="maple leaf")
        bpy.ops.ifs_morph.key_straight()
    file = tmp_path / "morph.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    here = {}
    for frame in (1.0, 5.0, 5.5, 14.0, 24.0):
        scene.frame_set(int(frame), subframe=frame % 1)
        here[frame] = {_digest(owner) for owner in owners}
    assert len(set.union(*here.values())) == 15
    there = _digests(another_blender.run(DIGESTS, pytestconfig.rootpath, file, 14.0, 5.5, 24.0, 1.0, 5.0))
    assert there == here


def test_edits_are_shown_as_a_new_file_would_show_them(scene, tmp_path, pytestconfig):
    """What is on screen after edits in any order is what the file holds, not what was there before."""
    owner = add("IMAGE")
    settings = owner.ifs_morph
    bpy.ops.ifs_morph.key_straight()
    scene.frame_set(20)
    settings.output.mode = "DENSITY"
    settings.initial.maps[0].rotation = 0.3
    scene.frame_set(4)
    settings.output.ramp.color_ramp.elements[1].position = 0.5
    settings.final.maps[1].weight = 0.6
    settings.output.exposure = 1.0
    bpy.context.view_layer.update()
    here = _digest(owner)
    file = tmp_path / "morph.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(file))
    assert _digests(another_blender.run(DIGESTS, pytestconfig.rootpath, file, 4.0)) == {4.0: {here}}


@pytest.mark.parametrize("kind", KINDS)
def test_edits_elsewhere_render_nothing(scene, extension, monkeypatch, kind):
    owner = add(kind)
    bpy.ops.ifs_morph.key_straight()
    scene.frame_set(5)
    outputs, calls = extension.ifs_morph_addon.outputs, []
    render, cloud = extension.core.raster.render, outputs.points.point_cloud
    monkeypatch.setattr(outputs.image.raster, "render", lambda *a, **k: calls.append("image") or render(*a, **k))
    monkeypatch.setattr(outputs.points, "point_cloud", lambda *a, **k: calls.append("points") or cloud(*a, **k))
    other = bpy.data.objects.new("Other", bpy.data.meshes.new("Other"))
    scene.collection.objects.link(other)
    for edit in (
        lambda: setattr(other, "location", (1, 2, 3)),
        lambda: setattr(owner, "location", (1, 2, 3)),
        lambda: setattr(owner.ifs_morph, "gap_resolution", 100),
        lambda: setattr(owner.ifs_morph.path, "frame_end", 50),
        lambda: setattr(owner.ifs_morph.initial.maps[0], "name", "First"),
        lambda: bpy.data.materials.new("Other"),
        lambda: bpy.data.textures.new("Other", "CLOUDS"),
        lambda: scene.frame_set(5),
    ):
        edit()
        bpy.context.view_layer.update()
    assert calls == []
    scene.frame_set(30)  # past the end, where nothing moves
    del calls[:]
    for frame in (31, 40, 99):
        scene.frame_set(frame)
    assert calls == []
    scene.frame_set(5)
    assert len(calls) == 1


def test_scenes_at_different_frames_do_not_mix(scene):
    owner = add("IMAGE")
    bpy.ops.ifs_morph.key_straight()
    other = bpy.data.scenes.new("Other")
    other.collection.objects.link(owner)
    scene.frame_set(5)
    five = content(owner)
    other.frame_set(20)
    assert content(owner) != five
    scene.frame_set(5)
    assert content(owner) == five
