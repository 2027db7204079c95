"""Pictures against exact subdivision, closed forms and the chaos game; the same bytes always; no flicker."""

from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.ifs import IFS, Contractivity, IFSError
from core.morph import Morph
from core.raster import TOTAL_MASS, fit_window, render
from core.shapes import SHAPES
from tests.core.picture_reference import chaos_game, coverage, farthest, pixels, shifted, subdivision, to_pixels

SIZE = (160, 120)
MODES = ("set", "density", "attractorlet")

RIGHT_ANGLED = IFS([[[0.5, 0, x], [0, 0.5, y]] for x, y in ((0, 0), (0.5, 0), (0, 0.5))], name="right-angled gasket")
SHEARED = IFS([[[0.5, 1.2, 0], [0, 0.5, 0]], [[0.5, 0, 0.5], [0.3, 0.5, 0.1]]], name="norm above 1")
FLAT = IFS([[[0.5, 0, 0], [0, 0, 0]], [[0.5, 0, 0.5], [0, 0.5, 0]], [[0, 0.3, 0], [0, 0.6, 0.4]]], name="flat maps")
SEGMENT = IFS([[[0.5, 0, 0], [0, 0, 0.3]], [[0.5, 0, 0.5], [0, 0, 0.3]]], name="segment")
SQUARES = IFS(
    [[[0.25, 0, x / 4], [0, 0.25, y / 4]] for x in range(4) for y in range(4) if (x + 2 * y) % 5], name="13 maps"
)
CROWDED = Morph(SHAPES["turned gasket"], SHAPES["gasket"]).at(0.5, 0.5, 0.6)
"""Overlaps itself: its words multiply by an exponent of 2.4."""

SLOW = IFS(
    [[[s * np.cos(t), -s * np.sin(t), x], [s * np.sin(t), s * np.cos(t), y]]
     for s, t, x, y in ((0.97, 0.3, 1, 0), (0.97, 2.0, 0, 1), (0.96, 4.1, -1, 0.5), (0.97, 5.5, 0.2, -1))],
    name="hardly shrinks",
)  # fmt: skip

SIMPLE = [
    *(SHAPES[name] for name in SHAPES if name not in ("maple leaf", "Pythagoras tree", "Barnsley tree")),
    SEGMENT,
    SQUARES,
]


def window_of(ifs, size=SIZE):
    return shifted(fit_window(ifs, size), size)


@cache
def exact_points(name, fineness=0.5):
    ifs = next(ifs for ifs in SIMPLE if ifs.name == name)
    return subdivision(ifs, SIZE, window_of(ifs), fineness)


# ---- the set -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ifs", SIMPLE, ids=lambda ifs: ifs.name)
@pytest.mark.parametrize("fixed_cut", [False, True])
def test_the_set_is_that_of_exact_subdivision(ifs, fixed_cut):
    points = exact_points(ifs.name)
    picture = render(ifs, SIZE, window_of(ifs), norms=ifs.norms if fixed_cut else None) > 0
    assert coverage(picture, pixels(points, SIZE)) >= 0.995
    assert farthest(picture, points) <= 0.5


@pytest.mark.parametrize(
    ("ifs", "side"),
    [
        (SHAPES["maple leaf"], 32),
        (SHAPES["Pythagoras tree"], 64),
        (SHAPES["Barnsley tree"], 128),
        (SHEARED, 16),
        (CROWDED, 48),
    ],
    ids=["maple leaf", "Pythagoras tree", "Barnsley tree", "norm above 1", "swollen"],
)
def test_the_set_is_that_of_exact_subdivision_where_words_overlap(ifs, side):
    window = window_of(ifs, (side, side))
    points = subdivision(ifs, (side, side), window, 0.9)
    picture, reference = render(ifs, (side, side), window) > 0, pixels(points, (side, side))
    assert np.count_nonzero(reference & ~picture) <= 1 + 0.005 * np.count_nonzero(reference)
    assert farthest(picture, points) <= 0.9


@pytest.mark.parametrize("side", [16, 128, 512])
def test_a_right_angled_gasket_is_pascals_triangle(side):
    """Its pixel (i, j) is set where i and j have no binary digit in common: where i + j over i is odd (Lucas)."""
    i = np.arange(side)
    assert np.array_equal(render(RIGHT_ANGLED, (side, side), (0, 0, 1, 1)) > 0, (i[:, None] & i) == 0)


@pytest.mark.parametrize("size", [(64, 64), (100, 100), (333, 71)])
def test_a_square_fills_every_pixel_and_no_more(size):
    assert np.all(render(SHAPES["square"], size, (0, 0, 1, 1)) == 1)
    width, height = size
    around = render(SHAPES["square"], (3 * width, 3 * height), (-1, -1, 2, 2))
    assert around.sum() == width * height
    assert np.all(around[height : 2 * height, width : 2 * width] == 1)


def test_cantor_dust_is_the_square_of_cantors_set():
    side, digits = 3**5, np.arange(3**5)
    cantor = np.ones(side, bool)
    for _ in range(5):
        cantor &= digits % 3 != 1
        digits //= 3
    assert np.array_equal(render(SHAPES["Cantor dust"], (side, side), (0, 0, 1, 1)) > 0, cantor[:, None] & cantor)


def test_flat_maps_are_drawn():
    window = window_of(FLAT)
    points = subdivision(FLAT, SIZE, window, 0.5)
    picture, reference = render(FLAT, SIZE, window) > 0, pixels(points, SIZE)
    assert np.count_nonzero(reference & ~picture) <= 4
    assert farthest(picture, points) <= 0.5


def test_one_map_sets_one_pixel():
    picture = render(IFS([[[0.3, -0.5, 0.2], [0.5, 0.3, 0.1]]]), (9, 9), (0, 0, 0.5, 0.5))
    x, y = np.linalg.solve([[0.7, 0.5], [-0.5, 0.7]], [0.2, 0.1])
    assert np.argwhere(picture).tolist() == [[int(y * 18), int(x * 18)]]


def test_maps_that_shrink_to_points_set_their_pixels():
    picture = render(IFS([[[0, 0, 0.1], [0, 0, 0.1]], [[0, 0, 0.9], [0, 0, 0.6]]]), (10, 10), (0, 0, 1, 1))
    assert sorted(np.argwhere(picture).tolist()) == [[1, 1], [6, 9]]


def test_maps_that_are_listed_twice_change_nothing():
    once = SHAPES["gasket"]
    twice = IFS(np.concatenate([once.maps, once.maps]))
    for mode in ("set", "density"):
        assert np.array_equal(render(once, SIZE, mode=mode), render(twice, SIZE, mode=mode))


@given(st.integers(0, 2**32 - 1), st.integers(1, 6))
@settings(max_examples=40)
def test_the_set_of_any_maps(seed, count):
    random = np.random.default_rng(seed)
    maps = random.uniform(-1, 1, (count, 2, 3))
    sizes = np.linalg.norm(maps[:, :, :2], 2, axis=(1, 2))
    maps[:, :, :2] *= (random.uniform(0.05, min(0.9, 1.6 * count**-0.5), count) / sizes)[:, None, None]
    ifs, size = IFS(maps), (48, 40)
    window = window_of(ifs, size)
    points = subdivision(ifs, size, window, 1)
    picture = render(ifs, size, window) > 0
    reference = pixels(points, size)
    assert np.count_nonzero(picture & reference) >= 0.99 * np.count_nonzero(reference) - 2
    assert farthest(picture, points) <= 1


# ---- density and attractorlets -------------------------------------------------------------------------------------


@pytest.mark.parametrize("ifs", [*SHAPES.values(), SHEARED, FLAT, SLOW], ids=lambda ifs: ifs.name)
def test_density_has_all_the_mass(ifs):
    for samples in (1, 16):
        picture = render(ifs, (64, 48), mode="density", samples=samples)
        assert picture.dtype == np.int64
        assert int(picture.sum()) == TOTAL_MASS


@pytest.mark.parametrize("name", ["gasket", "terdragon", "Barnsley fern", "maple leaf", "flat maps", "norm above 1"])
def test_density_is_that_of_the_chaos_game(name):
    ifs = {**SHAPES, "flat maps": FLAT, "norm above 1": SHEARED}[name]
    ifs = IFS(ifs.maps, np.arange(1, ifs.count + 1))
    window, count, blocks = window_of(ifs), 100_000, (8, 6)
    places = to_pixels(chaos_game(ifs, count), blocks, window)
    expected = np.histogram2d(places[:, 1], places[:, 0], bins=(range(7), range(9)))[0]
    found = render(ifs, SIZE, window, "density").reshape(6, 20, 8, 20).sum(axis=(1, 3)) / TOTAL_MASS * count
    # Points of the chaos game that follow each other are near each other, which widens the spread of counts.
    assert np.all(np.abs(found - expected) <= 10 * np.sqrt(found + 1) + 1e-3 * count)


@pytest.mark.parametrize(("samples", "spread"), [(16, 0.25), (64, 0.12)])
def test_density_of_a_filled_shape_is_even(samples, spread):
    """All the more so with more samples; a square's points are the least even, since they line up with the pixels."""
    picture = render(SHAPES["square"], (100, 100), (0, 0, 1, 1), "density", samples)
    assert np.std(picture / TOTAL_MASS * 10_000) <= spread


def test_attractorlets_have_the_mass_of_their_weights():
    dust = IFS(SHAPES["Cantor dust"].maps, [0.1, 0.2, 0.3, 0.4])
    picture = render(dust, (90, 90), (0, 0, 1, 1), "density")
    quarters = [picture[:45, :45], picture[:45, 45:], picture[45:, :45], picture[45:, 45:]]
    assert [int(quarter.sum()) / TOTAL_MASS for quarter in quarters] == pytest.approx([0.1, 0.2, 0.3, 0.4], abs=1e-11)


@pytest.mark.parametrize("name", ["gasket", "terdragon", "Barnsley fern", "Lévy curve"])
def test_a_label_is_the_last_attractorlet_of_its_pixel(name):
    ifs = SHAPES[name]
    window = window_of(ifs)
    labels = render(ifs, SIZE, window, "attractorlet")
    assert labels.dtype == np.uint8
    assert np.array_equal(labels > 0, render(ifs, SIZE, window) > 0)
    expected = np.zeros(labels.shape, np.uint8)
    for i in range(ifs.count):
        points = subdivision(ifs, SIZE, window, 0.5, first=i)
        assert farthest(labels == i + 1, points) <= 0.5
        expected[pixels(points, SIZE)] = i + 1
    assert np.mean(labels[expected > 0] == expected[expected > 0]) >= 0.995


# ---- the same bytes, and no flicker --------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("ifs", [SHAPES["terdragon"], SHAPES["maple leaf"], SLOW], ids=lambda ifs: ifs.name)
def test_bytes_do_not_depend_on_threads(ifs, mode):
    size = (320, 240) if ifs is SLOW else (1200, 900)
    pictures = [render(ifs, size, mode=mode, threads=threads).tobytes() for threads in (1, 2, 3, 5)]
    assert len(set(pictures)) == 1


def test_a_cut_by_norms_does_not_depend_on_the_frame():
    """In a pure motion of the attractor every point moves along: turning by a right angle turns the picture."""
    ifs = SHAPES["Barnsley fern"]
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    turned = IFS(np.concatenate([turn @ ifs.linear @ turn.T, (turn @ ifs.translation.T).T[..., None]], axis=-1))
    x0, y0, x1, y1 = window_of(ifs, (200, 200))
    upright = render(ifs, (200, 200), (x0, y0, x1, y1), norms=ifs.norms)
    lying = render(turned, (200, 200), (-y1, x0, -y0, x1), norms=ifs.norms)
    assert np.mean(np.rot90(lying, 1) != upright) < 0.001


@pytest.mark.parametrize("step", [0.02, 0.2])
@pytest.mark.parametrize("fixed_cut", [False, True])
@pytest.mark.parametrize("pair", [("turned gasket", "gasket"), ("Lévy curve", "Heighway dragon")])
def test_motion_toggles_no_more_pixels_than_an_exact_rendering(pair, fixed_cut, step):
    morph = Morph(SHAPES[pair[0]], SHAPES[pair[1]])
    window = fit_window([morph.at(t, t) for t in np.linspace(0, 1, 9)], SIZE)
    pixel = (window[2] - window[0]) / SIZE[0]
    # The fixed points of all maps move by `step` pixels in the mean.
    speed = (
        np.linalg.norm(morph.at(0.4001, 0.4001).fixed_points - morph.at(0.4, 0.4).fixed_points, axis=1).mean() / 1e-4
    )
    frames = [morph.at(t, t) for t in 0.4 + np.arange(5) * step * pixel / speed]
    norms = np.max([ifs.norms for ifs in (morph.initial, morph.final, *frames)], axis=0) if fixed_cut else None

    def toggles(pictures):
        return sum(np.count_nonzero(before ^ after) for before, after in pairwise(pictures))

    exact = toggles([pixels(subdivision(ifs, SIZE, window, 0.35), SIZE) for ifs in frames])
    found = toggles([render(ifs, SIZE, window, norms=norms) > 0 for ifs in frames])
    assert 0 < found <= 1.1 * exact + 5


def test_a_set_comes_in_the_type_asked_for():
    numbers, marks = (render(SHAPES["terdragon"], SIZE, dtype=dtype) for dtype in (np.float32, np.uint8))
    assert (numbers.dtype, marks.dtype) == (np.float32, np.uint8)
    assert np.array_equal(numbers, marks)


# ---- windows -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["gasket", "terdragon", "Barnsley fern", "maple leaf"])
def test_a_window_shows_a_part_of_the_picture(name):
    ifs = SHAPES[name]
    x0, y0, x1, y1 = window_of(ifs, (512, 512))
    part = (x0 + (x1 - x0) * 3 / 8, y0 + (y1 - y0) / 2, x0 + (x1 - x0) * 5 / 8, y0 + (y1 - y0) * 7 / 8)
    rows, columns = slice(256, 448), slice(192, 320)
    whole, crop = (
        render(ifs, size, window) > 0 for size, window in (((512, 512), (x0, y0, x1, y1)), ((128, 192), part))
    )
    assert np.count_nonzero(whole[rows, columns] ^ crop) <= 0.01 * np.count_nonzero(crop)
    whole = render(ifs, (512, 512), (x0, y0, x1, y1), "density")[rows, columns].sum()
    assert render(ifs, (128, 192), part, "density").sum() == pytest.approx(whole, rel=0.02)


@pytest.mark.parametrize("zoom", [1e2, 1e5])
def test_far_inside_the_picture_is_still_exact(zoom):
    ifs = SHAPES["terdragon"]
    place = chaos_game(ifs, 100)[-1]
    half = np.array([1, 0.75]) / zoom
    window = (*(place - half), *(place + half))
    points = subdivision(ifs, SIZE, window, 0.7)
    assert len(points) > 1000
    assert coverage(render(ifs, SIZE, window) > 0, pixels(points, SIZE)) >= 0.995


@pytest.mark.parametrize("mode", MODES)
def test_a_window_beside_the_attractor_is_empty(mode):
    assert not render(SHAPES["gasket"], (50, 50), (2, 2, 3, 3), mode).any()


def test_pixels_need_not_be_square():
    square = render(SHAPES["square"], (40, 90), (-1, -1, 2, 2))
    assert square.sum() == pytest.approx(40 * 90 / 9, rel=0.15)
    ifs, window = SHAPES["gasket"], (-0.0713, -0.0517, 1.0331, 0.9477)
    points = subdivision(ifs, (60, 300), window, 0.3)
    assert coverage(render(ifs, (60, 300), window) > 0, pixels(points, (60, 300))) >= 0.995


def test_the_fitted_window_holds_all_frames_and_no_more():
    morph = Morph(SHAPES["turned gasket"], SHAPES["gasket"])
    frames = [morph.at(t, t) for t in (0, 0.3, 1)]
    size = (200, 100)
    x0, y0, x1, y1 = fit_window(frames, size, margin=0.1)
    assert (x1 - x0) / (y1 - y0) == pytest.approx(2)
    bounds = np.array([ifs.bounds for ifs in frames])
    low, high = bounds[:, :2].min(axis=0), bounds[:, 2:].max(axis=0)
    assert np.all(low >= (x0 + 0.1 * (x1 - x0) - 1e-9, y0 + 0.1 * (y1 - y0) - 1e-9))
    assert np.all(high <= (x1 - 0.1 * (x1 - x0) + 1e-9, y1 - 0.1 * (y1 - y0) + 1e-9))
    assert (high - low)[1] == pytest.approx(0.8 * (y1 - y0)), "it is as small as it can be"


def test_the_fitted_window_passes_over_frames_without_attractor():
    broken = IFS([[[2, 0, 0], [0, 2, 0]]])
    assert broken.contractivity == Contractivity.NO_ATTRACTOR
    assert fit_window([SHAPES["gasket"], broken], SIZE) == fit_window(SHAPES["gasket"], SIZE)
    with pytest.raises(IFSError, match="norm"):
        fit_window([broken], SIZE)


@pytest.mark.parametrize("center", [(0, 0), (1000, -3)])
def test_a_point_gets_a_window_too(center):
    x, y = center
    x0, y0, x1, y1 = fit_window(IFS([[[0.5, 0, x / 2], [0, 0.5, y / 2]]]), (20, 10))
    assert x0 < x < x1
    assert y0 < y < y1


# ---- errors --------------------------------------------------------------------------------------------------------


def test_no_attractor_is_an_error():
    with pytest.raises(IFSError, match=r"map 2 .* norm"):
        render(IFS([[[0.5, 0, 0], [0, 0.5, 0]], [[1.5, 0, 0], [0, 0.5, 0]]]), SIZE)


def test_too_many_attractorlets_to_tell_apart_are_an_error():
    many = IFS([[[0.01, 0, k], [0, 0.01, 0]] for k in range(256)])
    with pytest.raises(IFSError, match="255"):
        render(many, SIZE, mode="attractorlet")
    assert render(many, (512, 8)).any()


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("fixed_cut", [False, True])
def test_so_small_a_part_that_numbers_cannot_tell_it_is_an_error(mode, fixed_cut):
    """It would take minutes to take words apart that all seem to lie in one place."""
    ifs = Morph(SHAPES["turned gasket"], SHAPES["gasket"]).at(-1e10, 1e20)
    with pytest.raises(IFSError, match=r"window is 1 wide .* larger"):
        render(ifs, SIZE, (0, 0, 1, 1), mode, norms=ifs.norms if fixed_cut else None)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"mode": "sketch"}, "mode"),
        ({"size": (0, 10)}, "0 x 10"),
        ({"window": (0, 0, 0, 1)}, "window"),
        ({"window": (0, 0, np.nan, 1)}, "window"),
        ({"norms": [0.5]}, "Norms"),
        ({"norms": [0.5, -1, 0.5]}, "Norms"),
    ],
)
def test_what_makes_no_sense_is_an_error(wrong, message):
    with pytest.raises(ValueError, match=message):
        render(SHAPES["gasket"], **{"size": SIZE, **wrong})


@pytest.mark.parametrize("norms", [[0.2, 1.0, 0.4, 0.4], [0.2, 0.9, 0.9, 0.9]])
def test_norms_that_are_too_large_are_of_no_effect(norms):
    fern = SHAPES["Barnsley fern"]
    assert np.array_equal(render(fern, SIZE, norms=norms), render(fern, SIZE))
