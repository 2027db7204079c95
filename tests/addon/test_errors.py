"""Whatever an animator spoils is said in a sentence: no traceback, nothing lost, and it heals."""

import bpy
import numpy as np
import pytest

from tests.addon.interface import keys, reason, sidebar
from tests.addon.support import activate, add, content, show

KINDS = ("IMAGE", "POINTS")
NAN = float("nan")

SPOILERS = {
    "nan": (lambda shape: setattr(shape.maps[1], "matrix", ((NAN, 0, 0), (0, 0.5, 0))), "map 2 holds NaN"),
    "growing": (lambda shape: setattr(shape.maps[0], "matrix", ((1.5, 0, 0), (0, 0.5, 0))), "map 1 does not contract"),
    "no maps": (lambda shape: shape.maps.clear(), "has no maps"),
    "fewer maps": (lambda shape: shape.maps.remove(0), "both must have as many"),
    "more maps": (lambda shape: shape.maps.add(), "both must have as many"),
    "many maps": (lambda shape: [shape.maps.add() for _ in range(300)], "both must have as many"),
}


@pytest.fixture(autouse=True)
def no_traceback(capfd):
    """Handlers print what goes wrong in them to standard error; nothing may."""
    yield
    printed = capfd.readouterr()
    assert "Traceback" not in printed.err + printed.out
    assert "Error:" not in printed.err


def _store(shape):
    return [[list(row) for row in item.matrix] for item in shape.maps]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("end", ["initial", "final"])
@pytest.mark.parametrize("what", SPOILERS)
def test_spoiled_shape_is_said_and_heals(scene, extension, kind, end, what):
    owner = add(kind)
    settings = owner.ifs_morph
    bpy.ops.ifs_morph.key_straight()
    scene.frame_set(12)
    before, keyed, report = content(owner), keys(owner, extension), settings.path.report
    shape = getattr(settings, end)
    name = shape.name
    spoil, words = SPOILERS[what]
    spoil(shape)
    owner.update_tag()
    show()
    for frame in (1, 24, 12):
        scene.frame_set(frame)
    assert words in sidebar(owner, extension)
    for operator in (bpy.ops.ifs_morph.compute_locus, bpy.ops.ifs_morph.plan_path, bpy.ops.ifs_morph.key_straight):
        assert words in reason(operator)
    assert words in reason(bpy.ops.ifs_morph.check_path)
    # Loading a sound shape mends all; the keys and their report were kept.
    assert keys(owner, extension) == keyed
    assert settings.path.report == report
    bpy.ops.ifs_morph.load_shape(end=end.upper(), shape=name)
    show()
    assert content(owner) == before
    assert words not in sidebar(owner, extension)


@pytest.mark.parametrize("kind", KINDS)
def test_spoiled_shape_is_saved_as_it_is(scene, extension, tmp_path, kind):
    owner = add(kind)
    owner.ifs_morph.final.maps.remove(0)
    owner.ifs_morph.initial.maps[0].matrix = (1.5, 0, 0), (0, 0.5, 0)
    before, name = [_store(owner.ifs_morph.initial), _store(owner.ifs_morph.final)], owner.name
    file = str(tmp_path / "spoiled.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    owner = bpy.data.objects[name]
    assert [_store(owner.ifs_morph.initial), _store(owner.ifs_morph.final)] == before
    assert "both must have as many" in sidebar(owner, extension)


@pytest.mark.parametrize("kind", KINDS)
def test_every_list_operator_works_on_spoiled_shapes(scene, extension, kind):
    owner = add(kind)
    for _ in range(2):
        bpy.ops.ifs_morph.map_add(end="INITIAL")
        show()
    bpy.ops.ifs_morph.map_duplicate(end="INITIAL")
    bpy.ops.ifs_morph.map_move(end="INITIAL", direction="UP")
    for _ in range(3):
        bpy.ops.ifs_morph.map_remove(end="INITIAL")
        show()
    assert len(owner.ifs_morph.initial.maps) == 3
    assert "as many" not in sidebar(owner, extension)


@pytest.mark.parametrize("kind", KINDS)
def test_animation_without_attractors_warns_once(scene, extension, capfd, kind):
    owner = add(kind)
    settings = owner.ifs_morph
    # Between these two the winding map is fine at both ends; u beyond them makes it grow.
    settings.initial.maps[0].matrix = (0.5, 0, 0), (0, 0.5, 0)
    settings.final.maps[0].matrix = (0.9, 0, 0), (0, 0.9, 0)
    for frame, u in ((1, 0.0), (10, 6.0)):
        settings.uv = u, 0.0
        owner.keyframe_insert("ifs_morph.uv", frame=frame)
    capfd.readouterr()
    shown = {}
    for frame in (*range(1, 11), *range(1, 11)):
        scene.frame_set(frame)
        shown[frame] = len(owner.data.vertices) if kind == "POINTS" else np.frombuffer(content(owner), np.float32).any()
    assert shown[1]
    assert not shown[10]
    printed = capfd.readouterr().out
    assert printed.count("IFS Morph:") == 1
    assert owner.name in printed
    assert "norm" in sidebar(owner, extension)
    scene.frame_set(1)
    assert "norm" not in sidebar(owner, extension)


def _remove(collection, datablock):
    getattr(bpy.data, collection).remove(datablock)


DELETED = {
    "image": ("IMAGE", lambda owner: _remove("images", owner.ifs_morph.output.image)),
    "ramp": ("IMAGE", lambda owner: _remove("textures", owner.ifs_morph.output.ramp)),
    "image's material": ("IMAGE", lambda owner: _remove("materials", owner.ifs_morph.output.material)),
    "node for the image": ("IMAGE", lambda owner: owner.ifs_morph.output.material.node_tree.nodes.clear()),
    "material slot": ("IMAGE", lambda owner: owner.data.materials.clear()),
    "UV map": ("IMAGE", lambda owner: owner.data.uv_layers.remove(owner.data.uv_layers[0])),
    "plane's vertices": ("IMAGE", lambda owner: owner.data.clear_geometry()),
    "points' material": ("POINTS", lambda owner: _remove("materials", owner.ifs_morph.output.material)),
    "modifier": ("POINTS", lambda owner: owner.modifiers.clear()),
    "node group": ("POINTS", lambda owner: _remove("node_groups", owner.ifs_morph.output.nodes)),
    "nodes": ("POINTS", lambda owner: owner.ifs_morph.output.nodes.nodes.clear()),
    "attribute": ("POINTS", lambda owner: owner.data.attributes.remove(owner.data.attributes["radius"])),
    "points": ("POINTS", lambda owner: owner.data.clear_geometry()),
}


@pytest.mark.parametrize("mode", ["ATTRACTORLET", "DENSITY"])
@pytest.mark.parametrize("what", DELETED)
def test_deleted_parts_do_no_harm_and_can_be_repaired(scene, extension, what, mode):
    kind, delete = DELETED[what]
    owner = add(kind)
    owner.ifs_morph.output.mode = mode
    bpy.ops.ifs_morph.key_straight()
    scene.frame_set(12)
    before, keyed = content(owner), keys(owner, extension)
    delete(owner)
    scene.frame_set(13)
    sidebar(owner, extension)
    owner.ifs_morph.output.mode = "SET"
    show()
    owner.ifs_morph.output.mode = mode
    bpy.ops.ifs_morph.repair_output()
    show()
    scene.frame_set(12)
    assert content(owner) == before
    assert keys(owner, extension) == keyed
    if kind == "POINTS":
        modifier = owner.modifiers[0]
        assert modifier.node_group == owner.ifs_morph.output.nodes
        assert len(modifier.node_group.nodes) > 3
    else:
        assert owner.material_slots[0].material == owner.ifs_morph.output.material
        nodes = owner.ifs_morph.output.material.node_tree.nodes
        assert [node.image for node in nodes if node.type == "TEX_IMAGE"] == [owner.ifs_morph.output.image]


@pytest.mark.parametrize("kind", KINDS)
def test_deleted_object_is_forgotten(scene, kind):
    owner = add(kind)
    other = add(kind)
    before = content(other)
    bpy.data.objects.remove(owner)
    show()
    scene.frame_set(2)
    assert content(other) == before


def test_sidebar_says_how_to_begin(scene, extension):
    sidebar(None, extension)
    cube = bpy.data.objects.new("Cube", bpy.data.meshes.new("Cube"))
    scene.collection.objects.link(cube)
    sidebar(cube, extension)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("mode", ["SET", "DENSITY", "ATTRACTORLET"])
def test_sidebar_is_drawn_for_every_kind_and_mode(scene, extension, kind, mode):
    owner = add(kind)
    owner.ifs_morph.output.mode, owner.ifs_morph.output.curve = mode, "GAMMA"
    assert "Matrix:" in sidebar(owner, extension)


@pytest.mark.parametrize("resolution", [(8, 8), (200, 8), (8, 200)])
@pytest.mark.parametrize("mode", ["SET", "DENSITY", "ATTRACTORLET"])
def test_odd_resolutions_are_shown(scene, resolution, mode):
    owner = add("IMAGE")
    owner.ifs_morph.output.mode, owner.ifs_morph.output.resolution = mode, resolution
    show()
    assert tuple(owner.ifs_morph.output.image.size) == resolution
    assert np.frombuffer(content(owner), np.float32).any()


@pytest.mark.parametrize("kind", KINDS)
def test_more_maps_than_can_be_told_apart(scene, extension, kind):
    owner = add(kind)
    for shape in (owner.ifs_morph.initial, owner.ifs_morph.final):
        while len(shape.maps) < 256:
            shape.maps.add().matrix = (0.01, 0, len(shape.maps) / 256), (0, 0.01, 0)
    owner.update_tag()
    show()
    if kind == "IMAGE":
        assert "255" in sidebar(owner, extension)
    else:
        assert len(owner.data.vertices) > 0


@pytest.mark.parametrize("kind", KINDS)
def test_one_point_is_enough(scene, kind):
    owner = add(kind)
    owner.ifs_morph.output.point_count = 1
    for shape in (owner.ifs_morph.initial, owner.ifs_morph.final):
        while len(shape.maps) > 1:
            shape.maps.remove(0)
    owner.update_tag()
    show()
    assert len(owner.data.vertices) == (1 if kind == "POINTS" else 4)


def test_object_of_another_type_with_settings_does_no_harm(scene, extension):
    """Somebody's script, or object data replaced by hand."""
    owner = add("POINTS")
    owner.data = bpy.data.meshes.new("Other")
    show()
    activate(owner)
    bpy.ops.ifs_morph.repair_output()
    show()
    assert len(owner.data.vertices) == owner.ifs_morph.output.point_count


WITHOUT_AREA = [(0, 0, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1), (1, 1, 0, 0)]


@pytest.mark.parametrize("window", WITHOUT_AREA, ids=str)
def test_window_without_area_is_said(scene, extension, window):
    owner = add("IMAGE")
    before = content(owner)
    owner.ifs_morph.output.fit_window = False
    owner.ifs_morph.output.window = window
    show()
    assert "The window has no area" in sidebar(owner, extension)
    assert np.isfinite([tuple(vertex.co) for vertex in owner.data.vertices]).all()
    owner.ifs_morph.output.fit_window = True
    show()
    assert content(owner) == before


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("name", "value"), [("uv", (NAN, 0)), ("uv", (0, NAN)), ("swell", NAN)])
def test_place_that_is_not_a_number_is_said(scene, extension, kind, name, value):
    owner = add(kind)
    before = content(owner)
    setattr(owner.ifs_morph, name, value)
    show()
    assert "NaN" in sidebar(owner, extension)
    owner.ifs_morph.uv, owner.ifs_morph.swell = (0, 0), 0
    show()
    assert content(owner) == before


def test_weight_that_is_not_a_number_is_said(scene, extension):
    owner = add("POINTS")
    before = content(owner)
    owner.ifs_morph.initial.maps[0].weight = NAN
    show()
    assert "weight" in sidebar(owner, extension)
    owner.ifs_morph.initial.maps[0].weight = 0
    show()
    assert "weight" not in sidebar(owner, extension)
    assert content(owner) == before
