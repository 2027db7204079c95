"""Hidden and faint maps on objects: read from flames, drawn as the file means it, edited, copied and written again."""

import bpy
import numpy as np
import pytest

from core.formats import read_file, read_shapes
from tests.addon.interface import keys
from tests.addon.support import add, attribute, content, picture, show

FLAME = """<flame name="veiled"><xform weight="1" linear="1" coefs="0.5 0 0 0.5 0 0"/>
<xform weight="1" linear="1" opacity="0" coefs="0.5 0 0 0.5 0.5 0"/>
<xform weight="1" linear="1" opacity="0.25" coefs="0.5 0 0 0.5 0 -0.5"/></flame>"""


@pytest.fixture
def conversion(extension):
    return extension.ifs_morph_addon.conversion


@pytest.fixture
def flame(tmp_path):
    path = tmp_path / "veiled.flame"
    path.write_text(FLAME)
    return str(path)


@pytest.fixture
def owner(scene):
    owner = add("IMAGE")
    for end in ("INITIAL", "FINAL"):
        bpy.ops.ifs_morph.load_shape(end=end, shape="gasket")
    show()
    return owner


def imported(flame, kind):
    """Add the shape of the flame, at both ends of a small morph object."""
    owner = add(kind)
    for target in ("INITIAL", "FINAL"):
        bpy.ops.ifs_morph.import_shapes(filepath=flame, target=target)
    show()
    return owner


def opacities(shape):
    return [item.opacity for item in shape.maps]


def test_a_hidden_map_of_a_flame_is_not_drawn(scene, flame, capfd):
    owner = imported(flame, "IMAGE")
    settings = owner.ifs_morph
    assert opacities(settings.initial) == opacities(settings.final) == [1, 0, 0.25]
    assert "hidden" not in capfd.readouterr().out
    output = settings.output
    output.fit_window, output.window = False, (-0.02, -0.02, 1.02, 1.02)
    output.mode, output.antialiasing = "SET", 1
    show()
    alpha = picture(owner)[..., 3] > 0.5
    # The map at the right is missing, those at the left and above are there.
    middle = 24
    assert not alpha[: middle - 1, middle + 1 :].any()
    assert alpha[: middle - 1, : middle - 1].any()
    assert alpha[middle + 1 :, : middle - 1].any()
    settings.initial.maps[1].opacity = 1
    show()
    assert (picture(owner)[..., 3] > 0.5)[: middle - 1, middle + 1 :].any()


def test_what_is_faint_is_dim_in_a_density(scene, flame):
    owner = imported(flame, "IMAGE")
    settings = owner.ifs_morph
    settings.output.mode, settings.output.exposure = "DENSITY", 3
    shown = []
    for opacity in (0.0, 0.25, 1.0):
        settings.initial.maps[2].opacity = opacity
        show()
        shown.append(picture(owner)[..., 3].sum())
    assert shown[0] < shown[1] < shown[2]


def test_no_points_fall_to_hidden_maps(scene, flame):
    owner = imported(flame, "POINTS")
    letters, counts = np.unique(attribute(owner, "attractorlet"), return_counts=True)
    assert letters.tolist() == [0, 2]
    assert counts.tolist() == [320, 80]


def test_points_come_and_go_with_a_map_that_is_hidden_at_one_end(scene, flame):
    owner = imported(flame, "POINTS")
    settings = owner.ifs_morph
    settings.final.maps[1].opacity = 1
    seen = {}
    for u in (0.0, 0.5, 1.0):
        settings.uv = u, u
        show()
        seen[u] = np.bincount(attribute(owner, "attractorlet").ravel(), minlength=3).tolist()
        assert len(attribute(owner, "color")) == sum(seen[u])
    assert seen[0.5] == seen[1.0]
    assert sum(seen[0.5]) == 400
    assert seen[0.0] == [seen[0.5][0], 0, seen[0.5][2]], "the others are the same points"


def test_a_map_fades_in_along_the_morph(owner, conversion):
    settings = owner.ifs_morph
    settings.initial.maps[2].opacity = 0
    morph = conversion.morph_of(settings)
    assert [morph.at(u, u).opacity[2] for u in (0, 0.25, 1)] == [0, 0.25, 1]
    settings.output.mode = "ATTRACTORLET"
    colors = []
    for u in (0.0, 0.01, 1.0):
        settings.uv = u, u
        show()
        colors.append(content(owner))
    assert colors[0] != colors[1]


def test_all_maps_hidden_is_said(owner, conversion):
    for item in owner.ifs_morph.initial.maps:
        item.opacity = 0
    assert "all its maps are hidden" in conversion.shape_problem(owner.ifs_morph)


def test_opacity_is_a_factor(owner):
    described = owner.ifs_morph.initial.maps[0].bl_rna.properties["opacity"]
    assert (described.name, described.subtype, described.default) == ("Opacity", "FACTOR", 1)
    assert (described.hard_min, described.hard_max, described.is_animatable) == (0, 1, False)


def test_copies_of_a_map_and_the_library(owner):
    shape = owner.ifs_morph.initial
    shape.maps[0].opacity = 0.5
    shape.active_index = 0
    bpy.ops.ifs_morph.map_duplicate(end="INITIAL")
    assert opacities(shape) == [0.5, 0.5, 1, 1]
    bpy.ops.ifs_morph.map_move(end="INITIAL", direction="DOWN")
    assert opacities(shape) == [0.5, 1, 0.5, 1]
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="gasket")
    assert opacities(shape) == [1, 1, 1]


def test_fingerprints_change_only_with_what_is_hidden(owner, conversion):
    """Loci and paths of files without hidden maps stay current, and a faint map changes neither."""
    settings = owner.ifs_morph
    before = conversion.locus_fingerprint(settings), conversion.path_fingerprint(settings)
    item = settings.initial.maps[1]
    item.opacity = 0.5
    assert (conversion.locus_fingerprint(settings), conversion.path_fingerprint(settings)) == before
    item.opacity = 0
    hidden = conversion.locus_fingerprint(settings), conversion.path_fingerprint(settings)
    assert hidden[0] != before[0]
    assert hidden[1] != before[1]
    item.opacity, settings.initial.maps[2].opacity = 1, 0
    assert conversion.locus_fingerprint(settings) not in (before[0], hidden[0])
    settings.initial.maps[2].opacity = 1
    assert (conversion.locus_fingerprint(settings), conversion.path_fingerprint(settings)) == before


def test_undo_brings_a_hidden_map_back(owner):
    bpy.context.preferences.edit.use_global_undo = True
    name, before = owner.name, content(owner)
    bpy.ops.ed.undo_push(message="before")
    owner.ifs_morph.initial.maps[0].opacity = 0
    show()
    hidden = content(owner)
    assert hidden != before
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    show()
    assert content(bpy.data.objects[name]) == before
    bpy.ops.ed.redo()
    show()
    assert content(bpy.data.objects[name]) == hidden


def test_flames_are_written_with_opacities_and_fractint_says_that_it_cannot(owner, tmp_path):
    initial = owner.ifs_morph.initial
    initial.maps[0].opacity, initial.maps[1].opacity = 0, 0.3
    path = tmp_path / "out.flame"
    bpy.ops.ifs_morph.export_shapes(filepath=str(path), shapes={"INITIAL", "FINAL", "FRAME"})
    entries = read_file(path).entries
    assert entries[0].opacities.tolist() == [0, 0.3, 1]
    assert entries[1].opacities is None
    assert read_shapes(path)[entries[2].name].opacity.tolist() == [0, np.float32(0.3), 1]
    bpy.ops.ifs_morph.import_shapes(filepath=str(path), entry=entries[0].name, target="FINAL")
    assert opacities(owner.ifs_morph.final) == opacities(initial)
    with pytest.raises(RuntimeError, match=r"an opacity of 0, for which an \.ifs file has no place"):
        bpy.ops.ifs_morph.export_shapes(filepath=str(tmp_path / "out.ifs"), shapes={"INITIAL"})


def test_morph_matches_shapes_that_hide_maps(owner, conversion, extension):
    settings = owner.ifs_morph
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape="terdragon")
    settings.initial.maps[0].opacity = 0
    bpy.ops.ifs_morph.morph()
    assert "all in one piece" in settings.path.report
    assert all(keys(owner, extension)[:2])
    pairs = conversion.current_pairs(settings)
    hidden = [pair.initial[0] == 0 for pair in pairs]
    assert (conversion.morph_of(settings).initial.opacity == 0).tolist() == hidden
