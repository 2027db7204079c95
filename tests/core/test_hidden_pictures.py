"""Pictures and points of IFSs some of whose maps are hidden or faint, against the plain chaos game that skips them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import cKDTree

from core import chaos, raster, spreading
from core.cloud import point_cloud
from core.ifs import IFS
from core.raster import TOTAL_MASS, fit_window, render
from core.shapes import SHAPES
from core.space.ifs import SpaceIFS
from core.space.shapes import SPACE_SHAPES
from core.words import unit_maps
from tests.core.picture_reference import coverage, farthest, pixels, shifted, to_pixels
from tests.core.reference import at

SIZE = (160, 120)

TILED = [[[0.5, 0, 0], [0, 0.5, 0]], [[0.5, 0, 0.5], [0, 0.5, 0]], [[0.5, 0, 0], [0, 0.5, 0.5]]]
TWICE = IFS([*TILED, TILED[0]], [0.2, 0.3, 0.3, 0.2])
"""Its first and last map are the same, and share the piece that they draw."""
SHAPES_HERE = {
    "gasket": replace(SHAPES["gasket"], opacity=[0, 1, 1]),
    "fern": replace(SHAPES["Barnsley fern"], opacity=[1, 0, 0.5, 1]),
    "terdragon": replace(SHAPES["terdragon"], opacity=[0.25, 1, 0]),
    "twice": replace(TWICE, opacity=[1, 0, 0.5, 0]),
    "recurrent": replace(SHAPES["square"], transitions=np.ones((4, 4)) - np.eye(4), opacity=[0, 0.3, 1, 0]),
}
every_shape = pytest.mark.parametrize("name", SHAPES_HERE)


def game(ifs, count, seed=1):
    """Return points (count, 2) of the chaos game, and the map that led to each, hidden or not."""
    random = np.random.default_rng(seed)
    transitions = np.ones((ifs.count, ifs.count)) if ifs.transitions is None else ifs.transitions
    chances = np.cumsum(ifs.weights * transitions, axis=1)
    points, letters = np.tile(ifs.fixed_points[0], (1000, 1)), np.zeros(1000, int)
    found = []
    for step in range(60 + count // 1000):
        draws = random.random(1000) * chances[letters, -1]
        letters = (draws[:, None] >= chances[letters]).sum(axis=1)
        points = at(ifs.maps[letters], points)
        if step >= 60:
            found.append((points, letters))
    return tuple(np.concatenate(each) for each in zip(*found, strict=True))


def view(ifs):
    """Return a window that shows all of a shape, the hidden parts too."""
    return shifted(fit_window(replace(ifs, opacity=None), SIZE), SIZE)


def drawn_points(ifs, window, count=300_000):
    """Return points in pixels of the chaos game that skips hidden maps, and the map that led to each."""
    points, letters = game(ifs, count)
    return to_pixels(points[ifs.drawn[letters]], SIZE, window), letters[ifs.drawn[letters]]


@every_shape
@pytest.mark.parametrize("fixed", [False, True])
def test_a_set_lacks_what_is_hidden_and_nothing_else(name, fixed):
    ifs = SHAPES_HERE[name]
    window = view(ifs)
    norms = np.minimum(1.05 * ifs.norms, 0.98) if fixed else None
    picture = render(ifs, SIZE, window, norms=norms) > 0
    points, _ = drawn_points(ifs, window)
    assert farthest(picture, points) < 1.5
    assert coverage(picture, pixels(points, SIZE)) > 0.97
    assert np.count_nonzero(picture) < np.count_nonzero(render(replace(ifs, opacity=None), SIZE, window))


@every_shape
def test_attractorlets_keep_their_labels(name):
    ifs = SHAPES_HERE[name]
    window = view(ifs)
    labels = render(ifs, SIZE, window, "attractorlet")
    points, letters = drawn_points(ifs, window)
    assert set(np.unique(labels)) - {0} == {i + 1 for i in np.flatnonzero(ifs.drawn)}
    for i in np.flatnonzero(ifs.drawn):
        assert farthest(labels == i + 1, points[letters == i]) < 1.5


@every_shape
@pytest.mark.parametrize("fixed", [False, True])
def test_masses_are_those_of_the_game_times_the_opacities(name, fixed):
    ifs = SHAPES_HERE[name]
    window = view(ifs)
    norms = np.minimum(1.05 * ifs.norms, 0.98) if fixed else None
    density = render(ifs, SIZE, window, "density", norms=norms)
    points, letters = game(ifs, 400_000)
    places = to_pixels(points, SIZE, window) / 10
    expected, *_ = np.histogram2d(
        places[:, 1], places[:, 0], bins=(12, 16), range=((0, 12), (0, 16)), weights=ifs.opacity[letters]
    )
    blocks = (density / TOTAL_MASS).reshape(12, 10, 16, 10).sum(axis=(1, 3))
    assert blocks == pytest.approx(expected / len(points), abs=4e-3)
    assert (density >= 0).all()
    assert density.sum() / TOTAL_MASS == pytest.approx(ifs.opacity[letters].mean(), abs=4e-3)


@every_shape
@pytest.mark.parametrize("mode", raster.MODES)
def test_any_number_of_threads_draws_the_same(name, mode):
    ifs = SHAPES_HERE[name]
    pictures = {render(ifs, SIZE, view(ifs), mode, threads=threads).tobytes() for threads in (1, 2, 3)}
    assert len(pictures) == 1


@pytest.mark.parametrize("mode", raster.MODES)
@pytest.mark.parametrize("name", ["gasket", "terdragon", "Barnsley fern"])
def test_opacities_of_one_change_nothing(name, mode):
    ifs = SHAPES[name]
    assert np.array_equal(
        render(replace(ifs, opacity=np.ones(ifs.count)), SIZE, mode=mode), render(ifs, SIZE, mode=mode)
    )


@pytest.mark.parametrize("mode", ["set", "attractorlet"])
def test_what_is_faint_is_shown_where_there_is_no_brightness(mode):
    ifs = SHAPES["gasket"]
    faint = replace(ifs, opacity=[1e-6, 0.5, 1])
    assert np.array_equal(render(faint, SIZE, mode=mode), render(ifs, SIZE, mode=mode))


@pytest.mark.parametrize("seen", [[1, 0, 0, 0], [0, 0, 0, 1]])
def test_one_of_two_equal_maps_is_enough_to_be_seen(seen):
    """Even with no weight at all, since a set knows none."""
    ifs = IFS([*TILED, TILED[0]], 1 - np.array(seen))
    picture = render(replace(ifs, opacity=seen), SIZE, view(ifs))
    expected = render(replace(ifs, opacity=[1, 0, 0, 1]), SIZE, view(ifs))
    assert picture.any()
    assert np.array_equal(picture, expected)


def test_the_kernels_for_what_overlaps_draw_the_same():
    """Spreading and the chaos game, on a shape that is drawn by words otherwise."""
    ifs = SHAPES_HERE["terdragon"]
    window = view(ifs)
    scale = SIZE[0] / (window[2] - window[0])
    maps, center, radius = unit_maps(ifs, 1e-9)
    shift = (center - window[:2]) * scale
    root = np.array([radius * scale, 0, shift[0], 0, radius * scale, shift[1]])
    labels = np.arange(1, 4, dtype=np.uint8) * ifs.drawn
    expected = render(ifs, SIZE, window, "attractorlet")
    for mark in (
        lambda canvas: spreading.mark(canvas, root, maps, labels),
        lambda canvas: chaos.mark(canvas, root, maps, ifs.weights, labels, 64.0, 1),
    ):
        canvas = np.zeros(SIZE[::-1], np.uint8)
        mark(canvas)
        assert np.count_nonzero(canvas != expected) < 0.05 * np.count_nonzero(expected)
    canvas = np.zeros(SIZE[::-1], np.int64)
    chaos.deposit(canvas, root, maps, ifs.weights, 64.0, TOTAL_MASS, 1, opacity=ifs.opacity)
    assert canvas.sum() / TOTAL_MASS == pytest.approx((ifs.weights * ifs.opacity).sum(), abs=1e-3)


@pytest.mark.parametrize("mode", raster.MODES)
def test_of_what_overlaps_itself_again_and_again_a_part_is_drawn(mode):
    """The chaos game and spreading draw it. The piece that one map makes is the whole, seen through that map."""
    heavy = IFS([[[0.97, 0, x], [0, 0.97, y]] for x, y in ((0, 0), (0.03, 0), (0, 0.03))])
    window = np.array([-0.05, -0.05, 1.05, 1.05])
    part = render(replace(heavy, opacity=[0, 0.5, 0]), SIZE, tuple(window), mode).astype(float)
    whole = render(heavy, SIZE, tuple((window - [0.03, 0, 0.03, 0]) / 0.97), mode).astype(float)
    if mode == "density":
        blocks = [(each / TOTAL_MASS).reshape(12, 10, 16, 10).sum(axis=(1, 3)) for each in (part, whole / 6)]
        assert blocks[0] == pytest.approx(blocks[1], abs=2e-4)
    else:
        assert set(np.unique(part)) == {0, 2 if mode == "attractorlet" else 1}
        assert np.count_nonzero((part > 0) != (whole > 0)) < 0.01 * np.count_nonzero(whole)


@every_shape
def test_a_window_is_fitted_to_what_is_drawn(name):
    ifs = SHAPES_HERE[name]
    points, letters = game(ifs, 300_000)
    points = points[ifs.drawn[letters]]
    low, high = np.split(np.array(ifs.bounds), 2)
    size = (high - low).max()
    assert (points > low - 1e-9 * size).all()
    assert (points < high + 1e-9 * size).all()
    # The game seldom comes to the tip of a fern.
    assert np.abs(np.concatenate([points.min(axis=0) - low, high - points.max(axis=0)])).max() < 0.03 * size


@every_shape
def test_points_fall_as_the_opacities_say(name):
    ifs = SHAPES_HERE[name]
    window = view(ifs)
    cloud = point_cloud(ifs, 20_000)
    assert len(cloud.position) == 20_000
    _, letters = game(ifs, 400_000)
    shares = np.bincount(letters, minlength=ifs.count) * ifs.opacity
    found = np.bincount(cloud.attractorlet, minlength=ifs.count)
    assert found / 20_000 == pytest.approx(shares / shares.sum(), abs=0.01)
    assert not found[~ifs.drawn].any()
    points, _ = drawn_points(ifs, window)
    distances, _ = cKDTree(points).query(to_pixels(cloud.position.astype(float), SIZE, window))
    assert distances.max() < 1.5


def test_points_keep_their_addresses_where_a_map_hides():
    ifs = SHAPES["terdragon"]
    seen = point_cloud(ifs, 1000, address_opacity=[1, 0.5, 1])
    hidden = point_cloud(replace(ifs, opacity=[1, 0, 1]), 1000, address_opacity=[1, 0.5, 1])
    kept = seen.attractorlet != 1
    assert len(hidden.position) == np.count_nonzero(kept) == 800
    for name in ("position", "attractorlet", "radius"):
        assert getattr(hidden, name).tobytes() == getattr(seen, name)[kept].tobytes()
    with pytest.raises(ValueError, match="Address opacities must be 3 numbers"):
        point_cloud(ifs, 10, address_opacity=[1, 1])


def test_points_are_there_even_if_all_that_is_drawn_has_no_weight():
    ifs = IFS(SHAPES["gasket"].maps, [1, 0, 0], opacity=[0, 1, 1])
    assert np.bincount(point_cloud(ifs, 1000).attractorlet).tolist() == [0, 500, 500]


def test_points_in_space_do_the_same():
    whole = SPACE_SHAPES["Sierpinski tetrahedron"]
    ifs = replace(whole, opacity=[0, 1, 0.5, 0.5])
    cloud = point_cloud(ifs, 4000)
    assert np.bincount(cloud.attractorlet).tolist() == [0, 2000, 1000, 1000]
    assert isinstance(ifs, SpaceIFS)
    tree = cKDTree(point_cloud(whole, 100_000).position)
    assert tree.query(cloud.position)[0].max() < 0.02
    low, high = np.split(np.array(ifs.bounds), 2)
    assert (cloud.position > low - 1e-6).all()
    assert (cloud.position < high + 1e-6).all()
    assert low == pytest.approx(cloud.position.min(axis=0), abs=0.05)
    assert high == pytest.approx(cloud.position.max(axis=0), abs=0.05)
