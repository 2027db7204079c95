"""Any shape into any shape in Blender: the Morph button, and the pairs it leaves on the object."""

import bpy
import numpy as np
import pytest

from core.connectedness import Connectedness, connectedness
from core.morph import Morph
from core.report import check_frames
from core.shapes import SHAPES
from tests.addon.interface import keys, reason, sidebar
from tests.addon.pairing import FIRST, IDENTITY, LAST, listed, morph_of, pair, set_pairs, state
from tests.addon.support import content


@pytest.fixture(params=["IMAGE", "POINTS"])
def owner(request, scene):
    """Three maps that are to become four."""
    return pair("gasket", "square", request.param)


@pytest.fixture
def image(scene):
    return pair("gasket", "square")


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
        self.best, self.locked = None, 0
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


def test_morph_needs_frames_and_curves(image, extension):
    image.ifs_morph.path.frame_end = FIRST
    assert "must end after" in reason(bpy.ops.ifs_morph.morph)
    assert bpy.ops.ifs_morph.match_pairs.poll()
    image.ifs_morph.path.frame_end = LAST
    image.driver_add("ifs_morph.swell")
    assert "driver" in reason(bpy.ops.ifs_morph.morph)
