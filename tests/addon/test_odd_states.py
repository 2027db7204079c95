"""Frames still come when (u,v) is far out, or while somebody edits the mesh."""

import bpy
import numpy as np
import pytest

from tests.addon.support import add, content, show

pytestmark = pytest.mark.filterwarnings("error")
each_kind = pytest.mark.parametrize("kind", ["IMAGE", "POINTS"])


@each_kind
def test_place_far_away_is_drawn_or_said(scene, kind):
    owner = add(kind)
    before = content(owner)
    for place in ((3e38, 3e38), (-1e10, 1e20)):
        owner.ifs_morph.uv = place
        show()
    owner.ifs_morph.uv = 0, 0
    show()
    assert content(owner) == before


@each_kind
def test_frames_change_in_edit_mode(scene, kind):
    owner = add(kind)
    bpy.ops.ifs_morph.key_straight()
    before = content(owner)
    bpy.ops.object.mode_set(mode="EDIT")
    for frame in (5, 10):
        scene.frame_set(frame)
    bpy.ops.object.mode_set(mode="OBJECT")
    scene.frame_set(scene.frame_start)
    show()
    assert content(owner) == before


def test_exposure_beyond_all_bounds_is_held(scene):
    owner = add("IMAGE")
    owner.ifs_morph.output.mode = "DENSITY"
    owner.ifs_morph.output.exposure = 2000
    show()
    assert owner.ifs_morph.output.exposure == 50


@each_kind
def test_a_window_that_is_no_window_is_said_and_spoils_nothing(scene, kind):
    owner = add(kind)
    before = content(owner)
    owner.ifs_morph.output.fit_window = False
    window = tuple(owner.ifs_morph.output.window)
    owner.ifs_morph.output.window = (float("nan"), 0, 1, 1)
    show()
    corners = np.empty(3 * len(owner.data.vertices), dtype=np.float32)
    owner.data.vertices.foreach_get("co", corners)
    assert np.isfinite(corners).all()
    owner.ifs_morph.output.window = window
    show()
    assert content(owner) == before


@each_kind
def test_huge_maps_are_held_within_what_can_be_drawn(scene, kind):
    owner = add(kind)
    owner.ifs_morph.initial.maps[0].matrix = ((0.5, 0, float("inf")), (0, 0.5, 0))
    show()
    assert np.isfinite(np.array(owner.ifs_morph.initial.maps[0].matrix)).all()


def test_a_locus_without_a_domain_is_refused(scene):
    owner = add("IMAGE")
    owner.ifs_morph.locus.domain = float("nan"), 1
    with pytest.raises(RuntimeError, match="its end must be above its start"):
        bpy.ops.ifs_morph.compute_locus()
    assert owner.ifs_morph.locus.image is None
