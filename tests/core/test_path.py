"""The path: what it promises an animator, checked frame by frame; its keys as an F-curve would evaluate them."""

import threading
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.connectedness import Connectedness, connectedness
from core.ifs import IFS, IFSError
from core.locus import compute_locus
from core.morph import Morph
from core.parallel import Cancelled
from core.path import METHODS, Keys, plan_path, plan_path_steps
from core.shapes import SHAPES

CONNECTED, DISCONNECTED, UNDECIDED, NO_ATTRACTOR = Connectedness

MORPHS = {
    "gaskets": Morph(SHAPES["turned gasket"], SHAPES["gasket"]),
    "terdragon": Morph(SHAPES["terdragon"], SHAPES["gasket"]),
    "paired terdragon": Morph(SHAPES["terdragon"], IFS(SHAPES["gasket"].maps[[0, 2, 1]])),
    "fern": Morph(SHAPES["Barnsley fern"], SHAPES["maple leaf"]),
    "dust": Morph(SHAPES["Cantor dust"], SHAPES["square"]),
}
LOCI, PATHS = {}, {}

every_morph = pytest.mark.parametrize("name", MORPHS)


def locus_of(name):
    """Return a coarser locus than the default, computed once."""
    if name not in LOCI:
        LOCI[name] = compute_locus(MORPHS[name], 130, gap=False)
    return LOCI[name]


def path_of(name, method="planned", frames=240):
    if (name, method, frames) not in PATHS:
        PATHS[name, method, frames] = plan_path(MORPHS[name], locus_of(name), frames, method=method)
    return PATHS[name, method, frames]


def states(morph, path, frames=240, tolerance=1 / 300):
    """The states of the frames by the plain verdict, from nothing but `at`."""
    return [connectedness(morph.at(*path.at(frame / (frames - 1))), tolerance).state for frame in range(frames)]


def no_attractor_between():
    first = IFS([[[0, 2, 0], [0.1, 0, 0]], [[0.3, 0, 1], [0, 0.3, 0]]])
    last = IFS([[[0, 0.1, 0], [2, 0, 0]], [[0.3, 0, 1], [0, 0.3, 0]]])
    return Morph(first, last, "elementwise")


def casteljau(controls, x):
    """A Bezier curve by repeated halving of the way between its controls."""
    while len(controls) > 1:
        controls = [(1 - x) * a + x * b for a, b in pairwise(controls)]
    return controls[0]


def evaluate(keys, t):
    """The keys as an F-curve: handles at a third of the interval in time; finds the parameter, then the value."""
    k = min(np.flatnonzero(keys.time <= t)[-1], len(keys.time) - 2)
    start, end = keys.time[k], keys.time[k + 1]
    times = [start, start + (end - start) / 3, end - (end - start) / 3, end]
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if casteljau(times, middle) < t else (low, middle)
    return casteljau([keys.value[k], keys.handle_right[k], keys.handle_left[k + 1], keys.value[k + 1]], low)


# --- what it promises


@pytest.mark.parametrize("name", ["gaskets", "terdragon", "paired terdragon", "fern"])
def test_no_frame_of_a_planned_path_is_in_pieces(name):
    path = path_of(name)
    found = states(MORPHS[name], path)
    assert found.count(CONNECTED) == 240
    assert path.report.path.count(CONNECTED) == 240
    assert path.report.path.share_disconnected == path.report.path.worst_gap == 0


def test_the_straight_line_of_the_gaskets_is_in_pieces():
    straight = path_of("gaskets", "straight unswollen")
    found = states(MORPHS["gaskets"], straight)
    assert found.count(DISCONNECTED) > 120
    for report in (straight.report, path_of("gaskets").report):
        assert report.straight.count(DISCONNECTED) == found.count(DISCONNECTED)
        assert report.straight.share_disconnected == found.count(DISCONNECTED) / 240


@pytest.mark.parametrize("frames", [60, 240])
def test_a_path_inside_the_locus_needs_next_to_no_swell(frames):
    path = path_of("gaskets", frames=frames)
    # Slivers thinner than the samples may cost a frame the least swell there is.
    assert path.report.path.most_swell <= 1 / 64
    assert path.report.path.mean_swell < 0.002
    assert path.report.reason == ""
    assert len(path.keys.time) <= 12


def test_terdragon_to_gasket_has_no_path_and_swells_a_little():
    path = path_of("terdragon")
    assert "No connected path" in path.report.reason
    assert 0 < path.report.path.most_swell < 0.35
    assert path.report.path.mean_swell < 0.1
    assert "Swell" in path.report.text()


def test_the_default_locus_gives_the_same_promise():
    """Without a locus of the caller's: 256 nodes a side."""
    path = plan_path(MORPHS["gaskets"])
    assert states(MORPHS["gaskets"], path).count(CONNECTED) == 240
    assert path.report.straight.share_disconnected > 0.5
    assert path.report.path.most_swell == 0
    assert not path.swell_keys.value.any()


@pytest.mark.parametrize("frames", [24, 97, 240])
@pytest.mark.parametrize("name", ["gaskets", "terdragon"])
def test_between_frames_it_holds_too(name, frames):
    """Motion blur looks between frames. Swell is made for whole frames, so there a few of others may fail."""
    path = path_of(name, frames=frames)
    times = (np.arange(2 * (frames - 1)) + 0.5) / (2 * (frames - 1))
    found = [connectedness(MORPHS[name].at(*path.at(t))).state for t in times]
    assert found.count(CONNECTED) >= (1 if name == "gaskets" else 0.9) * len(times)


@every_morph
@pytest.mark.parametrize("method", METHODS)
def test_the_ends_are_the_users_own_shapes(name, method):
    path = path_of(name, method)
    for t in (0, 1):
        u, v, swell = path.at(t)
        assert np.all(u == t)
        assert np.all(v == t)
        assert swell == 0
    assert np.array_equal(path.sample(np.array([-3.0, 7.0])), path.sample(np.array([0.0, 1.0])))
    keys = path.swell_keys
    for ends in (keys.value, keys.handle_left, keys.handle_right):
        assert ends[0] == ends[-1] == 0


@every_morph
def test_swell_stays_between_zero_and_one(name):
    path = path_of(name)
    swell = path.sample(np.linspace(0, 1, 3000))[:, 2]
    assert swell.min() >= 0
    assert swell.max() <= 1
    # Evaluated as an F-curve would, with no clamp, too.
    raw = path.swell_keys.at(np.linspace(0, 1, 3000))
    assert raw.min() >= -1e-9
    assert raw.max() <= 1 + 1e-9


@every_morph
def test_the_path_stays_in_the_domain(name):
    uv = path_of(name).sample(np.linspace(0, 1, 3000))[:, :2]
    assert uv.min() >= -1 - 1e-9
    assert uv.max() <= 2 + 1e-9


# --- keys


@every_morph
@pytest.mark.parametrize("method", METHODS)
def test_keys_ascend_and_lie_on_whole_frames(name, method):
    path = path_of(name, method)
    for keys in (path.keys, path.swell_keys):
        assert keys.time[0] == 0
        assert keys.time[-1] == 1
        assert (np.diff(keys.time) > 0).all()
        frame = keys.time * 239
        assert frame == pytest.approx(np.round(frame), abs=1e-9)
        assert keys.value.shape == keys.handle_left.shape == keys.handle_right.shape
        assert len(keys.value) == len(keys.time)
    assert path.keys.value.shape[1] == 2
    assert path.swell_keys.value.ndim == 1


@every_morph
def test_at_is_what_an_f_curve_evaluates(name):
    path = path_of(name)
    for t in [*np.linspace(0, 1, 41), *path.keys.time, *path.swell_keys.time]:
        u, v, swell = path.at(t)
        assert (u, v) == pytest.approx(tuple(evaluate(path.keys, t)), abs=1e-9)
        assert swell == pytest.approx(float(evaluate(path.swell_keys, t)), abs=1e-9)


@given(st.integers(2, 8), st.integers(0, 2**32 - 1), st.floats(-0.2, 1.2))
@settings(max_examples=80)
def test_any_keys_are_evaluated_as_an_f_curve(count, seed, t):
    random = np.random.default_rng(seed)
    time = np.concatenate([[0], np.sort(random.uniform(0.01, 0.99, count - 2)), [1]])
    shape = (count, 2) if seed % 2 else (count,)
    keys = Keys(time, *random.normal(size=(3, *shape)))
    assert keys.at(np.array([t]))[0] == pytest.approx(evaluate(keys, np.clip(t, 0, 1)), abs=1e-9)
    assert keys.at(time) == pytest.approx(keys.value, abs=1e-12)


@every_morph
def test_sample_is_at_many_times(name):
    path = path_of(name)
    times = np.linspace(0, 1, 17)
    assert path.sample(times).tolist() == [list(path.at(t)) for t in times]


def test_sample_where_each_map_has_its_own_path():
    path = path_of("terdragon", "per map")
    for t in np.linspace(0, 1, 17):
        u, v, swell = path.at(t)
        assert u.shape == v.shape == (3,)
        offsets = path.offset_keys.at(np.array([t]))[0]
        common = path.keys.at(np.array([t]))[0]
        assert np.array_equal([u, v], common[:, None] + offsets)
        assert np.array_equal(path.sample(np.array([t]))[0], [*common, swell, *offsets.ravel()])


@pytest.mark.parametrize("frames", [2, 3, 4, 7])
@pytest.mark.parametrize("method", METHODS)
def test_few_frames(frames, method):
    for name in ("gaskets", "terdragon"):
        path = path_of(name, method, frames)
        assert (np.diff(path.keys.time) > 0).all()
        assert (np.diff(path.swell_keys.time) > 0).all()
        assert len(path.report.path.state) == len(path.report.straight.state) == frames
        if method != "straight unswollen":
            assert states(MORPHS[name], path, frames).count(CONNECTED) == frames


# --- methods


@every_morph
def test_straight_is_the_diagonal(name):
    for method in ("straight", "straight unswollen"):
        path = path_of(name, method)
        for t in np.linspace(0, 1, 50):
            u, v, swell = path.at(t)
            assert (u, v) == pytest.approx((t, t), abs=1e-12)
            if method == "straight unswollen":
                assert swell == 0


@pytest.mark.parametrize("name", ["gaskets", "terdragon", "paired terdragon"])
def test_straight_with_swell_is_in_one_piece(name):
    path = path_of(name, "straight")
    assert states(MORPHS[name], path).count(CONNECTED) == 240
    assert path.report.path.most_swell > 0
    assert path.report.method == "straight"


def test_swell_is_not_wasted():
    """A frame's swell may be above its own need, but not above all need nearby."""
    path = path_of("terdragon", "straight")
    swell = path.sample(np.arange(240) / 239)[:, 2]
    needs = []
    for frame in range(240):
        t = frame / 239
        levels = np.arange(65) / 64
        held = (connectedness(MORPHS["terdragon"].at(t, t, level)).state == CONNECTED for level in levels)
        needs.append(next(level for level, fine in zip(levels, held, strict=True) if fine))
    assert swell.max() <= 1.5 * max(needs)


@every_morph
def test_report_is_that_of_the_frames(name):
    path = path_of(name)
    frames = np.array([path.at(frame / 239) for frame in range(240)])
    assert path.report.path.uv_swell == pytest.approx(frames, abs=1e-12)
    found = states(MORPHS[name], path)
    for state in Connectedness:
        assert path.report.path.count(state) == found.count(state)
    assert path.report.path.most_swell == pytest.approx(frames[:, 2].max())
    assert path.report.path.mean_swell == pytest.approx(frames[:, 2].mean())
    assert path.report.flips == MORPHS[name].flips
    assert path.report.method == "planned"


# --- ends in pieces, and shapes that vanish


def test_between_dust_and_a_shape_in_one_piece_gaps_close_little_by_little():
    path = path_of("dust")
    check, tolerated = path.report.path, path.report.tolerated
    assert check.state.tolist() == states(MORPHS["dust"], path)
    assert check.state[0] == DISCONNECTED
    assert (np.diff(tolerated) < 0).all()
    assert tolerated[-1] == pytest.approx(1 / 300)
    assert (check.gap[check.state == DISCONNECTED, 0] <= tolerated[check.state == DISCONNECTED]).all()
    assert path.report.broken == 0
    assert np.abs(np.diff(check.uv_swell[:, 2])).max() < 0.05


def test_dust_to_dust():
    dust = SHAPES["Cantor dust"]
    path = plan_path(Morph(dust, dust), frames=20)
    assert path.report.path.count(DISCONNECTED) == 20
    assert path.report.path.most_swell == 0


@pytest.mark.parametrize("method", [method for method in METHODS if method != "per map"])
def test_where_the_attractor_vanishes_on_the_way(method):
    path = plan_path(no_attractor_between(), frames=30, method=method)
    lost = path.report.path.count(NO_ATTRACTOR)
    assert lost > 0
    assert path.report.path.share_disconnected >= lost / 30
    assert np.isfinite(path.sample(np.linspace(0, 1, 100))).all()
    assert f"{lost} without an attractor" in path.report.text()


def test_paths_of_their_own_avoid_what_has_no_attractor():
    path = plan_path(no_attractor_between(), frames=30, method="per map")
    assert path.report.straight.count(NO_ATTRACTOR) > 0
    assert path.report.path.count(NO_ATTRACTOR) == path.report.broken == 0
    assert states(no_attractor_between(), path, 30) == path.report.path.state.tolist()


def test_a_shape_to_itself():
    path = plan_path(Morph(SHAPES["gasket"], SHAPES["gasket"]), frames=10)
    assert path.report.path.count(CONNECTED) == 10
    assert len(path.keys.time) == 2
    assert not path.swell_keys.value.any()


def test_an_end_without_an_attractor_is_refused_by_name():
    grows = IFS([[[1.5, 0, 0], [0, 0.5, 0]], *SHAPES["gasket"].maps[1:]], name="balloon")
    for morph in (Morph(grows, SHAPES["gasket"]), Morph(SHAPES["gasket"], grows)):
        with pytest.raises(IFSError, match=r"balloon.*map 1 .*1\.5"):
            plan_path(morph)


# --- bad arguments


def test_unknown_method():
    with pytest.raises(ValueError, match=r"“wiggly”.*planned, per map, straight, straight unswollen"):
        plan_path(MORPHS["gaskets"], method="wiggly")


@pytest.mark.parametrize("frames", [1, 0, -5])
def test_too_few_frames(frames):
    with pytest.raises(ValueError, match=f"{frames} frames.*2 or more"):
        plan_path(MORPHS["gaskets"], frames=frames)


@pytest.mark.parametrize(("domain", "end"), [((0.5, 2), "0,0"), ((-1, 0.5), "1,1"), (((-1, 2), (0, 0.5)), "1,1")])
def test_a_locus_that_does_not_hold_both_ends(domain, end):
    locus = compute_locus(MORPHS["gaskets"], 20, domain=domain, gap=False)
    with pytest.raises(ValueError, match=rf"no node at \({end}\).*domain"):
        plan_path(MORPHS["gaskets"], locus)


def test_a_locus_of_another_domain_will_do():
    locus = compute_locus(MORPHS["gaskets"], 120, domain=((-0.5, 1.5), (-1, 1.25)), gap=False)
    path = plan_path(MORPHS["gaskets"], locus, 60)
    assert states(MORPHS["gaskets"], path, 60).count(CONNECTED) == 60


# --- threads, progress, cancel


@pytest.mark.parametrize("name", ["gaskets", "terdragon"])
def test_the_path_does_not_depend_on_threads(name):
    one = plan_path(MORPHS[name], locus_of(name), 30, threads=1)
    for threads in (2, 3):
        other = plan_path(MORPHS[name], locus_of(name), 30, threads=threads)
        for keys in ("keys", "swell_keys"):
            for part in ("time", "value", "handle_left", "handle_right"):
                assert getattr(getattr(one, keys), part).tobytes() == getattr(getattr(other, keys), part).tobytes()
        assert one.report.text() == other.report.text()


@pytest.mark.parametrize("name", ["gaskets", "terdragon", "dust"])
@pytest.mark.parametrize("method", METHODS)
def test_progress_rises_to_one(name, method):
    told = []
    plan_path(MORPHS[name], locus_of(name), 60, method=method, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == pytest.approx(1)
    assert min(told) >= 0


@pytest.mark.parametrize("after", [1, 3, 8])
def test_cancel_leaves_nothing_running(after):
    before = threading.active_count()
    told = []

    def stop(share):
        told.append(share)
        return len(told) < after

    with pytest.raises(Cancelled):
        plan_path(MORPHS["terdragon"], locus_of("terdragon"), progress=stop)
    assert len(told) == after
    assert threading.active_count() == before


def test_steps_may_be_left_at_any_time():
    before = threading.active_count()
    steps = plan_path_steps(MORPHS["terdragon"], locus_of("terdragon"))
    next(steps)
    steps.close()
    assert threading.active_count() == before
