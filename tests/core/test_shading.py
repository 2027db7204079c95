"""Colours: closed forms of the curves and ramps, antialiasing as a mean, and brightness that stays put."""

import colorsys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from core.raster import TOTAL_MASS, render
from core.shading import (
    PALETTES,
    WHITE,
    attractorlet_colors,
    ramp_lookup,
    shade,
    tone_map,
)
from core.shapes import SHAPES

RED, HALF_BLUE = (1.0, 0.1, 0.2, 1.0), (0.0, 0.2, 0.9, 0.5)


def even(shape, times=1.0):
    """Return the density of an attractor that is spread evenly over the picture, so many times over."""
    return np.full(shape, int(TOTAL_MASS / (shape[0] * shape[1]) * times), np.int64)


# ---- tone mapping --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("times", [0.25, 1, 5])
@pytest.mark.parametrize("exposure", [-2, 0, 1.5])
def test_curves_are_what_they_say(times, exposure):
    x = times * 2**exposure
    for curve, expected in (
        ("linear", x / WHITE),
        ("gamma", (x / WHITE) ** (1 / 1.8)),
        ("log", np.log(1 + x) / np.log(1 + WHITE)),
    ):
        brightness = tone_map(even((6, 8), times), curve, exposure, 1.8)
        assert brightness.dtype == np.float32
        assert np.allclose(brightness, min(expected, 1), rtol=1e-5)


@pytest.mark.parametrize("curve", ["log", "gamma", "linear"])
@given(arrays(np.int64, (4, 5), elements=st.integers(0, TOTAL_MASS // 20)), st.floats(-8, 8), st.floats(0.2, 5))
def test_brightness_grows_with_density_and_stays_in_range(curve, density, exposure, gamma):
    brightness = tone_map(density, curve, exposure, gamma)
    assert brightness.min() >= 0
    assert brightness.max() <= 1
    order = np.argsort(density, axis=None)
    assert np.all(np.diff(brightness.ravel()[order]) >= 0)
    assert np.all(brightness[density == 0] == 0)


@pytest.mark.parametrize("name", ["gasket", "Barnsley fern", "terdragon"])
def test_brightness_does_not_depend_on_samples_or_on_the_size(name):
    small, large = (300, 300), (600, 600)
    brightness = [tone_map(render(SHAPES[name], small, mode="density", samples=samples)) for samples in (4, 16, 64)]
    assert np.mean(np.abs(brightness[0] - brightness[2])) < 0.02
    assert np.mean(np.abs(brightness[1] - brightness[2])) < 0.01
    of_large = render(SHAPES[name], large, mode="density").reshape(300, 2, 300, 2).sum(axis=(1, 3))
    assert np.mean(np.abs(tone_map(of_large) - brightness[2])) < 0.01


def test_a_bright_spot_leaves_the_rest_as_it_is():
    density = even((20, 20), 0.5)
    alone = tone_map(density)[1:]
    density[0, 0] *= 300
    assert np.array_equal(tone_map(density)[1:], alone)


@pytest.mark.parametrize("wrong", [{"curve": "cubic"}, {"gamma": 0}, {"gamma": -1}])
def test_curves_that_make_no_sense_are_an_error(wrong):
    with pytest.raises(ValueError, match=r"curve|Gamma"):
        tone_map(even((2, 2)), **wrong)


# ---- ramps and colours ---------------------------------------------------------------------------------------------


def test_a_ramp_runs_straight_between_its_stops():
    lookup = ramp_lookup([(0.5, (1, 0, 0, 1)), (0.0, (0, 0, 0, 0)), (1.0, (1, 1, 0, 1))], entries=5)
    assert lookup.tolist() == [[0, 0, 0, 0], [0.5, 0, 0, 0.5], [1, 0, 0, 1], [1, 0.5, 0, 1], [1, 1, 0, 1]]


def test_a_ramp_is_level_beyond_its_stops():
    lookup = ramp_lookup([(0.4, RED), (0.6, HALF_BLUE)])
    assert lookup.shape == (256, 4)
    assert lookup[0] == pytest.approx(RED)
    assert lookup[-1] == pytest.approx(HALF_BLUE)


@pytest.mark.parametrize("name", PALETTES)
def test_palettes_run_from_nothing_to_light(name):
    stops = PALETTES[name]
    assert 2 <= len(stops) <= 32, "as many as Blender's color ramps take"
    assert [position for position, _ in stops] == sorted(position for position, _ in stops)
    lookup = ramp_lookup(stops)
    assert lookup[0, 3] == 0
    assert lookup[-1, 3] == 1
    luminance = lookup[:, :3] @ [0.2126, 0.7152, 0.0722]
    assert np.all(np.diff(luminance) >= 0)
    assert luminance[-1] > 0.8
    assert np.all((lookup >= 0) & (lookup <= 1))


@pytest.mark.parametrize("count", [0, 1, 3, 7, 16])
def test_attractorlets_have_colours_of_their_own(count):
    colors = attractorlet_colors(count)
    assert colors.shape == (count, 4)
    assert colors.dtype == np.float32
    assert np.all((colors >= 0) & (colors <= 1))
    assert np.all(colors[:, 3] == 1)
    hues = np.array([colorsys.rgb_to_hsv(*color[:3].tolist())[0] for color in colors])
    apart = np.abs(hues[:, None] - hues)
    apart = np.minimum(apart, 1 - apart) + np.eye(count)
    assert apart.min(initial=1) > 0.2 / max(count, 1)


# ---- pictures ------------------------------------------------------------------------------------------------------


def over(color, background):
    """Return a colour over a background, both straight, as one reads it in a book (Porter & Duff 1984)."""
    color, background = np.array(color), np.array(background)
    alpha = color[3] + background[3] * (1 - color[3])
    mixed = color[:3] * color[3] + background[:3] * background[3] * (1 - color[3])
    return np.append(mixed / alpha if alpha else color[:3], alpha)


@pytest.mark.parametrize("background", [(0, 0, 0, 0), (0.2, 0.3, 0.4, 1), (0.2, 0.3, 0.4, 0.5)])
@pytest.mark.parametrize("premultiplied", [False, True])
def test_a_set_is_its_colour_over_the_background(background, premultiplied):
    picture = np.float32([[0, 1, 1], [1, 0, 0]])
    result = shade(picture, "set", HALF_BLUE, background, premultiplied=premultiplied)
    assert result.shape == (2, 3, 4)
    assert result.dtype == np.float32
    assert result.flags.c_contiguous
    for row in range(2):
        for column in range(3):
            expected = over((*HALF_BLUE[:3], HALF_BLUE[3] * picture[row, column]), background)
            if premultiplied:
                expected[:3] *= expected[3]
            assert result[row, column] == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("factor", [1, 2, 3, 4])
def test_antialiasing_is_the_share_of_pixels_that_are_set(factor):
    picture = np.random.default_rng(1).integers(0, 2, (4 * factor, 5 * factor)).astype(np.float32)
    alpha = shade(picture, "set", RED, antialiasing=factor)[..., 3]
    assert np.allclose(alpha, picture.reshape(4, factor, 5, factor).mean(axis=(1, 3)), atol=1e-6)


@pytest.mark.parametrize("factor", [1, 2, 4])
@pytest.mark.parametrize("premultiplied", [False, True])
def test_attractorlets_mix_by_their_share_of_a_pixel(factor, premultiplied):
    labels = np.random.default_rng(2).integers(0, 4, (3 * factor, 4 * factor)).astype(np.uint8)
    colors = np.array([RED, HALF_BLUE, (0.5, 0.9, 0.1, 1.0)])
    background = (0.1, 0.1, 0.3, 0.25)
    result = shade(labels, "attractorlet", colors, background, factor, premultiplied=premultiplied)
    table = np.array([over(color, background) for color in [(0, 0, 0, 0), *colors]])
    table[:, :3] *= table[:, 3:]
    expected = table[labels].reshape(3, factor, 4, factor, 4).mean(axis=(1, 3))
    if not premultiplied:
        expected[..., :3] /= expected[..., 3:]
    assert np.allclose(result, expected, atol=1e-5)


@pytest.mark.parametrize("mode", ["set", "attractorlet"])
def test_marks_do_as_well_as_numbers(mode):
    marks = np.random.default_rng(3).integers(0, 2, (12, 16)).astype(np.uint8)
    colors = {"set": RED, "attractorlet": [RED]}[mode]
    assert np.array_equal(
        shade(marks, "set", RED, antialiasing=2, premultiplied=True),
        shade(marks.astype(np.float32), "set", RED, antialiasing=2, premultiplied=True),
    )
    of_labels = shade(marks, mode, colors, antialiasing=2, premultiplied=True)
    assert np.allclose(of_labels, shade(marks, "set", RED, antialiasing=2, premultiplied=True), atol=1e-6)


def test_no_attractorlet_at_all_is_transparent():
    assert not shade(np.zeros((2, 2), np.uint8), "attractorlet", attractorlet_colors(3)).any()


@pytest.mark.parametrize("factor", [1, 2])
def test_density_is_looked_up_in_the_ramp(factor):
    ramp = ramp_lookup(PALETTES["fire"])
    density = even((4 * factor, 4 * factor), 3.0)
    result = shade(density, "density", ramp, antialiasing=factor, curve="linear", exposure=1.0)
    place = 3.0 * 2 / WHITE * 255
    expected = ramp[int(place)] * (1 - place % 1) + ramp[int(place) + 1] * (place % 1)
    assert np.allclose(result, expected, atol=1e-3)


def test_the_ends_of_the_ramp_are_reached():
    density = even((2, 2), 0.0)
    density[0, 0] = TOTAL_MASS // 4 * 3
    result = shade(density, "density", ramp_lookup([(0, RED), (1, HALF_BLUE)]), exposure=6.0)
    assert result[0, 0] == pytest.approx(HALF_BLUE)
    assert result[1, 1] == pytest.approx(RED)


def test_shading_leaves_its_input_alone():
    density = render(SHAPES["gasket"], (64, 64), mode="density")
    before = density.copy()
    ramp = ramp_lookup(PALETTES["ice"])
    ramp_before = ramp.copy()
    shade(density, "density", ramp, antialiasing=2)
    assert np.array_equal(density, before)
    assert np.array_equal(ramp, ramp_before)


@pytest.mark.parametrize("mode", ["set", "density", "attractorlet"])
def test_bytes_do_not_depend_on_threads(mode):
    picture = render(SHAPES["terdragon"], (202, 150), mode=mode)
    colors = {"set": RED, "density": ramp_lookup(PALETTES["leaf"]), "attractorlet": attractorlet_colors(3)}[mode]
    assert len({shade(picture, mode, colors, antialiasing=2, threads=k).tobytes() for k in (1, 2, 3, 5, 200)}) == 1


@pytest.mark.parametrize(("shape", "factor"), [((4, 5), 2), ((3, 4), 2), ((4, 4), 0)])
def test_a_picture_that_has_no_whole_squares_is_an_error(shape, factor):
    with pytest.raises(ValueError, match="whole squares"):
        shade(np.zeros(shape, np.float32), "set", RED, antialiasing=factor)
