"""The locus: its nodes, its states one by one, the thin lines it must not lose, and its picture."""

import threading

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.connectedness import Connectedness, connectedness
from core.ifs import IFS
from core.locus import COLORS, FAR, MAX_NODES, NEAR, PATH_COLOR, WIDE, Locus, compute_locus, compute_locus_steps, nodes
from core.morph import Morph
from core.parallel import Cancelled
from core.shapes import SHAPES

CONNECTED, DISCONNECTED, UNDECIDED, NO_ATTRACTOR = Connectedness

GASKETS = Morph(SHAPES["turned gasket"], SHAPES["gasket"])
FERN = Morph(SHAPES["Barnsley fern"], SHAPES["square"])


# --- nodes


@pytest.mark.parametrize("resolution", [130, 256, 511, 75])
def test_zero_and_one_are_nodes(resolution):
    u, v = nodes(resolution)
    for axis in (u, v):
        assert axis[0] == -1
        assert axis[-1] == 2
        assert np.count_nonzero(axis == 0) == np.count_nonzero(axis == 1) == 1
        assert np.diff(axis) == pytest.approx(axis[1] - axis[0], rel=1e-9)
    assert len(u) == len(v)
    assert abs(len(u) - resolution) <= 1
    if (resolution - 1) % 3 == 0:
        assert len(u) == resolution


@settings(max_examples=50)
@given(st.integers(2, 300), st.floats(-3, 0), st.floats(0.01, 4), st.floats(-3, 0), st.floats(0.01, 4))
def test_nodes_of_any_domain_hold_it_and_lie_on_multiples(resolution, u0, u_width, v0, v_width):
    domain = ((u0, u0 + u_width), (v0, v0 + v_width))
    # A narrow domain that is tall would have more rows than are allowed, see below.
    assume(v_width / u_width * resolution < MAX_NODES - 2 and max(u_width, v_width) * resolution / u_width < MAX_NODES)
    u, v = nodes(resolution, domain)
    spacing = u[1] - u[0]
    for axis, (low, high) in zip((u, v), domain, strict=True):
        assert len(axis) >= 2
        assert axis[0] <= low + 1e-6 * spacing
        assert axis[-1] >= high - 1e-6 * spacing
        # No more than what holds the domain.
        assert axis[0] > low - spacing * (1 + 1e-6)
        assert axis[-1] < high + spacing * (1 + 1e-6) or len(axis) == 2
        assert np.diff(axis) == pytest.approx(spacing, rel=1e-6)
        for whole in (-1, 0, 1):
            if low <= whole <= high:
                assert whole in axis


@pytest.mark.parametrize("domain", [((0, 0.001), (-1, 2)), (-1e6, 1e6)])
def test_domains_with_too_many_nodes_are_refused(domain):
    with pytest.raises(ValueError, match="nodes a side"):
        nodes(511, domain)


def test_other_domains():
    u, v = nodes(11, (0, 1))
    assert u.tolist() == v.tolist() == [k / 10 for k in range(11)]
    u, v = nodes(21, ((-1, 1), (0.25, 0.5)))
    assert (u[0], u[-1], len(u)) == (-1, 1, 21)
    assert (v[0], v[-1]) == (0.2, 0.5)


@pytest.mark.parametrize("resolution", [1, 0, -5, MAX_NODES + 1])
def test_bad_resolutions(resolution):
    with pytest.raises(ValueError, match=f"resolution is {resolution}.*between 2 and {MAX_NODES}"):
        compute_locus(GASKETS, resolution)


@pytest.mark.parametrize(
    "domain", [(1, 0), (0, 0), (0, np.nan), (0, np.inf), ((0, 1), (2, 1)), (0, 1, 2), ((0, 1), (0, 1), (0, 1)), ()]
)
def test_bad_domains(domain):
    with pytest.raises(ValueError, match=r"domain is .*low, high"):
        compute_locus(GASKETS, 10, domain=domain)


@pytest.mark.parametrize("tolerance", [0, -1, np.nan])
def test_bad_tolerances(tolerance):
    with pytest.raises(ValueError, match=r"tolerance .* above 0"):
        compute_locus(GASKETS, 10, tolerance)


def test_node_is_the_nearest():
    locus = compute_locus(GASKETS, 13, gap=False)
    for row, v in enumerate(locus.v):
        for column, u in enumerate(locus.u):
            assert locus.node(u, v) == (row, column)
            assert locus.node(u + 0.1, v - 0.1) == (row, column)
    assert locus.node(-9, 9) == (12, 0)


@given(st.integers(2, 40), st.integers(2, 90))
def test_nearest_nodes_are_the_nearest(own, other):
    u, v = nodes(own, ((-1, 1), (0, 3)))
    locus = Locus(u, v, np.zeros((len(v), len(u)), np.uint8), np.zeros((len(v), len(u)), np.float32), 0.1)
    wanted_u, wanted_v = nodes(other, ((-1, 1), (0, 3)))
    rows, columns = locus.nearest_nodes(wanted_u, wanted_v)
    for wanted, axis, found in ((wanted_u, u, columns), (wanted_v, v, rows)):
        least = np.abs(wanted[:, None] - axis).min(axis=1)
        np.testing.assert_allclose(np.abs(wanted - axis[found]), least, atol=1e-9)


# --- states


@pytest.fixture(scope="module")
def gaskets():
    return compute_locus(GASKETS, 130)


@pytest.fixture(scope="module")
def fern():
    return compute_locus(FERN, 40)


@pytest.mark.parametrize("name", ["gaskets", "fern"])
def test_each_node_is_the_attractor_there(name, request):
    locus, morph = request.getfixturevalue(name), {"gaskets": GASKETS, "fern": FERN}[name]
    random = np.random.default_rng(1)
    seen = set()
    for row, column in zip(
        random.integers(len(locus.v), size=150), random.integers(len(locus.u), size=150), strict=True
    ):
        verdict = connectedness(morph.at(locus.u[column], locus.v[row]))
        assert locus.state[row, column] == verdict.state
        if verdict.state == UNDECIDED:
            continue
        np.testing.assert_array_equal(locus.gap[row, column], np.float32(verdict.gap[0]))
        seen.add(verdict.state)
    assert len(seen) >= 2


def test_types_and_shapes(gaskets):
    assert gaskets.u.shape == gaskets.v.shape == (130,)
    assert gaskets.state.shape == gaskets.gap.shape == (130, 130)
    assert gaskets.state.dtype == np.uint8
    assert gaskets.gap.dtype == np.float32
    assert gaskets.tolerance == 1 / 300
    wide = compute_locus(GASKETS, 31, domain=((-1, 2), (0, 1)))
    assert wide.state.shape == (11, 31)


@pytest.mark.parametrize("name", ["gaskets", "fern"])
def test_the_gap_is_above_zero_exactly_where_disconnected(name, request):
    locus = request.getfixturevalue(name)
    known = locus.state != NO_ATTRACTOR
    assert np.array_equal(locus.gap[known] > 0, locus.state[known] == DISCONNECTED)
    assert np.isnan(locus.gap[~known]).all()


def test_the_ends_are_in_one_piece_where_the_shapes_are(gaskets):
    assert gaskets.state[gaskets.node(0, 0)] == CONNECTED
    assert gaskets.state[gaskets.node(1, 1)] == CONNECTED


@pytest.mark.parametrize("resolution", [130, 256])
def test_thin_lines_are_found(resolution):
    """Turned gasket to gasket touches itself, no more, on u = 0 and u = 1; a column beside them is apart."""
    locus = compute_locus(GASKETS, resolution, tolerance=1e-5, domain=((-0.05, 1.05), (0, 1)), gap=False)
    first, last = (int(np.flatnonzero(locus.u == u)[0]) for u in (0, 1))
    assert (locus.state[0, first], locus.state[-1, last]) == (CONNECTED, CONNECTED)
    for column in (first, last):
        thin = locus.state[:, column] == CONNECTED
        beside = (locus.state[:, column - 1] == CONNECTED) | (locus.state[:, column + 1] == CONNECTED)
        # At (0,0) and (1,1), at least, the line is measure zero: both sides of it are apart.
        row = 0 if column == first else -1
        assert thin[row]
        assert not beside[row]


def test_identity_pairing_of_terdragon_and_gasket_has_vertical_bands():
    locus = compute_locus(Morph(SHAPES["terdragon"], SHAPES["gasket"]), 40, gap=False)
    inside = locus.state[:, :] == CONNECTED
    # v moves the maps as one similarity does, but where it puts them on one point.
    agree = (inside == inside[13]).mean(axis=0)
    assert agree.mean() > 0.97
    assert 0.05 < inside[13].mean() < 0.95


def test_shares_sum_to_one(fern):
    assert sum(fern.share(state) for state in Connectedness) == pytest.approx(1)
    assert fern.share(NO_ATTRACTOR) > 0.1
    assert fern.share(CONNECTED) == np.mean(fern.state == 0)


# --- threads, progress, cancel


@pytest.mark.parametrize("morph", [GASKETS, FERN])
def test_the_bytes_do_not_depend_on_threads(morph):
    one = compute_locus(morph, 25, threads=1)
    for threads in (2, 3, None):
        other = compute_locus(morph, 25, threads=threads)
        assert one.state.tobytes() == other.state.tobytes()
        assert one.gap.tobytes() == other.gap.tobytes()


def test_the_states_do_not_depend_on_the_gap_being_asked_for():
    with_gap, without = (compute_locus(FERN, 31, gap=gap) for gap in (True, False))
    assert np.array_equal(with_gap.state, without.state)
    assert not np.isnan(with_gap.gap[with_gap.state == DISCONNECTED]).any()
    assert np.isnan(without.gap[without.state == DISCONNECTED]).all()


@pytest.mark.parametrize("threads", [1, 2])
def test_progress_rises_and_ends(threads):
    told = []
    compute_locus(FERN, 60, threads=threads, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1
    assert min(told) > 0


@pytest.mark.parametrize("threads", [1, 3])
def test_cancel_stops_and_leaves_nothing_running(threads):
    before = threading.active_count()
    told = []

    def stop(share):
        told.append(share)
        return len(told) < 2

    with pytest.raises(Cancelled):
        compute_locus(GASKETS, 600, threads=threads, progress=stop)
    assert len(told) == 2
    assert told[-1] < 1
    assert threading.active_count() == before


def test_steps_are_the_same_work():
    steps = compute_locus_steps(FERN, 20)
    while True:
        try:
            next(steps)
        except StopIteration as done:
            assert done.value.state.tobytes() == compute_locus(FERN, 20).state.tobytes()
            break


# --- the picture


def small():
    """Three by four nodes, a row for each v: all states, and gaps from none to wide."""
    state = np.array([[0, 1, 1, 1], [2, 2, 3, 3], [0, 0, 0, 1]], dtype=np.uint8)
    gap = np.array([[0, 1e-9, WIDE, 1], [0, 0, np.nan, np.nan], [0, 0, 0, WIDE / 4]], dtype=np.float32)
    return Locus(np.array([0, 0.5, 1, 1.5]), np.array([0, 0.5, 1]), state, gap, 1 / 300)


def test_picture_colors_and_row_order():
    picture = small().picture()
    assert picture.shape == (3, 4, 4)
    assert picture.dtype == np.float32
    assert (picture[..., 3] == 1).all()
    near = {"abs": 1e-3}
    assert picture[0, 0, :3] == pytest.approx(COLORS[CONNECTED])
    assert picture[0, 1, :3] == pytest.approx(NEAR, **near)
    assert picture[0, 2, :3] == pytest.approx(FAR)
    assert picture[0, 3, :3] == pytest.approx(FAR)
    assert picture[1, 0, :3] == pytest.approx(COLORS[UNDECIDED])
    assert picture[1, 2, :3] == pytest.approx(COLORS[NO_ATTRACTOR])
    assert picture[2, 3, :3] == pytest.approx(np.add(NEAR, FAR) / 2)
    assert COLORS[CONNECTED] == (1, 1, 1)


def test_row_0_has_the_lowest_v(gaskets):
    picture = gaskets.picture()
    white = (picture[..., :3] == 1).all(axis=-1)
    assert np.array_equal(white, gaskets.state == CONNECTED)
    assert gaskets.v[0] == -1
    assert not np.array_equal(white, white[::-1])


def test_a_picture_without_gaps_tells_the_states_apart():
    locus = compute_locus(FERN, 20, gap=False)
    picture = locus.picture()
    assert np.isfinite(picture).all()
    colors = {state: {tuple(color) for color in picture[locus.state == state, :3]} for state in Connectedness}
    seen = [color for found in colors.values() for color in found]
    assert len(seen) == len(set(seen))


def test_the_path_is_drawn_where_it_is_and_nowhere_else(gaskets):
    points = np.array([[0, 0], [0.5, 0.0], [1, 1]])
    plain, drawn = gaskets.picture(), gaskets.picture(points)
    assert drawn.min() >= 0
    assert drawn.max() <= 1
    # Right on the path.
    for u, v in [(0, 0), (0.25, 0), (0.5, 0), (0.75, 0.5), (1, 1)]:
        assert drawn[gaskets.node(u, v)][:3] == pytest.approx(PATH_COLOR, abs=0.35)
    assert drawn[gaskets.node(0.25, 0)][:3] == pytest.approx(PATH_COLOR)
    # Three nodes from it and more, not at all.
    u, v = np.meshgrid(gaskets.u, gaskets.v)
    at = np.stack([u, v], axis=-1)
    away = np.full(u.shape, np.inf)
    for start, end in ((points[0], points[1]), (points[1], points[2])):
        share = np.clip((at - start) @ (end - start) / ((end - start) @ (end - start)), 0, 1)
        away = np.minimum(away, np.linalg.norm(at - start - share[..., None] * (end - start), axis=-1))
    spacing = gaskets.u[1] - gaskets.u[0]
    changed = (drawn != plain).any(axis=-1)
    assert not changed[away > 3 * spacing].any()
    assert changed[away < 1 * spacing].all()
    assert (drawn[..., 3] == 1).all()


@pytest.mark.parametrize(
    "points",
    [
        [[-5, 0.5], [5, 0.5]],
        [[3, 3], [4, 4]],
        [[0.5, 0.5], [0.5, 0.5]],
        [[0.5, 0.5]],
        [[-1, -1], [2, 2]],
        [[-9, -9], [-8, -9]],
    ],
)
def test_paths_that_leave_the_picture_or_have_no_length(gaskets, points):
    drawn = gaskets.picture(np.array(points, dtype=float))
    assert drawn.shape == (130, 130, 4)
    assert np.isfinite(drawn).all()
    if points[0] == [-5, 0.5]:
        row, _ = gaskets.node(0, 0.5)
        assert drawn[row, :, :3] == pytest.approx(np.tile(PATH_COLOR, (130, 1)), abs=0.35)


def test_a_locus_of_one_map():
    point = IFS([[[0.5, 0, 1], [0, 0.5, 0]]])
    assert (compute_locus(Morph(point, point), 13).state == CONNECTED).all()
