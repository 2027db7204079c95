"""The list of pairs: written by hand, edited with buttons, and what is said where it does not fit."""

import bpy
import numpy as np
import pytest

from core.shapes import SHAPES
from tests.addon.interface import reason, sidebar
from tests.addon.pairing import FIRST, IDENTITY, LAST, listed, morph_of, pair, set_pairs
from tests.addon.support import activate, content, show

EDITS = (
    *("morph", "match_pairs", "pair_add"),
    *("clear_pairs", "pair_remove", "pair_swap", "pair_symmetry", "pair_split", "pair_join", "pairs_lock"),
)


@pytest.fixture(params=["IMAGE", "POINTS"])
def owner(request, scene):
    """Three maps that are to become four."""
    return pair("gasket", "square", request.param)


@pytest.fixture
def image(scene):
    return pair("gasket", "square")


UNFIT = {
    "Pair 4 names a map that the final shape does not have": (("1", "1"), ("2", "2"), ("3", "3"), ("3", "5")),
    "since none has “4”": (("1", "1"), ("2", "2"), ("3", "3")),
    "since none has “4 2”, “4 3”, “4 4”": (("1", "1"), ("2", "2"), ("3", "3"), ("3", "4 1")),
    "Pair 3: “x” is no map": (("1", "1"), ("2", "2"), ("3", "x"), ("3", "4")),
    "Pair 3: “” is no map": (("1", "1"), ("2", "2"), ("3", ""), ("3", "4")),
    "Pair 3: “0” is no map": (("1", "1"), ("2", "2"), ("3", "0"), ("3", "4")),
}


@pytest.mark.parametrize("what", UNFIT)
def test_pairs_that_do_not_fit_are_said_and_break_no_frame(owner, scene, extension, what):
    bpy.ops.ifs_morph.morph()
    set_pairs(owner, *UNFIT[what])
    assert "The pairs do not fit the maps, so map k becomes map k for now." in sidebar(owner, extension)
    assert what in sidebar(owner, extension)
    scene.frame_set(FIRST)
    first = content(owner)
    scene.frame_set(LAST)
    assert content(owner) != first
    assert morph_of(owner, extension).count == 4
    bpy.ops.ifs_morph.morph()
    assert "do not fit" not in sidebar(owner, extension)


def test_maps_that_change_under_the_pairs_are_said(image, scene, extension):
    bpy.ops.ifs_morph.morph()
    bpy.ops.ifs_morph.map_add(end="INITIAL")
    assert "do not fit the maps" in sidebar(image, extension)
    scene.frame_set(9)
    image.ifs_morph.initial.maps.remove(3)
    assert "do not fit" not in sidebar(image, extension)


def test_symmetry_that_the_shape_has_lost_is_said(image, extension):
    set_pairs(image, ("1", "1"), ("2", "2"), ("3", "3"), ("3", "4"))
    bpy.ops.ifs_morph.pair_symmetry(end="FINAL")
    assert tuple(map(tuple, image.ifs_morph.matching.pairs[0].final_symmetry)) != IDENTITY
    assert "do not fit" not in sidebar(image, extension)
    image.ifs_morph.final.maps[0].matrix[0][2] += 0.01
    assert "Pair 1 turns its final map by what is no symmetry of the shape any more" in sidebar(image, extension)


def test_growing_map_is_said_with_its_own_number(image, extension):
    bpy.ops.ifs_morph.morph()
    image.ifs_morph.final.maps[3].matrix = (1.5, 0, 0), (0, 0.5, 0)
    assert "map 4 does not contract" in sidebar(image, extension)
    assert "map 4 does not contract" in reason(bpy.ops.ifs_morph.morph)


def test_swapping_exchanges_what_pairs_become(image, extension):
    set_pairs(image, ("1", "1"), ("2", "2"), ("3", "3"), ("3", "4"))
    image.ifs_morph.matching.active_index = 1
    bpy.ops.ifs_morph.pair_swap(direction="UP")
    assert [each[:2] for each in listed(image)] == [("1", "2"), ("2", "1"), ("3", "3"), ("3", "4")]
    assert image.ifs_morph.matching.active_index == 0
    with pytest.raises(RuntimeError, match="at the end of the list"):
        bpy.ops.ifs_morph.pair_swap(direction="UP")


def test_symmetries_go_round(image, extension):
    set_pairs(image, ("1", "1"), ("2", "2"), ("3", "3"), ("3", "4"))
    described = extension.ifs_morph_addon.pairs.described
    item = image.ifs_morph.matching.pairs[0]
    found = []
    for _ in range(8):
        bpy.ops.ifs_morph.pair_symmetry(end="FINAL")
        found.append(described(item))
    assert "final turned by 90°" in found
    assert sum("mirrored" in text for text in found) == 4
    assert len(set(found)) == 8
    assert found[-1] == ""
    bpy.ops.ifs_morph.pair_symmetry(end="FINAL")
    item.winding = -1
    assert extension.ifs_morph_addon.pairs.line(item) == "1 → 1 ↺90° -1"
    assert "Final turned by 90°." in sidebar(image, extension)
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Barnsley fern")
    with pytest.raises(RuntimeError, match="no symmetries"):
        bpy.ops.ifs_morph.pair_symmetry(end="INITIAL")


def test_splitting_keeps_the_shape(image, extension):
    set_pairs(image, ("1", "1"), ("2", "2"), ("3", "3"), ("3", "4"))
    image.ifs_morph.matching.active_index = 2
    bpy.ops.ifs_morph.pair_split(end="INITIAL")
    # The two pairs of map 3 share its three parts.
    words = [each[:2] for each in listed(image)]
    assert words == [("1", "1"), ("2", "2"), ("3 1", "3"), ("3 2", "4"), ("3 3", "3")]
    bpy.ops.ifs_morph.pair_split(end="FINAL")
    assert [final for _, final, *_ in listed(image)].count("3 1") == 1
    assert "do not fit" not in sidebar(image, extension)
    np.testing.assert_allclose(morph_of(image, extension).at(0, 0).bounds, SHAPES["gasket"].bounds, atol=1e-3)
    np.testing.assert_allclose(morph_of(image, extension).at(1, 1).bounds, SHAPES["square"].bounds, atol=1e-3)


@pytest.mark.parametrize("end", ["INITIAL", "FINAL"])
@pytest.mark.parametrize("word", ["9", "1 9", "0", "-1", "1 0", "", "x"])
def test_map_that_is_not_there_cannot_be_split(image, extension, end, word):
    set_pairs(image, ("1", "1"), ("2", "2"), ("3", "3"), ("3", "4"))
    setattr(image.ifs_morph.matching.pairs[0], end.lower(), word)
    before = listed(image)
    with pytest.raises(RuntimeError, match="is no map"):
        bpy.ops.ifs_morph.pair_split(end=end)
    assert listed(image) == before


def test_maps_move_beside_a_pair_that_names_none(image, extension):
    set_pairs(image, ("1", "abc"), ("2", "9 1"), ("", "3"), ("3", "4"))
    assert bpy.ops.ifs_morph.map_move(end="FINAL", direction="DOWN") == {"FINISHED"}
    assert [each[1] for each in listed(image)] == ["abc", "9 2", "3", "4"]
    assert bpy.ops.ifs_morph.map_move(end="INITIAL", direction="DOWN") == {"FINISHED"}
    assert [each[0] for each in listed(image)] == ["2", "1", "", "3"]


def words(owner):
    """Both words of each pair."""
    return [each[:2] for each in listed(owner)]


def test_a_list_of_pairs_is_begun_without_a_search(owner, scene, extension):
    assert bpy.ops.ifs_morph.pair_add() == {"FINISHED"}
    assert words(owner) == [("1", "1"), ("2", "2"), ("3", "3"), ("1", "4")]
    assert not any(item.locked for item in owner.ifs_morph.matching.pairs)
    assert "do not fit" not in sidebar(owner, extension)
    show()
    assert morph_of(owner, extension).count == 4
    assert bpy.ops.ifs_morph.key_straight() == {"FINISHED"}


def test_a_list_that_would_be_too_long_is_not_begun(image, extension):
    for _ in range(61):
        image.ifs_morph.final.maps.add()
    with pytest.raises(RuntimeError, match="More than 64 pairs"):
        bpy.ops.ifs_morph.pair_add()
    assert listed(image) == []


def test_a_pair_is_added_for_what_is_in_none(image, extension):
    set_pairs(image, ("1", "1"), ("3 2", "2"), ("x", "3"))
    added = []
    for _ in range(4):
        bpy.ops.ifs_morph.pair_add()
        assert image.ifs_morph.matching.active_index == len(listed(image)) - 1
        added.append(words(image)[-1])
    # Where nothing is missing at one end, the active pair's map is doubled.
    assert added == [("2", "4"), ("3 1", "4"), ("3 3", "4"), ("3 3", "4")]
    image.ifs_morph.matching.pairs[2].initial = "1"
    assert "do not fit" not in sidebar(image, extension)


def test_a_doubled_pair_is_like_its_original(image, extension):
    set_pairs(image, ("1", "1"), ("2", "2"), ("3", "3"), ("3", "4"))
    bpy.ops.ifs_morph.pair_symmetry(end="FINAL")
    image.ifs_morph.matching.pairs[0].winding = 2
    image.ifs_morph.matching.pairs[0].locked = True
    bpy.ops.ifs_morph.pair_add()
    first, last = listed(image)[0], listed(image)[-1]
    assert (last[:5], last[5]) == (first[:5], False)
    assert first[3] != IDENTITY


def test_removing_leaves_the_others_and_says_what_is_missing(image, extension):
    set_pairs(image, ("1", "1"), ("2", "x"), ("3", "3"), ("3", "4"), ("3", "4"))
    image.ifs_morph.matching.active_index = 4
    assert bpy.ops.ifs_morph.pair_remove() == {"FINISHED"}
    assert image.ifs_morph.matching.active_index == 3
    image.ifs_morph.matching.active_index = 1
    assert bpy.ops.ifs_morph.pair_remove() == {"FINISHED"}
    assert image.ifs_morph.matching.active_index == 1
    assert words(image) == [("1", "1"), ("3", "3"), ("3", "4")]
    assert "the whole initial shape, since none has “2”" in sidebar(image, extension)
    bpy.ops.ifs_morph.pair_add()
    assert words(image)[-1] == ("2", "2")
    assert "do not fit" not in sidebar(image, extension)
    image.ifs_morph.matching.active_index = 7
    with pytest.raises(RuntimeError, match="no active pair"):
        bpy.ops.ifs_morph.pair_remove()
    assert len(listed(image)) == 4


def test_joining_undoes_a_split(image, extension):
    set_pairs(image, ("1", "1"), ("2", "2"), ("3", "3"), ("3", "4"))
    image.ifs_morph.matching.pairs[2].locked = True
    before = listed(image)
    for active, end in ((2, "INITIAL"), (1, "FINAL"), (0, "INITIAL")):
        image.ifs_morph.matching.active_index = active
        whole = listed(image)
        bpy.ops.ifs_morph.pair_split(end=end)
        assert listed(image) != whole
        image.ifs_morph.matching.active_index += 1
        bpy.ops.ifs_morph.pair_join(end=end)
        assert listed(image) == whole
        assert image.ifs_morph.matching.active_index in (active, active + 1)
        assert "do not fit" not in sidebar(image, extension)
    assert listed(image) == before
    with pytest.raises(RuntimeError, match="“1” is no part of a map"):
        bpy.ops.ifs_morph.pair_join(end="FINAL")


def test_joining_takes_all_parts_with_it(image, extension):
    set_pairs(image, ("1 1", "1"), ("1 2", "2"), ("1 3 1", "3"), ("1 3 2", "4"), ("1 3 3", "4"), ("2", "1"), ("3", "1"))
    bpy.ops.ifs_morph.pair_symmetry(end="INITIAL")
    bpy.ops.ifs_morph.pair_join(end="INITIAL")
    assert words(image) == [("1", "1"), ("1", "2"), ("1", "3"), ("1", "4"), ("2", "1"), ("3", "1")]
    assert all(each[2] == IDENTITY for each in listed(image))
    assert "do not fit" not in sidebar(image, extension)


@pytest.mark.parametrize("name", ["pair_add", "pair_remove", "pair_join"])
def test_changes_of_the_list_are_one_step_of_undo(image, extension, name):
    assert {"REGISTER", "UNDO"} <= getattr(extension.ifs_morph_addon.operators.pairs, f"IFSMORPH_OT_{name}").bl_options
    set_pairs(image, ("1 1", "1"), ("1 2", "2"), ("1 3", "3"), ("2", "4"), ("3", "4"))
    owner = image.name
    bpy.ops.ed.undo_push(message="before")
    before = listed(image)
    getattr(bpy.ops.ifs_morph, name)()
    after = listed(bpy.data.objects[owner])
    assert after != before
    bpy.ops.ed.undo_push(message="after")
    bpy.ops.ed.undo()
    assert listed(bpy.data.objects[owner]) == before
    bpy.ops.ed.redo()
    assert listed(bpy.data.objects[owner]) == after


def test_pairs_move_with_the_maps(image, extension):
    set_pairs(image, ("1", "1"), ("2", "2"), ("3 1", "3"), ("3 2", "4"), ("3 3", "4"))
    before = morph_of(image, extension).at(0.4, 0.4).maps
    image.ifs_morph.initial.active_index = 2
    bpy.ops.ifs_morph.map_move(end="INITIAL", direction="UP")
    assert [each[0] for each in listed(image)] == ["1", "3", "2 1", "2 3", "2 2"]
    np.testing.assert_allclose(morph_of(image, extension).at(0.4, 0.4).maps, before, atol=1e-6)


def test_pieces_have_the_colors_of_their_maps(image, extension):
    set_pairs(image, ("1", "4"), ("2", "3"), ("3", "2"), ("3", "1"))
    conversion = extension.ifs_morph_addon.conversion
    for u, shape, order in ((0, "initial", (0, 1, 2, 2)), (1, "final", (3, 2, 1, 0))):
        image.ifs_morph.uv = u, u
        expected = conversion.shape_colors(getattr(image.ifs_morph, shape))[list(order)]
        np.testing.assert_allclose(conversion.frame_colors(image.ifs_morph)[:, :3], expected)


def test_what_has_no_pairs_says_so(image, extension):
    for name in EDITS[3:]:
        assert "no pairs" in reason(getattr(bpy.ops.ifs_morph, name)), name
    assert "There are none" in sidebar(image, extension)


@pytest.fixture
def library(image, tmp_path):
    """A saved file with a matched morph, and its name."""
    bpy.ops.ifs_morph.morph()
    file, name = str(tmp_path / "library.blend"), image.name
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(file, link=True) as (_, into):
        into.objects = [name]
    linked = into.objects[0]
    bpy.context.scene.collection.objects.link(linked)
    activate(linked)
    show()
    return linked


def test_linked_morph_cannot_be_matched(library, extension):
    assert len(library.ifs_morph.matching.pairs) >= 4
    for name in EDITS:
        assert "linked from a library" in reason(getattr(bpy.ops.ifs_morph, name)), name


def test_override_keeps_the_number_of_its_pairs(library, extension):
    owner = library.override_create(remap_local_usages=True)
    if owner.name not in bpy.context.scene.objects:
        bpy.context.scene.collection.objects.link(owner)
    activate(owner)
    show()
    before = listed(owner)
    assert before
    bpy.ops.ifs_morph.pair_swap(direction="DOWN")
    assert listed(owner) != before
    after = listed(owner)
    for name in ("clear_pairs", "pair_remove"):
        with pytest.raises(RuntimeError, match="make the object local"):
            getattr(bpy.ops.ifs_morph, name)()
    assert listed(owner) == after
    bpy.ops.ifs_morph.pair_add()
    assert listed(owner)[:-1] == after
    bpy.ops.ifs_morph.pair_remove()
    assert listed(owner) == after
