"""The locus as an image of the file: its pixels are core's, and it survives saving."""

import bpy
import numpy as np
import pytest

from tests.addon.interface import reason, sidebar
from tests.addon.support import activate, add, pixels


@pytest.fixture
def owner(scene):
    owner = add("POINTS")
    owner.ifs_morph.locus.resolution = 40
    return owner


def expected(owner, extension, domain=(-1, 2)):
    morph = extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph)
    return extension.core.locus.compute_locus(morph, 40, 1 / 300, domain)


def test_picture_is_that_of_the_locus(owner, extension):
    assert bpy.ops.ifs_morph.compute_locus() == {"FINISHED"}
    locus = expected(owner, extension)
    image = owner.ifs_morph.locus.image
    assert tuple(image.size) == (len(locus.u), len(locus.v))
    # Eight bits for each channel.
    np.testing.assert_allclose(pixels(image), locus.picture(), atol=1 / 255)
    assert (pixels(image)[locus.state == 0, :3] > 0.9).all()
    assert (pixels(image)[locus.state == 1, :3].min(axis=1) < 0.9).all()
    assert {0, 1} <= set(np.unique(locus.state))


def test_picture_knows_where_its_nodes_lie(owner, extension):
    bpy.ops.ifs_morph.compute_locus()
    locus = expected(owner, extension)
    picture = owner.ifs_morph.locus.image.ifs_morph_locus
    np.testing.assert_allclose(picture.lowest, (locus.u[0], locus.v[0]), atol=1e-6)
    np.testing.assert_allclose(picture.spacing, locus.u[1] - locus.u[0], rtol=1e-6)
    nodes = (np.array([(0, 0), (1, 1)]) - np.array(picture.lowest)) / picture.spacing
    np.testing.assert_allclose(nodes, np.round(nodes), atol=1e-4)


def test_other_domain(owner, extension):
    owner.ifs_morph.locus.domain = 0, 1
    bpy.ops.ifs_morph.compute_locus()
    locus = expected(owner, extension, (0, 1))
    np.testing.assert_allclose(pixels(owner.ifs_morph.locus.image), locus.picture(), atol=1 / 255)


@pytest.mark.parametrize("domain", [(1, 0), (0.5, 0.5)])
def test_empty_domain_is_refused_and_keeps_the_picture(owner, domain):
    bpy.ops.ifs_morph.compute_locus()
    before = owner.ifs_morph.locus.image, pixels(owner.ifs_morph.locus.image)
    owner.ifs_morph.locus.domain = domain
    with pytest.raises(RuntimeError, match="domain"):
        bpy.ops.ifs_morph.compute_locus()
    assert owner.ifs_morph.locus.image == before[0]
    np.testing.assert_array_equal(pixels(owner.ifs_morph.locus.image), before[1])


def test_domain_without_the_ends_still_plans(owner):
    owner.ifs_morph.locus.domain = 0.25, 0.75
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = 1, 9
    assert bpy.ops.ifs_morph.plan_path() == {"FINISHED"}
    assert "in one piece" in owner.ifs_morph.path.report.splitlines()[0]


def test_computing_again_leaves_one_picture(owner):
    bpy.ops.ifs_morph.compute_locus()
    name, count = owner.ifs_morph.locus.image.name, len(bpy.data.images)
    owner.ifs_morph.final.maps[0].winding = 1
    bpy.ops.ifs_morph.compute_locus()
    assert (owner.ifs_morph.locus.image.name, len(bpy.data.images)) == (name, count)


def test_out_of_date_is_said(owner, extension):
    bpy.ops.ifs_morph.compute_locus()
    settings = owner.ifs_morph

    def outdated():
        return "locus is out of date" in sidebar(owner, extension)

    assert not outdated()
    settings.uv = 0.5, 0.5
    settings.output.point_count = 500
    settings.initial.maps[0].color = 1, 0, 0
    assert not outdated()
    for holder, name, value in (
        (settings.initial.maps[0], "translation", (0.125, 0)),
        (settings.final.maps[1], "rotation", 1.0),
        (settings.final.maps[1], "winding", 1),
        (settings, "scheme", "ELEMENTWISE"),
        (settings, "gap_resolution", 150),
        (settings.locus, "resolution", 32),
        (settings.locus, "domain", (-0.5, 1.5)),
    ):
        before = getattr(holder, name)
        before = before if isinstance(before, (int, float, str)) else tuple(before)
        setattr(holder, name, value)
        assert outdated(), name
        bpy.ops.ifs_morph.compute_locus()
        assert not outdated(), name


def test_copies_may_share_a_locus_until_one_is_computed_anew(owner):
    bpy.ops.ifs_morph.compute_locus()
    image = owner.ifs_morph.locus.image
    before = pixels(image)
    activate(owner)
    bpy.ops.object.duplicate()
    copy = bpy.context.view_layer.objects.active
    copy.ifs_morph.final.maps[0].winding = 1
    bpy.ops.ifs_morph.compute_locus()
    assert copy.ifs_morph.locus.image != image
    assert owner.ifs_morph.locus.image == image
    np.testing.assert_array_equal(pixels(image), before)
    assert not np.array_equal(pixels(copy.ifs_morph.locus.image), before)


def test_picture_is_saved_with_the_file(owner, tmp_path):
    bpy.ops.ifs_morph.compute_locus()
    before = pixels(owner.ifs_morph.locus.image)
    file = str(tmp_path / "locus.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.wm.open_mainfile(filepath=file)
    owner = next(each for each in bpy.data.objects if each.ifs_morph.kind != "NONE")
    np.testing.assert_array_equal(pixels(owner.ifs_morph.locus.image), before)
    assert owner.ifs_morph.locus.image.ifs_morph_locus.spacing > 0


def test_showing_wants_a_locus_first(owner):
    assert not bpy.ops.ifs_morph.show_locus.poll()
    if not bpy.app.background:
        assert "Compute" in reason(bpy.ops.ifs_morph.show_locus)


def test_deleted_picture_can_be_computed_again(owner, extension):
    bpy.ops.ifs_morph.compute_locus()
    bpy.data.images.remove(owner.ifs_morph.locus.image)
    assert owner.ifs_morph.locus.image is None
    sidebar(owner, extension)
    bpy.ops.ifs_morph.compute_locus()
    assert owner.ifs_morph.locus.image is not None
