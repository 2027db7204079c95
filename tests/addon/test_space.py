"""Shapes in space on objects: stored, shown as points, planned and keyed as those of the plane are."""

import bpy
import numpy as np
import pytest
from scipy.spatial import cKDTree

from core.cloud import point_cloud
from core.matching.symmetry import symmetries
from core.shapes import SHAPES
from core.space.morph import SpaceMorph
from core.space.shapes import SPACE_SHAPES
from tests.addon.interface import reason, sidebar
from tests.addon.support import add, attribute, picture, show

FERN = """
3dfern (3D) {
   .00  .00 0 .0 .18 .0 0  0.0 0.00 0 0.0 0 .01
   .85  .00 0 .0 .85 .1 0 -0.1 0.85 0 1.6 0 .85
   .20 -.20 0 .2 .20 .0 0  0.0 0.30 0 0.8 0 .07
  -.20  .20 0 .2 .20 .0 0  0.0 0.30 0 0.8 0 .07
}
"""


def load(initial, final):
    """Load shapes of the library onto the active object."""
    for end, name in (("INITIAL", initial), ("FINAL", final)):
        assert bpy.ops.ifs_morph.load_shape(end=end, shape=name) == {"FINISHED"}
    show()


@pytest.fixture
def tetrahedra(scene):
    owner = add("POINTS")
    load("turned tetrahedron", "Sierpinski tetrahedron")
    return owner


def test_points_are_those_of_the_morph_in_space(tetrahedra):
    tetrahedra.ifs_morph.uv = 0.3, 0.6
    show()
    morph = SpaceMorph(SPACE_SHAPES["turned tetrahedron"], SPACE_SHAPES["Sierpinski tetrahedron"])
    # Single precision moves the borders of the parts by a little, and with them which points there are.
    expected = point_cloud(morph.at(0.3, 0.6), 40_000)
    output = tetrahedra.ifs_morph.output
    x0, y0, x1, y1 = output.window
    z0, z1 = output.depth
    unit = max(x1 - x0, y1 - y0, z1 - z0)
    placed = (expected.position - np.array([x0 + x1, y0 + y1, z0 + z1]) / 2) / unit
    shown, letters = attribute(tetrahedra, "position"), attribute(tetrahedra, "attractorlet")[:, 0]
    assert len(shown) == 400
    assert np.abs(shown).max() <= 0.5
    for k in range(4):
        assert cKDTree(placed[expected.attractorlet == k]).query(shown[letters == k])[0].max() < 0.01


def test_a_path_is_planned_and_keyed(tetrahedra):
    tetrahedra.ifs_morph.path.method = "STRAIGHT"
    assert bpy.ops.ifs_morph.plan_path() == {"FINISHED"}
    assert "all in one piece" in tetrahedra.ifs_morph.path.report.splitlines()[0]
    before = attribute(tetrahedra, "position")
    bpy.context.scene.frame_set(12)
    assert not np.allclose(attribute(tetrahedra, "position"), before, atol=1e-3)
    assert bpy.ops.ifs_morph.check_path() == {"FINISHED"}
    assert bpy.ops.ifs_morph.compute_locus() == {"FINISHED"}


def test_images_say_why_they_show_no_shape_in_space(scene):
    owner = add("IMAGE")
    before = picture(owner)
    with pytest.raises(RuntimeError, match="point cloud"):
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Menger sponge")
    show()
    assert (picture(owner) == before).all()
    assert not owner.ifs_morph.initial.in_space
    owner.ifs_morph.initial.in_space = True
    show()
    assert not picture(owner).any()


def test_a_shape_of_the_plane_becomes_one_of_space(scene):
    owner = add("POINTS")
    load("square", "Sierpinski tetrahedron")
    assert owner.ifs_morph.final.in_space
    assert not owner.ifs_morph.initial.in_space
    points = attribute(owner, "position")
    assert np.ptp(points[:, 2]) == pytest.approx(0, abs=1e-6)
    owner.ifs_morph.uv = 1, 1
    show()
    assert np.ptp(attribute(owner, "position")[:, 2]) > 0.3


def test_an_entry_in_space_is_imported_and_exported(scene, tmp_path):
    file = tmp_path / "ferns.ifs"
    file.write_text(FERN)
    assert bpy.ops.ifs_morph.import_shapes(filepath=str(file), target="POINTS") == {"FINISHED"}
    owner = bpy.context.object
    show()
    assert owner.ifs_morph.initial.in_space
    assert len(owner.ifs_morph.initial.maps) == 4
    assert np.ptp(attribute(owner, "position"), axis=0).min() > 0.05
    objects = len(bpy.data.objects)
    with pytest.raises(RuntimeError, match="point cloud"):
        bpy.ops.ifs_morph.import_shapes(filepath=str(file), target="IMAGE")
    assert len(bpy.data.objects) == objects


def test_maps_that_flip_turn_over_through_space(scene):
    owner = add("POINTS")
    load("gasket", "gasket")
    first = owner.ifs_morph.initial.maps[0]
    first.scale = 0.5, -0.5
    owner.ifs_morph.uv = 0.5, 0.5
    show()
    assert np.ptp(attribute(owner, "position")[:, 2]) > 0.1
    owner.ifs_morph.flip = "PROJECTED"
    show()
    assert np.ptp(attribute(owner, "position")[:, 2]) == 0
    owner.ifs_morph.flip = "TURNED"
    for end in (0, 1):
        owner.ifs_morph.uv = end, end
        show()
        assert np.ptp(attribute(owner, "position")[:, 2]) == pytest.approx(0, abs=1e-6)


def test_one_press_morphs_shapes_in_space(scene, extension):
    owner = add("POINTS")
    owner.ifs_morph.path.frame_end = 12
    load("Sierpinski tetrahedron", "pyramid")
    assert "press Morph" in sidebar(owner, extension)
    assert bpy.ops.ifs_morph.morph() == {"FINISHED"}
    assert len(owner.ifs_morph.matching.pairs) >= 5
    assert "frames, all in one piece" in owner.ifs_morph.path.report
    for u, name in ((0, "Sierpinski tetrahedron"), (1, "pyramid")):
        morph = extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph)
        np.testing.assert_allclose(morph.at(u, u).bounds, SPACE_SHAPES[name].bounds, atol=1e-3)
    assert bpy.ops.ifs_morph.plan_path.poll()
    # A shape of the plane is put into space for it.
    load("gasket", "pyramid")
    assert bpy.ops.ifs_morph.match_pairs() == {"FINISHED"}
    show()
    assert np.ptp(attribute(owner, "position")[:, 2]) == pytest.approx(0, abs=1e-6)


def test_symmetries_of_space_are_kept_and_said(tetrahedra, extension):
    settings, pairs = tetrahedra.ifs_morph, extension.ifs_morph_addon.pairs
    settings.path.frame_end = 12
    bpy.ops.ifs_morph.match_pairs()
    conversion = extension.ifs_morph_addon.conversion
    stored, match = conversion.current_pairs(settings), matched(settings, extension)
    assert stored == match.pairs
    item = settings.matching.pairs[0]
    settings.matching.active_index = 0
    texts = set()
    for _ in range(24):
        bpy.ops.ifs_morph.pair_symmetry(end="FINAL")
        texts.add(pairs.described(item))
    assert len(texts) == 24
    assert sum("turned by 180° about" in text for text in texts) == 3
    assert conversion.pairs_problem(settings) == ""
    bpy.ops.ifs_morph.pair_split(end="INITIAL")
    assert conversion.pairs_problem(settings) == ""
    settings.initial.maps[0].matrix_in_space[0][3] += 0.01
    bpy.ops.ifs_morph.clear_pairs()
    assert len(settings.matching.pairs) == 0


def matched(settings, extension):
    """Return the match that the button makes."""
    conversion = extension.ifs_morph_addon.conversion
    return extension.core.matching.match(
        *conversion.shapes_of(settings), settings.path.frame_end - settings.path.frame_start + 1, flip="turned"
    )


def test_images_of_shapes_in_space_are_not_matched(scene):
    owner = add("IMAGE")
    owner.ifs_morph.initial.in_space = True
    assert "point cloud" in reason(bpy.ops.ifs_morph.morph)


def test_pairs_that_flip_turn_over_among_points(scene, extension):
    owner = add("POINTS")
    load("gasket", "gasket")
    for name in "123":
        item = owner.ifs_morph.matching.pairs.add()
        item.initial = item.final = name
    owner.ifs_morph.path.method = "STRAIGHT"
    item.final_symmetry = tuple(map(tuple, mirroring(SHAPES["gasket"])))
    assert bpy.ops.ifs_morph.plan_path() == {"FINISHED"}
    assert "Turned over through space, since only one end reflects: map 3." in owner.ifs_morph.path.report
    for u, height in ((0, 0), (0.5, 0.1), (1, 0)):
        owner.animation_data_clear()
        owner.ifs_morph.uv = u, u
        show()
        found = np.ptp(attribute(owner, "position")[:, 2])
        assert found > height if height else found == pytest.approx(0, abs=1e-6)
    fingerprint = extension.ifs_morph_addon.conversion.fingerprint
    before = fingerprint(owner.ifs_morph)
    owner.ifs_morph.flip = "PROJECTED"
    assert fingerprint(owner.ifs_morph) != before
    assert bpy.ops.ifs_morph.plan_path() == {"FINISHED"}
    assert "Flattened half-way, since only one end reflects: map 3." in owner.ifs_morph.path.report


def mirroring(ifs):
    """Return a symmetry of a shape that reflects."""
    return next(each for each in symmetries(ifs) if np.linalg.det(each[:, :2]) < 0).tolist()
