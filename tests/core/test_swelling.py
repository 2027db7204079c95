"""Least swell by plain search, and the smooth curve above it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import BPoly

from core.connectedness import Connectedness, connectedness
from core.curve import bezier, slopes, smooth_keys
from core.ifs import IFS
from core.morph import Morph, spread
from core.parallel import finish
from core.shapes import SHAPES
from core.swelling import (
    LEVELS,
    NEVER,
    envelope,
    least_swell_field_steps,
    least_swell_steps,
)

CONNECTED, DISCONNECTED, UNDECIDED, NO_ATTRACTOR = Connectedness

TERDRAGON = Morph(SHAPES["terdragon"], SHAPES["gasket"])
FERN = Morph(SHAPES["Barnsley fern"], SHAPES["square"])

needs = st.lists(st.sampled_from([0.0, 0.0, 0.1, 0.25, 0.5, 1.0]) | st.floats(0, 1), min_size=2, max_size=80)


def flat_between():
    """Two ends that contract, with no attractor half-way."""
    first = IFS([[[0, 2, 0], [0.1, 0, 0]], [[0.3, 0, 1], [0, 0.3, 0]]])
    last = IFS([[[0, 0.1, 0], [2, 0, 0]], [[0.3, 0, 1], [0, 0.3, 0]]])
    return Morph(first, last, "elementwise")


def plain_least(morph, uv, start, tolerance):
    """The first swell that works, of `start` and the whole levels above it."""
    levels = [k / LEVELS for k in range(LEVELS + 1)]
    for swell in [start, *(level for level in levels if level > start)]:
        if connectedness(morph.at(*uv, swell), tolerance).state == CONNECTED:
            return swell
    return NEVER


@pytest.mark.parametrize("morph", [TERDRAGON, FERN])
@pytest.mark.parametrize("at_least", [0.0, 0.2])
def test_least_swell_by_plain_search(morph, at_least):
    places = np.pad(np.random.default_rng(6).uniform(0, 1, (20, 2)), ((0, 0), (0, 1)))
    found = finish(least_swell_steps(morph, places, 1 / 300, at_least))
    expected = [plain_least(morph, at, at_least, 1 / 300) for at in places[:, :2]]
    assert found.tolist() == expected
    assert (found > at_least).any()
    assert (found == at_least).any()


def test_least_swell_from_one_bound_for_each():
    start = np.array([0, 0.1, 0.33, 0.99, 1.0])
    found = finish(least_swell_steps(TERDRAGON, np.full((5, 3), 0.5), 1 / 300, start))
    assert found.tolist() == [plain_least(TERDRAGON, (0.5, 0.5), low, 1 / 300) for low in start]
    assert (found >= start).all()


def test_where_there_is_no_attractor_no_swell_helps():
    assert finish(least_swell_steps(flat_between(), [[0.5, 0.5, 0]], 1 / 300)).tolist() == [NEVER]


def test_no_frames_need_no_swell():
    assert len(finish(least_swell_steps(TERDRAGON, np.empty((0, 3)), 1 / 300))) == 0


@pytest.mark.parametrize("threads", [1, 2, 3])
def test_least_swell_does_not_depend_on_threads(threads):
    places = np.random.default_rng(7).uniform(0, 1, (30, 3))
    found = finish(least_swell_steps(TERDRAGON, places, 1 / 300, 0.0, threads))
    assert found.tobytes() == finish(least_swell_steps(TERDRAGON, places, 1 / 300, 0.0, 1)).tobytes()


def test_least_swell_where_each_map_has_its_own_place():
    place = np.array([0.5, 0.5, 0, 0.2, 0.14, -0.11, -0.19, -0.09, 0.01])
    found = finish(least_swell_steps(TERDRAGON, place[None], 1 / 300))
    assert found[0] == plain_least(TERDRAGON, spread(place, 3)[:2], 0.0, 1 / 300)
    assert found[0] != plain_least(TERDRAGON, (0.5, 0.5), 0.0, 1 / 300)


@pytest.mark.parametrize("morph", [TERDRAGON, flat_between()])
def test_the_field_is_the_least_level_of_each_node(morph):
    u, v = np.linspace(0, 1, 7), np.linspace(-0.5, 1.5, 5)
    field = finish(least_swell_field_steps(morph, u, v, 1 / 300, levels=8))
    assert field.shape == (5, 7)
    for row in range(5):
        for column in range(7):
            states = [connectedness(morph.at(u[column], v[row], k / 8)).state for k in range(9)]
            if states[0] == NO_ATTRACTOR:
                assert field[row, column] == np.inf
            elif CONNECTED in states:
                assert field[row, column] == states.index(CONNECTED) / 8
            else:
                assert field[row, column] == NEVER
    if morph is not TERDRAGON:
        assert np.isinf(field).any()


# --- the envelope


def envelope_curve(needed, spacing):
    frame, swell = envelope(needed, spacing)
    return frame, swell, smooth_keys(frame, swell).at(np.arange(len(needed)))


@given(needs, st.integers(2, 12))
@settings(max_examples=300)
def test_the_envelope_is_never_below_what_is_needed(needed, spacing):
    needed = np.array(needed)
    needed[[0, -1]] = 0.0
    frame, swell, curve = envelope_curve(needed, spacing)
    assert (curve >= needed - 1e-9).all()
    # No overshoot, so what is needed most is the most there is.
    fine = smooth_keys(frame, swell).at(np.linspace(0, len(needed) - 1, 20 * len(needed)))
    assert fine.max() <= needed.max() + 1e-12
    assert fine.min() >= -1e-12


def test_the_envelope_where_late_keys_lower_early_slopes():
    needed = np.array([0, 0.375, 0.75, 0, 0, 0.75, 0, 0.375, 0.875, 0])
    assert (envelope_curve(needed, 4)[2] >= needed - 1e-9).all()
    random = np.random.default_rng(0)
    for _ in range(300):
        needed = np.where(random.uniform(size=150) < 0.4, random.integers(0, 65, 150) / 64, 0.0)
        needed[[0, -1]] = 0
        assert (envelope_curve(needed, 6)[2] >= needed - 1e-9).all()


@given(needs, st.integers(2, 12))
def test_the_keys_of_the_envelope(needed, spacing):
    needed = np.array(needed)
    frame, swell = envelope(needed, spacing)
    assert frame[0] == 0
    assert frame[-1] == len(needed) - 1
    assert (np.diff(frame) > 0).all()
    assert np.issubdtype(frame.dtype, np.integer)
    assert swell[0] == needed[0]
    assert swell[-1] == needed[-1]
    if not needed.any():
        assert not swell.any()


def test_one_frame_that_needs_swell_is_a_hump_not_a_spike():
    needed = np.zeros(241)
    needed[100] = 0.4
    frame, _, curve = envelope_curve(needed, 10)
    assert curve[100] >= 0.4
    assert len(frame) <= 10
    # Ten frames up and ten down at the least: it rises by a smooth curve.
    assert np.abs(np.diff(curve)).max() < 0.4 * 0.2
    assert curve[:70].max() == 0
    assert curve[130:].max() == 0


# --- curves


@given(st.lists(st.floats(-2, 2), min_size=2, max_size=12), st.integers(0, 2**32 - 1))
@settings(max_examples=150)
def test_the_curve_does_not_overshoot_and_is_smooth(values, seed):
    values = np.array(values)
    times = np.cumsum(np.random.default_rng(seed).uniform(0.1, 3, len(values)))
    for k in range(len(values) - 1):
        piece = smooth_keys(times, values).at(np.linspace(times[k], times[k + 1], 50, endpoint=False))
        low, high = sorted(values[k : k + 2])
        assert (piece >= low - 1e-9).all()
        assert (piece <= high + 1e-9).all()
        assert (np.diff(piece) >= -1e-9).all() or (np.diff(piece) <= 1e-9).all()
    assert smooth_keys(times, values).at(times) == pytest.approx(values, abs=1e-12)


@given(st.lists(st.floats(-2, 2), min_size=3, max_size=9))
def test_slopes_are_harmonic_means_and_zero_at_turns(values):
    values = np.array(values)
    found = slopes(np.arange(len(values)), values)
    assert found[0] == found[-1] == 0
    for k in range(1, len(values) - 1):
        before, after = values[k] - values[k - 1], values[k + 1] - values[k]
        if before * after <= 0:
            assert found[k] == 0
        else:
            assert found[k] == pytest.approx(2 / (1 / before + 1 / after), rel=1e-9)


@given(*[st.floats(-5, 5)] * 4, st.floats(0, 1))
def test_bezier_is_the_bernstein_polynomial(p0, p1, p2, p3, x):
    expected = BPoly([[p0], [p1], [p2], [p3]], [0, 1])(x)
    assert bezier(p0, p1, p2, p3, x) == pytest.approx(float(expected), abs=1e-13)


@given(st.floats(-5, 5), st.floats(0, 1))
def test_equal_controls_give_just_themselves(p, x):
    assert bezier(p, p, p, p, x) == p
