"""The match: any shape into any shape in one piece, no worse than the naive way, and what is locked stays."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.connectedness import Connectedness, connectedness
from core.ifs import IFS, IFSError
from core.matching import Pair, match, match_steps, morph_of_pairs
from core.matching.problem import End, Problem
from core.matching.search import good, search_steps
from core.matching.symmetry import symmetries
from core.morph import Morph
from core.parallel import Cancelled, finish
from core.path import plan_path
from core.shapes import SHAPES
from tests.core.reference import in_pieces

MATCHES = {}
PAIRS = [
    ("terdragon", "gasket"),
    ("turned gasket", "gasket"),
    ("pentigasket", "Koch curve"),
    ("Hata tree", "Heighway dragon"),
    ("Barnsley fern", "gasket"),
    ("maple leaf", "Barnsley fern"),
]
every_pair = pytest.mark.parametrize("names", PAIRS, ids=" to ".join)


def match_of(names):
    if names not in MATCHES:
        MATCHES[names] = match(*(SHAPES[name] for name in names))
    return MATCHES[names]


@every_pair
def test_no_frame_is_in_pieces(names):
    found = match_of(names)
    assert found.report.disconnected == 0
    for t in np.linspace(0, 1, 240)[::12]:
        assert not in_pieces(found.morph.at(*found.path.at(t)).maps, 1 / 300)


@every_pair
def test_it_is_no_worse_than_the_straight_line_with_least_swell(names):
    found = match_of(names)
    initial, final = (SHAPES[name] for name in names)
    count = max(initial.count, final.count)
    ends = [IFS([ifs.maps[k % ifs.count] for k in range(count)]) for ifs in (initial, final)]
    straight = plan_path(Morph(*ends), method="straight").report.path
    assert found.report.most_swell <= straight.most_swell
    assert found.report.mean_swell <= straight.mean_swell
    assert found.report.straight_swell == (straight.most_swell, straight.mean_swell)


@every_pair
def test_the_report_says_what_was_done(names):
    found = match_of(names)
    text = found.report.text()
    assert text.startswith(f"{len(found.pairs)} pairs of {SHAPES[names[0]].count} initial maps")
    assert "all in one piece" in text
    assert "element by element" in text
    counts = [SHAPES[name].count for name in names]
    naive = [Pair((k % counts[0],), (k % counts[1],)) for k in range(max(counts))]
    flips = len(morph_of_pairs(*(SHAPES[name] for name in names), naive).flips)
    assert found.report.naive_flips == flips
    assert ("flipped" in text) == (flips > 0)


@every_pair
def test_the_pairs_make_the_morph_again(names):
    found = match_of(names)
    again = morph_of_pairs(*(SHAPES[name] for name in names), found.pairs)
    for u in (0, 0.4, 1):
        assert np.array_equal(again.at(u, u).maps, found.morph.at(u, u).maps)


def test_terdragon_to_gasket_is_found_to_hold_at_all_of_2001_samples():
    found = match_of(("terdragon", "gasket"))
    assert len(found.pairs) == 3
    for t in np.linspace(0, 1, 2001):
        assert connectedness(found.morph.at(t, t)).state == Connectedness.CONNECTED


def test_what_is_known_of_terdragon_and_gasket():
    """The permutation (0, 2, 1) through the gasket's turns by 0, 120 and 240 degrees."""
    turns = symmetries(SHAPES["gasket"])[:3]
    pairs = [
        Pair((k,), (final,), final_symmetry=tuple(map(tuple, turns[turn].tolist())))
        for k, (final, turn) in enumerate([(0, 0), (2, 1), (1, 2)])
    ]
    morph = morph_of_pairs(SHAPES["terdragon"], SHAPES["gasket"], pairs)
    assert all(connectedness(morph.at(t, t)).state == Connectedness.CONNECTED for t in np.linspace(0, 1, 2001))


def test_maps_that_all_reflect_are_split_rather_than_flipped():
    assert match_of(("Hata tree", "Heighway dragon")).report.flips == ()


def test_a_mirror_symmetry_saves_a_map_from_flipping():
    assert match_of(("Barnsley fern", "gasket")).report.flips == ()


def test_it_is_the_same_again_with_any_number_of_threads():
    first, *others = (
        match(SHAPES["Koch curve"], SHAPES["gasket"], 24, budget=4000, threads=threads) for threads in (2, 1, 3)
    )
    assert len(first.path.keys.time) > 2, "a path was planned"
    for again in others:
        assert again.pairs == first.pairs
        assert np.array_equal(again.path.keys.value, first.path.keys.value)
        assert again.report.text() == first.report.text()


def test_the_way_back_has_the_same_pairs():
    forth, back = match_of(("terdragon", "gasket")), match(SHAPES["gasket"], SHAPES["terdragon"])
    assert {(pair.initial, pair.final) for pair in forth.pairs} == {(pair.final, pair.initial) for pair in back.pairs}
    for t in (0, 0.3, 1):
        assert np.allclose(forth.morph.at(t, t).maps, back.morph.at(1 - t, 1 - t).maps, atol=1e-9)


@pytest.mark.parametrize("final", [(0, 1, 2), (2, 1, 0)])
def test_where_all_pairs_are_locked_no_other_is_added(final):
    locked = tuple(Pair((k,), (word,)) for k, word in enumerate(final))
    assert match(SHAPES["terdragon"], SHAPES["gasket"], frames=24, locked=locked, budget=5000).pairs == locked


def test_a_locked_map_is_in_no_other_pair():
    locked = (Pair((0,), (0,), winding=2),)
    found = match(SHAPES["terdragon"], SHAPES["pentigasket"], frames=24, locked=locked, budget=20_000)
    assert found.pairs[0] == locked[0]
    assert len(found.pairs) > 3
    assert all((0,) not in (pair.initial, pair.final) for pair in found.pairs[1:])


def test_locked_pairs_stay():
    mirrored = tuple(map(tuple, symmetries(SHAPES["gasket"])[1].tolist()))
    locked = (Pair((0,), (2,), None, mirrored, 1), Pair((1,), (2,), None, None, None))
    found = match(SHAPES["terdragon"], SHAPES["gasket"], frames=24, locked=locked, budget=20_000)
    assert found.pairs[0] == replace(locked[0], initial_symmetry=found.pairs[0].initial_symmetry)
    assert (found.pairs[1].initial, found.pairs[1].final) == ((1,), (2,))


def test_all_of_a_match_can_be_locked():
    found = match_of(("turned gasket", "gasket"))
    again = match(SHAPES["turned gasket"], SHAPES["gasket"], locked=found.pairs, budget=10_000)
    assert again.pairs == found.pairs


def test_pairs_that_no_common_path_joins_get_paths_of_their_own():
    """Map k to map k, the terdragon swells by a quarter on its way to the gasket, wherever (u,v) goes.

    With next to no budget no other pairs are found that would mend it.
    """
    locked = tuple(Pair((k,), (k,)) for k in range(3))
    found = match(SHAPES["terdragon"], SHAPES["gasket"], frames=120, locked=locked, budget=100)
    assert found.pairs == locked
    assert found.path.offset_keys is not None
    assert found.report.disconnected == 0
    assert found.report.most_swell < 0.05
    for t in np.linspace(0, 1, 120)[::12]:
        assert not in_pieces(found.morph.at(*found.path.at(t)).maps, 1 / 300)


def test_an_open_scheme_is_no_worse_than_one_that_is_chosen():
    locked = tuple(Pair((k,), (k,)) for k in range(3))
    ends = SHAPES["gasket relative"], SHAPES["turned gasket"]
    chosen = {scheme: match(*ends, frames=24, locked=locked, scheme=scheme) for scheme in ("polar", "log-polar")}
    assert [each.morph.scheme for each in chosen.values()] == ["polar", "log-polar"]
    found = match(*ends, frames=24, locked=locked)
    best = min(chosen.values(), key=lambda each: (each.report.disconnected, each.cost))
    assert (found.report.disconnected, found.cost) <= (best.report.disconnected, best.cost)
    assert found.morph.scheme == best.morph.scheme


def test_a_locked_piece_splits_its_map():
    locked = [Pair((1, 0), (2,))]
    found = match(SHAPES["spiral"], SHAPES["gasket"], frames=24, locked=locked, budget=20_000)
    assert found.pairs[0] == locked[0]
    assert {pair.initial for pair in found.pairs} == {(0,), (1, 0), (1, 1)}


def test_splits_can_be_settled():
    words = [(0,), (1, 0), (1, 1)]
    found = match(SHAPES["spiral"], SHAPES["Lévy curve"], frames=24, initial_words=words, budget=20_000)
    assert {pair.initial for pair in found.pairs} == set(words)


@pytest.mark.parametrize(
    ("constraint", "message"),
    [
        ({"locked": [Pair((7,), (0,))]}, "does not have"),
        ({"locked": [Pair((0,), (0,)), Pair((0, 1), (0,))]}, "split further"),
        ({"locked": [Pair((0,), (0,), ((0, 1, 0), (1, 0, 0)))]}, "no symmetry"),
        ({"final_words": [(0,), (1, 1)]}, "every piece"),
        ({"final_words": [(0,), (0,), (1,), (2,)]}, "each once"),
    ],
)
def test_what_cannot_be_kept_is_said(constraint, message):
    with pytest.raises(IFSError, match=message):
        match(SHAPES["terdragon"], SHAPES["gasket"], frames=12, **constraint)


def test_the_best_so_far_is_shown_and_never_gets_worse():
    shown = []
    last = match(SHAPES["hexagasket"], SHAPES["Koch curve"], frames=60, found=shown.append)
    costs = [(each.report.disconnected, each.cost) for each in shown]
    assert costs == sorted(costs, reverse=True)
    assert shown[-1] is last
    assert len(shown) > 1


@pytest.mark.parametrize("locked", [(), (Pair((1,), (0,)),)])
def test_the_first_answer_is_what_was_given_and_waits_for_nothing(locked):
    shown = []
    last = match(SHAPES["terdragon"], SHAPES["gasket"], frames=24, locked=locked, budget=1000, found=shown.append)
    first = shown[0]
    assert (first.report.element_wise, first.report.straight_swell) == (None, None)
    assert first.path.report.method == "straight unswollen"
    assert first.pairs[: len(locked)] == locked
    assert len(first.report.text().splitlines()) < len(last.report.text().splitlines())
    assert last.report.element_wise is not None
    assert last.report.straight_swell is not None


@pytest.mark.parametrize("final", ["Cantor dust", "gasket"])
def test_dust_does_not_leap(final):
    found = match(SHAPES["Cantor dust"], SHAPES[final], frames=60, budget=20_000)
    assert found.report.broken == 0
    assert np.abs(np.diff(found.report.path.path.uv_swell[:, 2])).max() < 0.1


def test_a_shape_becomes_itself_without_ado():
    shown = []
    found = match(SHAPES["gasket"], SHAPES["gasket"], frames=24, found=shown.append)
    assert len(shown) == 1
    assert found.report.element_wise is not None
    assert found.report.straight_swell == (0, 0)
    assert found.report.spotless


def test_a_budget_of_next_to_nothing_gives_something():
    found = match(SHAPES["gasket"], SHAPES["pentigasket"], frames=12, budget=1)
    assert len(found.pairs) >= 5
    with pytest.raises(ValueError, match="must be 1 or more"):
        match(SHAPES["gasket"], SHAPES["pentigasket"], budget=0)


def test_flips_are_named_by_the_maps_that_flip():
    mirrored = SHAPES["gasket"].maps.copy()
    mirrored[1, 0, :2] *= -1
    locked = (Pair((0,), (0,)), Pair((2,), (1,)), Pair((1,), (2,)))
    found = match(SHAPES["terdragon"], IFS(mirrored), frames=12, locked=locked, budget=100)
    assert found.report.flips == (1,)
    assert "since only one end reflects: 3 to 2." in found.report.text()


def test_it_can_be_stopped():
    with pytest.raises(Cancelled):
        match(SHAPES["gasket"], SHAPES["square"], progress=lambda share: share < 0.05)


def test_steps_are_shares():
    shares = []
    finish(match_steps(SHAPES["gasket"], SHAPES["terdragon"], 24), shares.append)
    assert all(0 <= share <= 1 for share in shares)
    assert shares == sorted(shares)


def test_a_search_ends_at_a_good_candidate():
    ends = [End(ifs, symmetries(ifs), [(0,), (1,), (2,)]) for ifs in (SHAPES["terdragon"], SHAPES["gasket"])]
    best = finish(search_steps(Problem(*ends, 1 / 300), 100_000))[0]
    assert good(best)


@pytest.mark.parametrize("frames", [2, 3])
def test_few_frames_are_enough(frames):
    assert match(SHAPES["gasket"], SHAPES["Lévy curve"], frames).report.disconnected == 0


@pytest.mark.parametrize(("frames", "tolerance"), [(1, 1 / 300), (24, 0.0), (24, -1.0)])
def test_numbers_that_cannot_be_used_are_said(frames, tolerance):
    with pytest.raises(ValueError, match=r"frames|tolerance"):
        match(SHAPES["gasket"], SHAPES["square"], frames, tolerance)


def shape_by_chance(random, count):
    """A connected shape or not, with maps that reflect, shear, are flat, or lie on one another."""
    linear = random.normal(size=(count, 2, 2))
    linear *= (random.uniform(0.2, 0.8, count) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    linear[random.random(count) < 0.15, 1] = 0
    return IFS(np.concatenate([linear, random.uniform(-1, 1, (count, 2, 1))], axis=-1))


@settings(max_examples=5)
@given(st.integers(1, 4), st.integers(1, 12), st.integers(0, 10**6))
def test_any_two_shapes_have_an_answer(one, other, seed):
    random = np.random.default_rng(seed)
    initial, final = shape_by_chance(random, one), shape_by_chance(random, other)
    found = match(initial, final, frames=6, budget=1000)
    assert found.path.at(0) == (0, 0, 0)
    assert found.path.at(1) == (1, 1, 0)
    assert found.report.text()


def test_shapes_that_are_points_have_an_answer():
    point, pair = IFS([[[0, 0, 1], [0, 0, 1]]]), IFS([[[0.5, 0, 1], [0, 0.5, 1]]] * 2)
    assert match(point, pair, frames=12).report.disconnected == 0
