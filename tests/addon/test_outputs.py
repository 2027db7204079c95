"""Pictures and points show the attractor at the evaluated (u,v), and are rendered only when it changes."""

import bpy
import numpy as np
import pytest

from core.cloud import point_cloud
from core.morph import Morph
from core.raster import render
from core.shapes import SHAPES
from tests.addon.support import activate, add, attribute, content, picture, pixels, show

KINDS = ("IMAGE", "POINTS")


@pytest.fixture
def draws(extension, monkeypatch):
    """Names of the objects that were rendered, in order."""
    outputs = extension.ifs_morph_addon.outputs
    names = []
    for module in outputs.KINDS.values():
        original = module.draw

        def draw(owner, *rest, original=original):
            names.append(owner.name)
            return original(owner, *rest)

        monkeypatch.setattr(module, "draw", draw)
    return names


@pytest.mark.parametrize(("place", "name"), [((0, 0), "turned gasket"), ((1, 1), "gasket")])
def test_image_shows_the_shapes_at_both_ends(scene, place, name):
    owner = add("IMAGE")
    owner.ifs_morph.output.mode = "SET"
    owner.ifs_morph.output.antialiasing = 1
    owner.ifs_morph.uv = place
    show()
    expected = render(SHAPES[name], (48, 48), tuple(owner.ifs_morph.output.window))
    shown = picture(owner)[..., 3] > 0
    # Maps are stored in single precision, which moves a point that lies just on the border of a pixel.
    assert np.mean(shown != (expected > 0)) < 0.01
    assert 0.05 < shown.mean() < 0.5


def test_points_are_those_of_the_attractor(scene):
    owner = add("POINTS")
    owner.ifs_morph.uv = 0.3, 0.6
    show()
    morph = Morph(SHAPES["turned gasket"], SHAPES["gasket"])
    expected = point_cloud(morph.at(0.3, 0.6), 400, morph.weights_at(0.5))
    left, bottom, right, top = owner.ifs_morph.output.window
    unit = max(right - left, top - bottom)
    position = attribute(owner, "position") * unit + [(left + right) / 2, (bottom + top) / 2, 0]
    np.testing.assert_allclose(position[:, :2], expected.position, atol=1e-5)
    np.testing.assert_array_equal(attribute(owner, "attractorlet")[:, 0], expected.attractorlet)
    np.testing.assert_allclose(attribute(owner, "radius")[:, 0] * unit, expected.radius, rtol=1e-3)


def test_points_have_the_colors_of_their_maps(scene):
    owner = add("POINTS")
    colors = np.float32([(1, 0, 0), (0, 1, 0), (0, 0, 1)])
    for shape in (owner.ifs_morph.initial, owner.ifs_morph.final):
        for item, color in zip(shape.maps, colors, strict=True):
            item.color = color
    show()
    np.testing.assert_array_equal(attribute(owner, "color")[:, :3], colors[attribute(owner, "attractorlet")[:, 0]])
    owner.ifs_morph.output.point_color = "SINGLE"
    owner.ifs_morph.output.color = 0.25, 0.5, 0.75, 1.0
    show()
    assert (attribute(owner, "color") == [0.25, 0.5, 0.75, 1.0]).all()


def test_points_become_a_point_cloud_with_material(scene):
    owner = add("POINTS")
    evaluated = owner.evaluated_get(bpy.context.evaluated_depsgraph_get())
    if not hasattr(evaluated, "evaluated_geometry"):
        pytest.skip("this Blender cannot be asked for the points of a modifier")
    geometry = evaluated.evaluated_geometry()
    cloud = geometry.pointcloud
    assert len(cloud.points) == 400
    assert cloud.materials[0].name == owner.ifs_morph.output.material.name
    assert {"attractorlet", "color", "radius"} <= set(cloud.attributes.keys())


def test_modes_and_looks_differ(scene):
    owner = add("IMAGE")
    output = owner.ifs_morph.output
    seen = {content(owner)}
    for name, value in (
        ("mode", "SET"),
        ("color", (1, 0, 0, 1)),
        ("background", (0, 0, 1, 0.5)),
        ("mode", "DENSITY"),
        ("curve", "GAMMA"),
        ("gamma", 1.0),
        ("exposure", -2.0),
        ("antialiasing", 3),
        ("fit_window", False),
        ("window", (0, 0, 1, 1)),
        ("resolution", (32, 16)),
    ):
        setattr(output, name, value)
        show()
        seen.add(content(owner))
    assert len(seen) == 11  # to turn fitting off changes nothing yet
    assert picture(owner).shape == (16, 32, 4)
    for element in output.ramp.color_ramp.elements:
        element.color = 0, 1, 0, 1
    owner.update_tag()
    show()
    assert content(owner) not in seen


@pytest.mark.parametrize("kind", KINDS)
def test_nothing_is_rendered_again_while_nothing_changes(scene, draws, kind):
    owner = add(kind)
    del draws[:]
    for frame in range(1, 5):
        scene.frame_set(frame)
    owner.location.x += 1
    show()
    owner.ifs_morph.uv = owner.ifs_morph.uv
    show()
    assert draws == []
    owner.ifs_morph.uv = 0.25, 0.25
    show()
    assert draws == [owner.name]


@pytest.mark.parametrize("kind", KINDS)
def test_frames_alone_equal_frames_of_a_run(scene, kind):
    owner = add(kind)
    bpy.ops.ifs_morph.key_straight()
    run = {}
    for frame in range(1, 25):
        scene.frame_set(frame)
        run[frame] = content(owner)
    assert len(set(run.values())) == 24
    for frame in (17, 3, 24, 1, 11):
        scene.frame_set(frame)
        assert content(owner) == run[frame], frame


@pytest.mark.parametrize("kind", KINDS)
def test_subframes_are_shown(scene, kind):
    owner = add(kind)
    bpy.ops.ifs_morph.key_straight()
    scene.frame_set(5)
    whole = content(owner)
    scene.frame_set(5, subframe=0.5)
    assert content(owner) != whole


@pytest.mark.parametrize("linked", [False, True])
@pytest.mark.parametrize("kind", KINDS)
def test_copies_have_outputs_of_their_own(scene, kind, linked):
    owner = add(kind)
    before = content(owner)
    activate(owner)
    bpy.ops.object.duplicate(linked=linked)
    copy = bpy.context.object
    assert copy != owner
    copy.ifs_morph.uv = 1, 1
    show()
    assert content(owner) == before
    assert content(copy) != before
    assert copy.data != owner.data
    for name in ("image", "spare_image", "material", "ramp", "nodes"):
        ours, theirs = getattr(owner.ifs_morph.output, name), getattr(copy.ifs_morph.output, name)
        assert ours is None or ours != theirs, name
    assert copy.material_slots[0].material == copy.ifs_morph.output.material
    for each in (owner, copy):
        if kind == "IMAGE":
            node = each.ifs_morph.output.material.node_tree.nodes["IFS Morph Image"]
            assert node.image == each.ifs_morph.output.image
        else:
            assert each.modifiers["IFS Morph"].node_group == each.ifs_morph.output.nodes


@pytest.mark.parametrize("kind", KINDS)
def test_deleted_datablocks_are_made_anew(scene, kind):
    owner = add(kind)
    before = content(owner)
    output = owner.ifs_morph.output
    for name, collection in (
        ("image", bpy.data.images),
        ("material", bpy.data.materials),
        ("ramp", bpy.data.textures),
        ("nodes", bpy.data.node_groups),
    ):
        if getattr(output, name) is not None:
            collection.remove(getattr(output, name))
            assert getattr(output, name) is None
            owner.update_tag()
            show()
            assert getattr(output, name) is not None, name
    assert content(owner) == before
    assert owner.material_slots[0].material == output.material


def test_output_taken_apart_is_repaired(scene):
    plane, cloud = add("IMAGE"), add("POINTS")
    cloud.modifiers.clear()
    bpy.ops.ifs_morph.repair_output()
    assert cloud.modifiers["IFS Morph"].node_group == cloud.ifs_morph.output.nodes
    activate(plane)
    plane.ifs_morph.output.material.node_tree.nodes.clear()
    bpy.ops.ifs_morph.repair_output()
    node = plane.material_slots[0].material.node_tree.nodes["IFS Morph Image"]
    assert node.image == plane.ifs_morph.output.image


@pytest.mark.parametrize("kind", KINDS)
def test_frames_without_attractor_are_empty_and_warn_once(scene, capfd, extension, kind):
    owner = add(kind)
    capfd.readouterr()
    item = owner.ifs_morph.initial.maps[0]
    for size in (1.5, 0.5, 1.6, 1.7):
        item.matrix = ((size, 0, 0), (0, size, 0))
        show()
    printed = capfd.readouterr().out
    assert printed.count("shows nothing") == 1
    assert "norm" in printed
    assert "norm" in extension.ifs_morph_addon.outputs.message(owner)
    if kind == "IMAGE":
        assert not picture(owner).any()
    else:
        assert len(owner.data.vertices) == 0
    item.matrix = ((0.5, 0, 0), (0, 0.5, 0))
    show()
    assert extension.ifs_morph_addon.outputs.message(owner) == ""
    assert picture(owner).any() if kind == "IMAGE" else len(owner.data.vertices) == 400


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda settings: settings.final.maps.clear(), "no maps"),
        (lambda settings: settings.final.maps.remove(0), "3 maps and the final one 2"),
        (lambda settings: setattr(settings.initial.maps[1], "matrix", ((float("nan"), 0, 0), (0, 0.5, 0))), "NaN"),
    ],
    ids=["empty", "unequal", "nan"],
)
@pytest.mark.parametrize("kind", KINDS)
def test_unsound_shapes_give_a_reason_and_no_traceback(scene, capfd, extension, kind, spoil, words):
    owner = add(kind)
    spoil(owner.ifs_morph)
    owner.update_tag()
    show()
    scene.frame_set(2)
    assert words in extension.ifs_morph_addon.outputs.message(owner)
    assert words in extension.ifs_morph_addon.conversion.shape_problem(owner.ifs_morph)
    assert "Traceback" not in capfd.readouterr().err
    assert not bpy.ops.ifs_morph.compute_locus.poll()
    assert not bpy.ops.ifs_morph.plan_path.poll()


def test_window_without_area_gives_a_reason(scene, capfd, extension):
    owner = add("IMAGE")
    owner.ifs_morph.output.fit_window = False
    owner.ifs_morph.output.window = 1, 0, 0, 1
    show()
    assert "window" in extension.ifs_morph_addon.outputs.message(owner)
    assert not picture(owner).any()
    assert "Traceback" not in capfd.readouterr().err


def test_window_holds_all_shapes_of_the_morph(scene):
    owner = add("IMAGE")
    left, bottom, right, top = owner.ifs_morph.output.window
    morph = Morph(SHAPES["turned gasket"], SHAPES["gasket"])
    for place in np.linspace(0, 1, 17):
        x0, y0, x1, y1 = morph.at(place, place).bounds
        assert left < x0 < x1 < right
        assert bottom < y0 < y1 < top
    corners = np.array([vertex.co[:2] for vertex in owner.data.vertices])
    np.testing.assert_allclose(corners.max(axis=0) - corners.min(axis=0), 1, rtol=1e-5)


def test_instanced_morphs_are_rendered(scene):
    owner = add("IMAGE")
    collection = bpy.data.collections.new("Hidden")
    collection.objects.link(owner)
    scene.collection.objects.unlink(owner)
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    scene.collection.objects.link(empty)
    show()
    before = content(owner)
    owner.ifs_morph.uv = 1, 1
    show()
    assert content(owner) != before


def test_rendered_plane_has_the_colors_of_the_picture(scene, tmp_path):
    owner = add("IMAGE", size=16)
    output = owner.ifs_morph.output
    output.mode = "SET"
    output.background = 0.8, 0.1, 0.1, 0.5
    scene.camera.data.type = "ORTHO"
    scene.camera.data.ortho_scale = owner.scale.x
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 64
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.film_transparent = True
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.filepath = str(tmp_path / "still.exr")
    bpy.ops.render.render(write_still=True)
    corner = pixels(bpy.data.images.load(scene.render.filepath))[1, 1]
    # Half of the light passes through a background of alpha one half; the file holds color times alpha.
    np.testing.assert_allclose(corner, (0.4, 0.05, 0.05, 0.5), rtol=0.1)
