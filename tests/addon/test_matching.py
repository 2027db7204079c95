"""Any shape into any shape in Blender: the Morph button, the pairs it leaves on the object, and their editing."""

import bpy
import numpy as np
import pytest

from core.connectedness import Connectedness, connectedness
from core.morph import Morph
from core.report import check_frames
from core.shapes import SHAPES
from tests.addon.interface import keys, reason, sidebar
from tests.addon.support import activate, add, content, show

FIRST, LAST = 3, 18
IDENTITY = ((1, 0, 0), (0, 1, 0))
EDITS = (
    *("morph", "match_pairs", "pair_add"),
    *("clear_pairs", "pair_remove", "pair_swap", "pair_symmetry", "pair_split", "pair_join", "pairs_lock"),
)


def pair(initial, final, kind="IMAGE"):
    """Add a small object whose shapes are to be matched."""
    owner = add(kind)
    owner.ifs_morph.path.frame_start, owner.ifs_morph.path.frame_end = FIRST, LAST
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape=initial)
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape=final)
    show()
    return owner


@pytest.fixture(params=["IMAGE", "POINTS"])
def owner(request, scene):
    """Three maps that are to become four."""
    return pair("gasket", "square", request.param)


@pytest.fixture
def image(scene):
    return pair("gasket", "square")


def listed(owner):
    """All that is stored about the pairs."""
    return [
        (
            item.initial,
            item.final,
            tuple(map(tuple, item.initial_symmetry)),
            tuple(map(tuple, item.final_symmetry)),
            item.winding,
            item.locked,
        )
        for item in owner.ifs_morph.matching.pairs
    ]


def set_pairs(owner, *pairs):
    """Store pairs as a person may write them."""
    stored = owner.ifs_morph.matching.pairs
    stored.clear()
    for initial, final in pairs:
        item = stored.add()
        item.initial, item.final = initial, final
    show()


def state(owner, extension):
    settings = owner.ifs_morph
    return (
        keys(owner, extension),
        listed(owner),
        settings.path.report,
        settings.path.inputs,
        tuple(settings.output.window),
        tuple(settings.uv),
    )


def morph_of(owner, extension):
    return extension.ifs_morph_addon.conversion.morph_of(owner.ifs_morph)


def sampled(owner, extension):
    return extension.ifs_morph_addon.fcurves.sample_path(owner, range(FIRST, LAST + 1))


def test_one_press_morphs_shapes_with_different_numbers_of_maps(owner, scene, extension):
    assert "press Morph" in sidebar(owner, extension)
    assert "press Morph" in reason(bpy.ops.ifs_morph.plan_path)
    assert bpy.ops.ifs_morph.morph() == {"FINISHED"}
    morph = morph_of(owner, extension)
    assert morph.count == len(owner.ifs_morph.matching.pairs) >= 4
    check = check_frames(morph, sampled(owner, extension))
    assert check.count(Connectedness.CONNECTED) == LAST - FIRST + 1
    frames = [frame for frame, _ in keys(owner, extension)[0]]
    assert (frames[0], frames[-1]) == (FIRST, LAST)
    shown = set()
    for frame in (FIRST, 9, LAST):
        scene.frame_set(frame)
        shown.add(content(owner))
    assert len(shown) == 3
    scene.frame_set(9)
    assert content(owner) in shown


def test_ends_of_the_morph_are_the_shapes(image, scene, extension):
    bpy.ops.ifs_morph.morph()
    morph = morph_of(image, extension)
    for u, name in ((0, "gasket"), (1, "square")):
        np.testing.assert_allclose(morph.at(u, u).bounds, SHAPES[name].bounds, atol=1e-3)


def test_report_says_what_was_done(image, extension):
    bpy.ops.ifs_morph.morph()
    report = image.ifs_morph.path.report
    assert "of 3 initial maps" in report
    assert "4 final maps" in report
    assert f"{LAST - FIRST + 1} frames, all in one piece" in report
    for line in report.splitlines():
        assert line in sidebar(image, extension)
    assert "out of date" not in sidebar(image, extension)
    # The steps that come after can be taken one by one.
    assert bpy.ops.ifs_morph.plan_path() == {"FINISHED"}
    assert bpy.ops.ifs_morph.compute_locus() == {"FINISHED"}


def test_what_is_stored_makes_the_same_morph(scene, extension):
    # Its pairs make use of symmetries, whose entries single precision cannot hold.
    owner = pair("terdragon", "pentigasket")
    initial, final = (
        extension.ifs_morph_addon.conversion.shape_ifs(shape)
        for shape in (owner.ifs_morph.initial, owner.ifs_morph.final)
    )
    match = extension.core.matching.match(initial, final, LAST - FIRST + 1)
    assert any(each.final_symmetry != IDENTITY for each in match.pairs)
    bpy.ops.ifs_morph.morph()
    morph = morph_of(owner, extension)
    assert morph.at(0.3, 0.6).maps.tobytes() == match.morph.at(0.3, 0.6).maps.tobytes()
    output = owner.ifs_morph.output
    pixel = (output.window[2] - output.window[0]) / output.resolution[0]
    assert owner.ifs_morph.path.report == match.report.text(pixel)
    assert " pixels" in owner.ifs_morph.path.report


def test_pairs_are_saved_and_loaded(owner, scene, extension, tmp_path):
    bpy.ops.ifs_morph.morph()
    scene.frame_set(9)
    before, shown, name = state(owner, extension), content(owner), owner.name
    file = str(tmp_path / "matched.blend")
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.open_mainfile(filepath=file)
    owner = bpy.data.objects[name]
    assert state(owner, extension) == before
    assert content(owner) == shown
    assert "out of date" not in sidebar(owner, extension)


def test_morph_is_one_step_of_undo(image, extension):
    name = image.name
    bpy.ops.ed.undo_push(message="before")
    before = state(image, extension)
    bpy.ops.ifs_morph.morph()
    bpy.ops.ed.undo_push(message="Morph")
    after = state(bpy.data.objects[name], extension)
    assert after != before
    bpy.ops.ed.undo()
    assert state(bpy.data.objects[name], extension) == before
    bpy.ops.ed.redo()
    assert state(bpy.data.objects[name], extension) == after


def test_copies_have_pairs_of_their_own(image, extension):
    bpy.ops.ifs_morph.morph()
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    assert listed(copy) == listed(image)
    bpy.ops.ifs_morph.clear_pairs()
    assert listed(copy) == []
    assert listed(image)


def test_without_pairs_nothing_is_otherwise_than_before(scene, extension):
    owner = pair("turned gasket", "gasket")
    conversion = extension.ifs_morph_addon.conversion
    before = conversion.fingerprint(owner.ifs_morph)
    set_pairs(owner, ("1", "1"), ("2", "2"), ("3", "3"))
    paired = conversion.fingerprint(owner.ifs_morph)
    plain = Morph(SHAPES["turned gasket"], SHAPES["gasket"]).at(0.3, 0.4)
    np.testing.assert_allclose(morph_of(owner, extension).at(0.3, 0.4).maps, plain.maps, atol=1e-6)
    bpy.ops.ifs_morph.clear_pairs()
    assert conversion.fingerprint(owner.ifs_morph) == before != paired
    assert morph_of(owner, extension).count == 3


@pytest.mark.parametrize("change", ["winding", "final", "final_symmetry"])
def test_report_is_out_of_date_when_a_pair_changes(image, extension, change):
    bpy.ops.ifs_morph.morph()
    conversion = extension.ifs_morph_addon.conversion
    before = conversion.locus_fingerprint(image.ifs_morph)
    item = image.ifs_morph.matching.pairs[0]
    value = {"winding": 2, "final": "7", "final_symmetry": ((0, -1, 1), (1, 0, 0))}[change]
    setattr(item, change, value)
    assert conversion.locus_fingerprint(image.ifs_morph) != before
    assert "report is out of date" in sidebar(image, extension)
    item.locked = True


def test_locks_leave_results_current(image, extension):
    bpy.ops.ifs_morph.morph()
    bpy.ops.ifs_morph.pairs_lock(action="LOCK")
    assert all(item.locked for item in image.ifs_morph.matching.pairs)
    assert "out of date" not in sidebar(image, extension)
    bpy.ops.ifs_morph.pairs_lock(action="UNLOCK")
    assert not any(item.locked for item in image.ifs_morph.matching.pairs)


def test_locked_pairs_stay(image, extension):
    bpy.ops.ifs_morph.morph()
    bpy.ops.ifs_morph.pair_swap(direction="DOWN")
    item = image.ifs_morph.matching.pairs[1]
    item.winding = 1
    item.locked = True
    locked = listed(image)[1]
    bpy.ops.ifs_morph.morph()
    assert locked in listed(image)
    assert [each for each in listed(image) if each[-1]] == [locked]
    assert reaches_every_map(image)
    assert f"{LAST - FIRST + 1} frames" in image.ifs_morph.path.report


def reaches_every_map(owner):
    pairs = owner.ifs_morph.matching.pairs
    return {item.initial for item in pairs} == set("123") and {item.final for item in pairs} == set("1234")


def test_locked_pairs_that_do_not_fit_are_said(image, extension):
    bpy.ops.ifs_morph.morph()
    bpy.ops.ifs_morph.pairs_lock(action="LOCK")
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape="gasket")
    before = state(image, extension)
    with pytest.raises(RuntimeError, match=r"Locked pairs do not fit .* Pair \d names a map"):
        bpy.ops.ifs_morph.morph()
    assert state(image, extension) == before


def test_pairs_alone_leave_the_keys(image, extension):
    bpy.ops.ifs_morph.morph()
    matched, keyed = listed(image), keys(image, extension)
    bpy.ops.ifs_morph.clear_pairs()
    assert bpy.ops.ifs_morph.match_pairs() == {"FINISHED"}
    assert listed(image) == matched
    assert keys(image, extension) == keyed


@pytest.mark.parametrize("operator", ["MORPH", "MATCH_PAIRS"])
def test_nothing_changes_when_the_search_is_cancelled(image, extension, operator):
    before = state(image, extension)
    matching = extension.ifs_morph_addon.operators.matching
    cls = getattr(matching, f"IFSMORPH_OT_{operator.lower()}")
    steps = 0
    while state(image, extension) == before:
        steps += 1
        work = cls.work(Pressed(cls), bpy.context)
        shares = [share for _, share in zip(range(steps), work, strict=False)]
        assert all(0 <= share <= 1 for share in shares)
        work.close()
        # It is changed by the last step alone.
        assert (state(image, extension) == before) == (len(shares) == steps)
    assert steps > 1


class Pressed:
    """Stands in for an operator that Blender made when its button was pressed."""

    def __init__(self, cls):
        self._cls = cls
        self.best = None
        self.said = []

    def __getattr__(self, name):
        value = self._cls.__dict__.get(name) or getattr(self._cls.__mro__[1], name)
        return value.__get__(self)

    def report(self, kind, text):
        self.said.append(text)

    def cancel(self, context):
        pass


def test_escape_keeps_the_best_so_far(scene, extension):
    owner = pair("Koch curve", "gasket")
    cls = extension.ifs_morph_addon.operators.matching.IFSMORPH_OT_morph
    operator = Pressed(cls)
    before = state(owner, extension)
    work = cls.work(operator, bpy.context)
    # The first answer may be in pieces; the next one swells instead.
    while operator.best is None or operator.best.report.disconnected:
        next(work)
    work.close()
    assert state(owner, extension) == before
    assert "Keep the best so far" in operator.on_escape
    assert operator.interrupt(bpy.context) == {"FINISHED"}
    assert len(keys(owner, extension)[0]) >= 2
    assert listed(owner)
    places = sampled(owner, extension)
    assert connectedness(morph_of(owner, extension).at(*places[len(places) // 2])).state == Connectedness.CONNECTED
    first = owner.ifs_morph.path.report
    bpy.ops.ifs_morph.morph()
    assert owner.ifs_morph.path.report != first


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


def test_morph_needs_frames_and_curves(image, extension):
    image.ifs_morph.path.frame_end = FIRST
    assert "must end after" in reason(bpy.ops.ifs_morph.morph)
    assert bpy.ops.ifs_morph.match_pairs.poll()
    image.ifs_morph.path.frame_end = LAST
    image.driver_add("ifs_morph.swell")
    assert "driver" in reason(bpy.ops.ifs_morph.morph)


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
