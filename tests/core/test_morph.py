"""The morph: its ends, Eq. 6 by an independent polar decomposition, flips, swell, and what it refuses."""

import numpy as np
import pytest
import scipy.linalg
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.connectedness import Connectedness, connectedness
from core.ifs import IFS, Contractivity, IFSError
from core.morph import SCHEMES, SWOLLEN, Morph, spread
from core.shapes import SHAPES

seeds = st.integers(0, 2**32 - 1)
parameters = st.floats(-1, 2)
every_scheme = pytest.mark.parametrize("scheme", SCHEMES)


def turn(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def of_linear(*linear):
    return IFS(np.concatenate([np.array(linear, dtype=float), np.zeros((len(linear), 2, 1))], axis=-1))


def ends(seed, count=4, same_sign=True, conditioning=1e3):
    """Two random IFSs of conditioning up to a bound, whose maps agree in orientation if so wished."""
    random = np.random.default_rng(seed)
    signs = random.choice([-1, 1], (2, count))
    if same_sign:
        signs[1] = signs[0]
    shapes = []
    for sign in signs:
        left, right = random.uniform(-np.pi, np.pi, (2, count))
        values = random.uniform(0.1, 0.9, count)
        linear = [
            turn(a) @ np.diag([s, d * s / conditioning**e]) @ turn(b)
            for a, b, s, d, e in zip(left, right, values, sign, random.uniform(0, 1, count), strict=True)
        ]
        shapes.append(IFS(np.concatenate([linear, random.normal(size=(count, 2, 1))], axis=-1)))
    return shapes


def of_eigenvalues(function, symmetric):
    """A function of a symmetric matrix by numpy's eigenvectors."""
    values, vectors = np.linalg.eigh(symmetric)
    return vectors @ np.diag(function(values)) @ vectors.T


def polar(linear):
    """Scipy's factors: orthogonal, and symmetric positive semidefinite."""
    return scipy.linalg.polar(linear)


# --- the ends


@every_scheme
@given(seeds, st.booleans())
@settings(max_examples=40)
def test_the_ends_are_the_given_shapes(scheme, seed, same_sign):
    initial, final = ends(seed, same_sign=same_sign)
    morph = Morph(initial, final, scheme)
    assert np.abs(morph.at(0, 0).maps - initial.maps).max() <= 1e-14
    assert np.abs(morph.at(1, 1).maps - final.maps).max() <= 1e-14
    assert np.abs(morph.at(0, 0).weights - initial.weights).max() <= 1e-15
    assert np.abs(morph.at(1, 1).weights - final.weights).max() <= 1e-15


@pytest.mark.parametrize("scheme", ["elementwise", "polar"])
@pytest.mark.parametrize(
    "pair", [("Barnsley fern", "maple leaf"), ("square", "Barnsley fern"), ("terdragon", "gasket")]
)
def test_the_ends_of_library_shapes(scheme, pair):
    initial, final = (SHAPES[name] for name in pair)
    morph = Morph(initial, final, scheme)
    assert np.abs(morph.at(0, 0).maps - initial.maps).max() <= 1e-14
    assert np.abs(morph.at(1, 1).maps - final.maps).max() <= 1e-14


@every_scheme
def test_u_drives_the_linear_parts_and_v_the_translations(scheme):
    initial, final = ends(1)
    morph = Morph(initial, final, scheme)
    assert np.array_equal(morph.at(0.3, 0).translation, initial.translation)
    assert np.array_equal(morph.at(0.3, 0.9).linear, morph.at(0.3, -0.5).linear)
    for v in (-1, 0.25, 2):
        assert morph.at(0.3, v).translation == pytest.approx((1 - v) * initial.translation + v * final.translation)


# --- between them


@given(seeds, parameters)
def test_elementwise_is_linear(seed, u):
    initial, final = ends(seed, same_sign=False)
    expected = (1 - u) * initial.linear + u * final.linear
    assert Morph(initial, final, "elementwise").linear(u) == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize("scheme", ["polar", "log-polar"])
@given(seeds, parameters)
@settings(max_examples=80)
def test_equation_6_by_scipys_polar_decomposition(scheme, seed, u):
    initial, final = ends(seed)
    found = Morph(initial, final, scheme).linear(u)
    for start, end, linear in zip(initial.linear, final.linear, found, strict=True):
        (q0, s0), (q1, s1) = polar(start), polar(end)
        # From one orthogonal factor to the other it is a plain turn, the shorter way round.
        between = q1 @ q0.T
        angle = np.arctan2(between[1, 0], between[0, 0])
        assume(abs(abs(angle) - np.pi) > 1e-6)
        if scheme == "polar":
            stretch = (1 - u) * s0 + u * s1
            tolerance = 1e-12
        else:
            stretch = of_eigenvalues(np.exp, (1 - u) * of_eigenvalues(np.log, s0) + u * of_eigenvalues(np.log, s1))
            tolerance = 1e-8 * max(1, np.abs(stretch).max())
        assert linear == pytest.approx(turn(u * angle) @ q0 @ stretch, abs=tolerance)


@given(seeds, st.lists(st.integers(-3, 3), min_size=4, max_size=4), parameters)
@settings(max_examples=40)
def test_winding_adds_whole_turns(seed, winding, u):
    initial, final = ends(seed)
    plain, wound = Morph(initial, final), Morph(initial, final, winding=winding)
    for i, turns in enumerate(winding):
        # For maps that reflect as for others the turn is on the outside.
        assert wound.linear(u)[i] == pytest.approx(turn(2 * np.pi * turns * u) @ plain.linear(u)[i], abs=1e-12)
    assert wound.linear(1.0) == pytest.approx(final.linear, abs=1e-13)


@pytest.mark.parametrize("scheme", ["polar", "log-polar"])
@pytest.mark.parametrize("start", np.linspace(-np.pi, np.pi, 13))
@pytest.mark.parametrize("noise", [0, 1e-15, -1e-15, 1e-12, -1e-12])
@pytest.mark.parametrize("mirror", [1, -1])
def test_half_a_turn_goes_counter_clockwise(scheme, start, noise, mirror):
    first = 0.5 * turn(start) @ np.diag([1, mirror])
    last = turn(np.pi + noise) @ first
    morph = Morph(of_linear(first), of_linear(last), scheme)
    assert morph.linear(0.5)[0] == pytest.approx(turn(np.pi / 2) @ first, abs=1e-9)


def test_the_papers_gasket_turns_counter_clockwise():
    morph = Morph(SHAPES["turned gasket"], SHAPES["gasket"])
    assert morph.linear(0.5)[0] == pytest.approx(0.5 * turn(np.pi * 1.5), abs=1e-12)
    assert morph.linear(0.5)[1:] == pytest.approx(np.tile(0.5 * np.eye(2), (2, 1, 1)))


@given(seeds, parameters, st.sampled_from([1e1, 1e3, 1e6]))
@settings(max_examples=80)
def test_log_polar_stretches_are_positive_everywhere(seed, u, conditioning):
    initial, final = ends(seed, conditioning=conditioning)
    linear = Morph(initial, final, "log-polar").linear(u)
    start = np.linalg.det(initial.linear)
    assert (np.linalg.det(linear) * np.sign(start) > 0).all()
    # And the determinant is the geometric mean, since the trace of the logarithm is linear.
    expected = np.sign(start) * np.abs(start) ** (1 - u) * np.abs(np.linalg.det(final.linear)) ** u
    assert np.linalg.det(linear) == pytest.approx(expected, rel=1e-9 * conditioning)
    for matrix in linear:
        _, stretch = polar(matrix)
        assert np.linalg.eigvalsh(stretch).min() > 0


def test_polar_stretches_need_not_be_positive_beyond_the_ends():
    morph = Morph(of_linear(np.diag([0.9, 0.9])), of_linear(np.diag([0.1, 0.9])))
    assert np.linalg.det(morph.linear(1.5)[0]) < 0


# --- flips


def signed(first, last, scheme="polar"):
    return Morph(of_linear(*first), of_linear(*last), scheme)


@pytest.mark.parametrize("scheme", ["polar", "log-polar"])
@given(seeds, st.floats(0, 1))
@settings(max_examples=60)
def test_flips_are_reported_and_are_singular_half_way_only(scheme, seed, u):
    initial, final = ends(seed, same_sign=False)
    morph = Morph(initial, final, scheme)
    signs = np.linalg.det(initial.linear) * np.linalg.det(final.linear)
    assert morph.flips == tuple(np.flatnonzero(signs < 0).tolist())
    flips = list(morph.flips)
    assert np.abs(np.linalg.det(morph.linear(0.5))[flips]).max(initial=0) <= 1e-15
    assume(abs(u - 0.5) > 0.01)
    expected = np.sign(np.linalg.det(initial.linear if u < 0.5 else final.linear))
    assert np.array_equal(np.sign(np.linalg.det(morph.linear(u))), expected)


def test_a_flip_is_a_turn_in_space_seen_from_above():
    morph = signed([np.diag([0.5, 0.5])], [np.diag([0.5, -0.5])])
    assert morph.flips == (0,)
    for u in (0.0, 0.2, 0.5, 0.9, 1.0):
        assert morph.linear(u)[0] == pytest.approx(np.diag([0.5, 0.5 * np.cos(np.pi * u)]), abs=1e-15)


@pytest.mark.parametrize("flat", [np.zeros((2, 2)), np.diag([0.5, 0]), np.array([[0.2, 0.4], [0.1, 0.2]])])
@pytest.mark.parametrize("other", [np.diag([0.5, 0.4]), np.diag([0.5, -0.4]), np.array([[0, 0.3], [0.2, 0.1]])])
def test_maps_flat_at_one_end_do_not_flip(flat, other):
    for morph in (signed([flat], [other]), signed([other], [flat])):
        assert morph.flips == ()
        sign = np.sign(np.linalg.det(other))
        for u in np.linspace(0.05, 0.95, 19):
            assert sign * np.linalg.det(morph.linear(u)[0]) > 0
    assert signed([flat], [flat.T]).flips == ()


@given(seeds)
@settings(max_examples=40)
def test_maps_flat_but_for_rounding_do_not_flip(seed):
    random = np.random.default_rng(seed)
    flat = np.outer(*random.normal(size=(2, 2))) * 0.3
    sides = turn(random.uniform(0, 6)) @ np.diag([0.5, 0.3]), turn(random.uniform(0, 6)) @ np.diag([0.5, -0.3])
    for other in sides:
        assert signed([flat], [other]).flips == ()
        assert signed([other], [flat]).flips == ()


# --- one u and v for each map


@every_scheme
@given(seeds)
@settings(max_examples=20)
def test_u_v_and_swell_may_be_one_for_each_map(scheme, seed):
    random = np.random.default_rng(seed)
    morph = Morph(*ends(seed), scheme)
    u, v = random.uniform(-0.5, 1.5, (2, 4))
    swell = random.uniform(0, 1, 4)
    ifs = morph.at(u, v, swell)
    for i in range(4):
        alone = morph.at(float(u[i]), float(v[i]), float(swell[i]))
        assert ifs.maps[i] == pytest.approx(alone.maps[i], rel=1e-12, abs=1e-14)
    assert ifs.weights == pytest.approx(morph.weights_at(u) / morph.weights_at(u).sum())


@every_scheme
def test_many_u_at_once_are_the_same_as_one_by_one(scheme):
    morph = Morph(*ends(3), scheme)
    u, swell = np.linspace(-1, 2, 7), np.linspace(0, 1, 5)
    many = morph.linear(u[:, None])
    assert many.shape == (7, 4, 2, 2)
    grid = morph.linear(u[:, None, None], swell[:, None])
    assert grid.shape == (7, 5, 4, 2, 2)
    for k in range(7):
        assert np.array_equal(many[k], morph.linear(u[k]))
        for s in range(5):
            assert grid[k, s] == pytest.approx(morph.linear(u[k], swell[s]), rel=1e-12, abs=1e-15)
    assert morph.translation(u[:, None]).shape == (7, 4, 2)
    assert np.array_equal(morph.translation(u[:, None])[2], morph.translation(u[2]))


def test_weights_are_between_the_ends_and_held_beyond():
    initial, final = IFS(np.zeros((2, 2, 3)), [1, 3]), IFS(np.zeros((2, 2, 3)), [1, 0])
    morph = Morph(initial, final)
    assert morph.at(0.5, 0).weights == pytest.approx([0.625, 0.375])
    assert morph.at(-1, 0).weights == pytest.approx([0.25, 0.75])
    assert morph.at(2, 0).weights == pytest.approx([1, 0])


# --- swell


@pytest.mark.parametrize("scheme", ["polar", "log-polar"])
@given(seeds, st.floats(0, 1), st.floats(0, 1))
@settings(max_examples=60)
def test_swell_raises_the_small_eigenvalues_and_keeps_the_rest(scheme, seed, u, swell):
    morph = Morph(*ends(seed), scheme)
    for thin, thick in zip(morph.linear(u), morph.linear(u, swell), strict=True):
        q, s = polar(thin)
        values, vectors = np.linalg.eigh(s)
        raised = values + swell * np.maximum(0, 0.72 - values)
        assert thick == pytest.approx(q @ vectors @ np.diag(raised) @ vectors.T, abs=1e-10)


@every_scheme
@given(seeds, parameters)
@settings(max_examples=60)
def test_full_swell_of_equal_signs_covers_half_the_area(scheme, seed, u):
    morph = Morph(*ends(seed), scheme)
    assert SWOLLEN == 0.72
    determinants = np.linalg.det(morph.linear(u, 1.0))
    assert np.abs(determinants).min() >= 0.5
    if scheme != "elementwise":
        assert np.array_equal(np.sign(determinants), np.sign(np.linalg.det(morph.initial.linear)))


@given(seeds, st.floats(0, 1), st.floats(-1, 2))
@settings(max_examples=60)
def test_full_swell_of_equal_signs_is_connected(seed, u, v):
    ifs = Morph(*ends(seed)).at(u, v, 1.0)
    assume(ifs.contractivity == Contractivity.CONTRACTIVE)
    assert connectedness(ifs, 1e-6).state == Connectedness.CONNECTED


@every_scheme
def test_no_swell_changes_nothing(scheme):
    morph = Morph(*ends(2), scheme)
    for u in (-0.7, 0.0, 0.4, 1.0):
        assert np.array_equal(morph.linear(u, 0.0), morph.linear(u))
    # Nor does a swell of zero for some when others swell.
    mixed = morph.linear(0.4, np.array([0, 1, 0, 1]))
    assert mixed[[0, 2]] == pytest.approx(morph.linear(0.4)[[0, 2]], abs=1e-15)


def test_swell_of_flat_maps_and_of_no_size():
    morph = signed([np.zeros((2, 2)), np.diag([0.5, 0])], [np.zeros((2, 2)), np.diag([0.5, 0])])
    linear = morph.linear(0.5, 1.0)
    assert np.abs(np.linalg.det(linear)) == pytest.approx([SWOLLEN**2] * 2)
    assert morph.linear(0.5, 0.5)[1] == pytest.approx(np.diag([0.61, 0.36]))


# --- what it refuses


def test_different_numbers_of_maps():
    with pytest.raises(IFSError) as error:
        Morph(SHAPES["Barnsley fern"], SHAPES["gasket"])
    for words in ("initial", "4 maps", "final", "3", "add", "remove"):
        assert words in str(error.value)


def test_unknown_scheme():
    with pytest.raises(IFSError, match=r"“cubic”.*elementwise, polar, log-polar"):
        Morph(SHAPES["gasket"], SHAPES["gasket"], "cubic")


@pytest.mark.parametrize("winding", [[0, 1], [0, 1, 0.5], [[0, 1, 1]], 1, [np.nan, 0, 0], [np.inf, 0, 0]])
def test_bad_winding(winding):
    with pytest.raises(IFSError, match="3 whole numbers of turns"):
        Morph(SHAPES["gasket"], SHAPES["gasket"], winding=winding)


@pytest.mark.parametrize("flat", [np.diag([0.5, 0]), np.zeros((2, 2)), np.array([[0.1, 0.3], [0.2, 0.6]])])
def test_a_flat_stretch_has_no_logarithm(flat):
    good = of_linear(0.5 * np.eye(2), 0.5 * np.eye(2))
    bad = of_linear(0.5 * np.eye(2), flat)
    with pytest.raises(IFSError, match=r"Map 2 of the initial shape is flat.*polar scheme"):
        Morph(bad, good, "log-polar")
    with pytest.raises(IFSError, match="Map 2 of the final shape is flat"):
        Morph(good, bad, "log-polar")


def test_nan_in_u_or_v_is_said():
    with pytest.raises(IFSError, match="NaN"):
        Morph(SHAPES["gasket"], SHAPES["turned gasket"]).at(np.nan, 0)


def test_attributes():
    initial, final = SHAPES["gasket"], SHAPES["turned gasket"]
    morph = Morph(initial, final, "log-polar", [1, 0, -2])
    assert (morph.initial, morph.final, morph.scheme, morph.count) == (initial, final, "log-polar", 3)
    assert morph.winding.tolist() == [1, 0, -2]


@given(st.integers(1, 5), st.integers(0, 7), st.integers(0, 2**32))
def test_places_spread_over_maps(count, known, seed):
    """Maps that a place says nothing of go along with u and v; what it says of maps that are not there is left."""
    random = np.random.default_rng(seed)
    place, offsets = random.normal(size=3), random.normal(size=(2, known))
    u, v, swell = spread(np.concatenate([place, offsets.ravel()]), count)
    for i in range(count):
        own = offsets[:, i] if i < known else np.zeros(2)
        assert np.broadcast_to(u, count)[i] == place[0] + own[0]
        assert np.broadcast_to(v, count)[i] == place[1] + own[1]
    assert swell.tolist() == [place[2]]


def test_many_places_spread_at_once():
    places = np.random.default_rng(3).normal(size=(4, 3 + 2 * 3))
    together = spread(places, 3)
    for k, place in enumerate(places):
        assert all(np.array_equal(each[k], one) for each, one in zip(together, spread(place, 3), strict=True))


def test_a_place_with_no_offsets_is_the_common_one():
    morph = Morph(SHAPES["terdragon"], SHAPES["gasket"])
    common = morph.at(0.3, 0.6, 0.1).maps
    for place in ([0.3, 0.6, 0.1], [0.3, 0.6, 0.1, 0, 0, 0, 0, 0, 0]):
        assert np.array_equal(morph.at(*spread(place, 3)).maps, common)


# --- opacity


def test_opacities_go_from_end_to_end_and_stay_there():
    shape = SHAPES["terdragon"]
    ends = [IFS(shape.maps, opacity=opacity) for opacity in ([0, 1, 0.2], [1, 1, 0.2])]
    morph = Morph(*ends)
    for u, first in ((-1, 0), (0, 0), (0.25, 0.25), (0.7, 0.7), (1, 1), (2, 1)):
        np.testing.assert_allclose(morph.at(u, 0.5).opacity, [first, 1, 0.2], atol=1e-15)
        # What is not to change does not, to the bit.
        assert morph.at(u, 0.5).opacity[1:].tolist() == [1, 0.2]
    u = np.array([0.25, -1, 0.5])
    np.testing.assert_allclose(morph.at(u, u).opacity, [0.25, 1, 0.2])
    allowed = morph.allowed_at(np.array([[-0.5], [0.0], [0.5]]))
    assert allowed.shape == (3, 4, 3)
    assert allowed[:, :3].all()
    assert allowed[:, 3].tolist() == [[False, True, True]] * 2 + [[True] * 3]
