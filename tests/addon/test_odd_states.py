"""Frames still come when (u,v) is far out, or while somebody edits the mesh."""

import bpy
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
