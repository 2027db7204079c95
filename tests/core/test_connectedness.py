"""Is it in one piece? Closed forms, certificates, brute force on points, and the paper's two algorithms beside it."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.connectedness import Connectedness, connectedness, index_buffer, object_based
from core.ifs import IFS, Contractivity
from core.morph import Morph
from core.shapes import SHAPES
from tests.core.reference import chaos_game, dense, largest_spectral_radius, linkage

CONNECTED, DISCONNECTED, UNDECIDED, NO_ATTRACTOR = Connectedness

seeds = st.integers(0, 2**32 - 1)
resolutions = pytest.mark.parametrize("resolution", [75, 150, 300, 600])


def gasket(scale):
    """The Sierpinski family of the paper's Table 1: connected from the scale 1/2 on."""
    corners = np.array([[0, 0], [1, 0], [0.5, 0.75**0.5]])
    return IFS([[[scale, 0, (1 - scale) * x], [0, scale, (1 - scale) * y]] for x, y in corners])


def cantor(scale, count=2):
    """Evenly spaced parts of the unit interval, connected from the scale 1/count on; first and last touch its ends."""
    places = np.linspace(0, 1 - scale, count)
    return IFS([[[scale, 0, x], [0, scale, 0]] for x in places])


def squares(scale, gap):
    """Two by two parts, from the unit square at scale 1/2 and gap 0."""
    places = (0, scale + gap)
    return IFS([[[scale, 0, x], [0, scale, y]] for x in places for y in places])


def threshold(family, low, high, tolerance):
    """The least parameter called connected, by bisection."""
    for _ in range(60):
        middle = (low + high) / 2
        if connectedness(family(middle), tolerance).state == CONNECTED:
            high = middle
        else:
            low = middle
    return high


# --- closed forms


@resolutions
def test_table_1(resolution):
    assert abs(threshold(gasket, 0.4, 0.6, 1 / resolution) - 0.5) <= 1 / (2 * resolution)


def test_table_1_at_a_fine_tolerance():
    assert abs(threshold(gasket, 0.4, 0.6, 1e-9) - 0.5) <= 1e-9


@resolutions
@pytest.mark.parametrize("count", [2, 3, 5])
def test_cantor_sets_on_a_line(resolution, count):
    found = threshold(lambda scale: cantor(scale, count), 0.05, 0.9, 1 / resolution)
    assert abs(found - 1 / count) <= 1 / (2 * resolution)


@pytest.mark.parametrize("count", [2, 3, 5])
def test_cantor_sets_at_a_fine_tolerance(count):
    assert threshold(lambda scale: cantor(scale, count), 0.05, 0.9, 1e-9) == pytest.approx(1 / count, abs=1e-9)


@given(st.floats(0.1, 0.49), st.sampled_from([2, 3, 4]))
def test_the_gap_of_cantor_sets(scale, count):
    scale *= 2 / count
    ifs = cantor(scale, count)
    verdict = connectedness(ifs)
    diameter = 2 * ifs.enclosing_disc[1]
    gap = (1 - count * scale) / (count - 1) / diameter
    assert verdict.gap[0] <= gap * (1 + 1e-9) <= verdict.gap[1] * (1 + 2e-9)
    if gap > 1 / 300:
        assert verdict.state == DISCONNECTED
        assert verdict.gap[1] - verdict.gap[0] <= 0.15 * gap + 1 / 300
        assert verdict.components.tolist() == list(range(count))


@given(st.floats(0.15, 0.46), st.floats(0.001, 1))
def test_the_gap_of_two_by_two_squares(scale, gap):
    ifs = squares(scale, gap)
    verdict = connectedness(ifs, 1e-5)
    # The attractor's hull is a square of this side, and its parts' hulls of scale times that.
    side = (scale + gap) / (1 - scale)
    between = scale + gap - scale * side
    assume(between > 1e-3)
    diameter = 2 * ifs.enclosing_disc[1]
    assert verdict.state == DISCONNECTED
    assert verdict.gap[0] <= between / diameter * (1 + 1e-9)
    assert verdict.gap[1] >= between / diameter * (1 - 1e-9)
    assert verdict.gap[1] - verdict.gap[0] <= 0.35 * between / diameter


@pytest.mark.parametrize("tolerance", [1 / 75, 1 / 300, 1e-4, 1e-9])
@pytest.mark.parametrize("name", ["gasket", "turned gasket", "square", "Koch curve", "terdragon", "hexagasket"])
def test_connected_shapes_are_connected_at_every_tolerance(name, tolerance):
    verdict = connectedness(SHAPES[name], tolerance)
    assert verdict.state == CONNECTED
    assert verdict.gap[0] == 0
    assert verdict.gap[1] <= tolerance
    assert not verdict.components.any()


def test_two_pairs_with_a_gap_between_them():
    """Figure 1's blind spot: none of the four attractorlets is alone, but {1, 2} and {3, 4} are apart."""
    places = (0, 0.2, 0.7, 0.9)
    ifs = IFS([[[0.25, 0, x * 0.75 / 0.9], [0, 0.25, 0]] for x in places])
    points, letters, spacing = dense(ifs.maps)
    assert linkage(points, letters, 4) > 2 * spacing
    assert object_based(ifs).state == CONNECTED
    verdict = connectedness(ifs)
    assert verdict.state == DISCONNECTED
    assert verdict.components.tolist() == [0, 0, 2, 2]
    assert index_buffer(ifs, 150).state == DISCONNECTED
    assert index_buffer(ifs, 150).components.tolist() == [0, 0, 2, 2]


def test_one_map_is_a_point_and_connected():
    verdict = connectedness(IFS([[[0.3, 0.1, 5], [0, 0.4, 1]]]))
    assert verdict.state == CONNECTED
    assert verdict.gap == (0, 0)


@given(seeds)
@settings(max_examples=40)
def test_maps_with_one_fixed_point_are_a_point_and_connected(seed):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(3, 2, 2)) * 0.2
    point = random.uniform(-3, 3, 2)
    ifs = IFS(np.concatenate([linear, (point - linear @ point)[..., None]], axis=-1))
    assume(ifs.contractivity == Contractivity.CONTRACTIVE)
    assert connectedness(ifs).state == CONNECTED


@given(seeds, st.floats(-50, 50), st.floats(-np.pi, np.pi), st.floats(0.01, 100))
@settings(max_examples=40)
def test_it_does_not_matter_where_the_shape_lies_or_how_it_is_turned(seed, shift, angle, size):
    random = np.random.default_rng(seed)
    ifs = IFS(random.normal(size=(3, 2, 3)) * 0.35)
    assume(ifs.contractivity == Contractivity.CONTRACTIVE)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    linear = turn @ ifs.linear @ turn.T
    offset = np.array([shift, -shift / 2])
    translation = size * ifs.translation @ turn.T + offset - linear @ offset
    moved = connectedness(IFS(np.concatenate([linear, translation[..., None]], axis=-1)), 1e-4)
    here = connectedness(ifs, 1e-4)
    assume(UNDECIDED not in (here.state, moved.state))
    # A gap below the tolerance may be seen from one side and not from the other.
    assert here.state == moved.state or max(here.gap[0], moved.gap[0]) < 1e-4
    assert moved.gap[0] <= here.gap[1] * (1 + 1e-6) + 1e-4
    assert here.gap[0] <= moved.gap[1] * (1 + 1e-6) + 1e-4


@given(seeds, st.permutations(range(4)))
@settings(max_examples=40)
def test_the_order_of_the_maps_does_not_matter(seed, order):
    ifs = Morph(SHAPES["Barnsley fern"], SHAPES["maple leaf"]).at(*np.random.default_rng(seed).uniform(-0.5, 1.5, 2))
    one, other = connectedness(ifs), connectedness(IFS(ifs.maps[order]))
    assert {one.state, other.state} != {CONNECTED, DISCONNECTED} or max(one.gap[0], other.gap[0]) < 1 / 300
    if one.state == other.state == DISCONNECTED:
        assert one.gap[0] <= other.gap[1] * (1 + 1e-9)
        assert other.gap[0] <= one.gap[1] * (1 + 1e-9)


# --- the area certificate


@given(seeds, st.integers(2, 5))
@settings(max_examples=60)
def test_maps_that_cover_half_the_area_each_are_connected(seed, count):
    random = np.random.default_rng(seed)
    left, right = random.uniform(-np.pi, np.pi, (2, count))
    large = random.uniform(0.75, 0.95, count)
    values = np.stack([large, random.choice([-1, 1], count) * 0.5 * (1 + 1e-9) / large], axis=-1)
    turns = [np.stack([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]).transpose(2, 0, 1) for a in (left, right)]
    linear = turns[0] @ (values[:, :, None] * turns[1])
    ifs = IFS(np.concatenate([linear, random.normal(size=(count, 2, 1)) * 3], axis=-1))
    verdict = connectedness(ifs, 1e-9)
    if ifs.contractivity == Contractivity.CONTRACTIVE:
        assert verdict.state == CONNECTED
        # And brute force does not refute it: random points hang together at their own spacing.
        points = chaos_game(ifs, 3000, seed % 1000)
        halves = points[:, 0] > np.median(points[:, 0])
        gap = linkage(points, halves.astype(int), 2)
        assert gap <= 0.1 * 2 * ifs.enclosing_disc[1]


# --- brute force

PAIRS = {
    "turned gasket to gasket": Morph(SHAPES["turned gasket"], SHAPES["gasket"]),
    "terdragon to gasket": Morph(SHAPES["terdragon"], SHAPES["gasket"]),
    "terdragon to gasket (0, 2, 1)": Morph(SHAPES["terdragon"], IFS(SHAPES["gasket"].maps[[0, 2, 1]])),
    "fern to leaf": Morph(SHAPES["Barnsley fern"], SHAPES["maple leaf"]),
    "fern to square": Morph(SHAPES["Barnsley fern"], SHAPES["square"]),
}


@pytest.mark.parametrize("tolerance", [1 / 300, 1 / 30])
@pytest.mark.parametrize("name", PAIRS)
def test_brute_force_refutes_no_verdict(name, tolerance):
    random = np.random.default_rng(17)
    seen, sure = set(), 0
    for u, v in random.uniform(-1, 2, (60, 2)):
        ifs = PAIRS[name].at(u, v)
        verdict = connectedness(ifs, tolerance)
        seen.add(verdict.state)
        if verdict.state == NO_ATTRACTOR:
            assert largest_spectral_radius(ifs.linear, 7) >= 1 - 1e-9
            assert np.isnan(verdict.gap).all()
            continue
        if ifs.contractivity != Contractivity.CONTRACTIVE:
            assert verdict.state == UNDECIDED
            continue
        assert largest_spectral_radius(ifs.linear, 5) < 1
        points, letters, spacing = dense(ifs.maps, 4000)
        gap = linkage(points, letters, ifs.count)
        diameter = 2 * ifs.enclosing_disc[1]
        low, high = (bound * diameter for bound in verdict.gap)
        # The points lie on the attractor, so its gap is at most theirs, and at most two spacings less.
        assert low <= gap * (1 + 1e-9) + 1e-12 * diameter, (u, v)
        assert gap - 2 * spacing <= high * (1 + 1e-9), (u, v)
        assert (low > 0) == (verdict.state == DISCONNECTED)
        if verdict.state == CONNECTED:
            assert gap - 2 * spacing <= tolerance * diameter, (u, v)
        if verdict.state == DISCONNECTED:
            assert gap > 0
            sure += gap > 2 * spacing
            # Components that are said to hang together do.
            for label in np.unique(verdict.components):
                inside = np.flatnonzero(verdict.components == label)
                held = np.isin(letters, inside)
                numbers = np.searchsorted(inside, letters[held])
                assert linkage(points[held], numbers, len(inside)) - 2 * spacing <= tolerance * diameter
    assert {CONNECTED, DISCONNECTED} <= seen
    # Not only is none refuted: brute force is fine enough to confirm many.
    assert sure >= 3


def test_brute_force_on_random_maps():
    random = np.random.default_rng(3)
    seen = []
    for _ in range(150):
        linear = random.normal(size=(3, 2, 2))
        linear *= (random.uniform(0.4, 0.9, 3) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
        ifs = IFS(np.concatenate([linear, random.normal(size=(3, 2, 1))], axis=-1))
        verdict = connectedness(ifs)
        points, letters, spacing = dense(ifs.maps, 2000)
        gap, diameter = linkage(points, letters, 3), 2 * ifs.enclosing_disc[1]
        seen.append(verdict.state)
        assert verdict.gap[0] * diameter <= gap * (1 + 1e-9) + 1e-12
        assert gap - 2 * spacing <= verdict.gap[1] * diameter * (1 + 1e-9)
        if verdict.state == CONNECTED:
            assert gap - 2 * spacing <= diameter / 300
    assert seen.count(CONNECTED) > 20
    assert seen.count(DISCONNECTED) > 20
    assert seen.count(UNDECIDED) <= 5


@given(seeds, st.floats(0.8, 1.3))
@settings(max_examples=60)
def test_no_attractor_by_the_spectral_radii_of_words(seed, size):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(2, 2, 2))
    linear *= (size * random.uniform(0.8, 1.2, 2) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    ifs = IFS(np.concatenate([linear, random.normal(size=(2, 2, 1))], axis=-1))
    verdict = connectedness(ifs)
    radius = largest_spectral_radius(linear, 9)
    if radius >= 1 + 1e-9:
        assert verdict.state in (NO_ATTRACTOR, UNDECIDED)
    if verdict.state == NO_ATTRACTOR:
        assert np.isnan(verdict.gap).all()
        assert verdict.components.tolist() == [0, 1]
        assert index_buffer(ifs).state == object_based(ifs).state == NO_ATTRACTOR
        assert np.isnan(index_buffer(ifs).gap).all()


# --- the paper's algorithms


@pytest.mark.parametrize("resolution", [75, 150])
def test_the_index_buffer_finds_the_scale_of_the_gasket(resolution):
    """Table 1 with several phases: within a pixel and a half of 1/2, on the side that the paper found it."""
    phases = tuple((a, b) for a in (0, 0.5) for b in (0, 0.5))
    scales = np.arange(0.46, 0.52, 0.0025)
    found = [index_buffer(gasket(scale), resolution, phases=phases).state == CONNECTED for scale in scales]
    assert abs(scales[np.argmax(found)] - 0.5) <= 1.5 / resolution + 0.0025
    assert all(found[np.argmax(found) :])


@pytest.mark.parametrize("name", ["turned gasket to gasket", "terdragon to gasket (0, 2, 1)", "fern to leaf"])
def test_early_exit_of_the_index_buffer_changes_nothing(name):
    random = np.random.default_rng(5)
    seen = set()
    for u, v in random.uniform(-0.2, 1.2, (12, 2)):
        ifs = PAIRS[name].at(u, v)
        verdicts = [index_buffer(ifs, 60, early_exit=early) for early in (True, False)]
        assert verdicts[0].state == verdicts[1].state
        assert np.array_equal(verdicts[0].components, verdicts[1].components)
        seen.add(verdicts[0].state)
    assert len(seen) == 2


@pytest.mark.parametrize("seed", [0, 1, 2, 12345, 2**31])
@pytest.mark.parametrize("name", ["Lévy curve", "maple leaf", "Heighway dragon"])
def test_any_seed_draws_all_maps_and_gives_the_same_verdict_twice(name, seed):
    one, other = (index_buffer(SHAPES[name], 100, seed=seed) for _ in range(2))
    assert one.state == other.state == CONNECTED
    assert np.array_equal(one.components, other.components)


@pytest.mark.parametrize("phase", [(5.0, 0.0), (-3.0, -7.25), (0.999, 0.999), (1e6, 0.5)])
def test_any_phase_keeps_to_the_buffer(phase):
    """The dragon's halves share pixels whatever the window; the square's would touch along a line between pixels."""
    assert index_buffer(SHAPES["Heighway dragon"], 50, phases=(phase,)).state == CONNECTED


def test_the_index_buffer_agrees_where_the_gap_is_wide():
    for scale in (0.3, 0.4, 0.55, 0.7):
        expected = CONNECTED if scale > 0.5 else DISCONNECTED
        for family in (gasket, cantor, lambda scale: squares(scale, 1 - 2 * scale)):
            assert connectedness(family(scale)).state == expected
            assert index_buffer(family(scale), 120).state == expected
            assert object_based(family(scale), 7).state == expected


def test_bad_index_buffers_stay_honest():
    """Where it says connected, pixels are shared: the gap is at most a pixel's diagonal."""
    for name, morph in PAIRS.items():
        for u, v in np.random.default_rng(8).uniform(0, 1, (10, 2)):
            ifs = morph.at(u, v)
            verdict = index_buffer(ifs, 100)
            if verdict.state == CONNECTED:
                assert connectedness(ifs).gap[0] <= verdict.gap[1], (name, u, v)


@given(seeds)
@settings(max_examples=40)
def test_what_the_object_based_algorithm_calls_disconnected_is(seed):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(3, 2, 2))
    linear *= (random.uniform(0.1, 0.6, 3) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    ifs = IFS(np.concatenate([linear, random.normal(size=(3, 2, 1))], axis=-1))
    verdict = object_based(ifs, 5)
    sure = connectedness(ifs)
    if verdict.state == DISCONNECTED:
        assert sure.state in (DISCONNECTED, CONNECTED)
        assert verdict.gap[0] <= sure.gap[1]
        assert verdict.gap[0] > 0
        assert len(np.unique(verdict.components)) > 1
    else:
        assert verdict.state == CONNECTED
        assert not verdict.components.any()


def test_more_iterations_of_the_object_based_algorithm_see_finer_gaps():
    found = [threshold_of(lambda scale, n=n: object_based(gasket(scale), n).state) for n in range(1, 8)]
    assert all(before <= after + 1e-9 for before, after in pairwise(found))
    assert found[0] < found[5] <= 0.5 + 1e-9


def threshold_of(state):
    low, high = 0.1, 0.6
    for _ in range(25):
        middle = (low + high) / 2
        low, high = (low, middle) if state(middle) == CONNECTED else (middle, high)
    return high
