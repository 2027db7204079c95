"""The chaos game on a canvas: that it plays by the weights, and always the same game."""

import numpy as np
import pytest

from core.chaos import deposit, mark
from core.ifs import IFS
from core.shapes import SHAPES
from core.words import unit_maps
from tests.core.picture_reference import farthest, pixels, subdivision

SIZE, WINDOW = (64, 64), (-0.113, -0.117, 1.107, 1.103)
SCALE = 64 / 1.22


def view(ifs):
    maps, center, radius = unit_maps(ifs, 1e-9)
    shift = (center - WINDOW[:2]) * SCALE
    return np.array([radius * SCALE, 0, shift[0], 0, radius * SCALE, shift[1]]), maps


def marked(ifs, threads=1, samples=64.0):
    canvas = np.zeros(SIZE, np.uint8)
    labels = np.arange(1, ifs.count + 1, dtype=np.uint8)
    mark(canvas, *view(ifs), ifs.weights, labels, samples, threads)
    return canvas


def mass(ifs, threads=1, total=2**62):
    canvas = np.zeros(SIZE, np.int64)
    deposit(canvas, *view(ifs), ifs.weights, 64.0, total, threads)
    return canvas


@pytest.mark.parametrize("name", ["gasket", "terdragon"])
def test_it_marks_the_attractor(name):
    ifs = SHAPES[name]
    points = subdivision(ifs, SIZE, WINDOW, 0.5)
    picture = marked(ifs) > 0
    assert farthest(picture, points) <= 0.5
    assert np.mean(picture[pixels(points, SIZE)]) >= 0.97


def test_a_label_is_the_last_map_that_led_to_a_pixel():
    labels = marked(SHAPES["terdragon"])
    for i in range(3):
        assert farthest(labels == i + 1, subdivision(SHAPES["terdragon"], SIZE, WINDOW, 0.5, first=i)) <= 0.5


def test_it_uses_maps_as_often_as_they_weigh():
    weights = [0.02, 0.08, 0.3, 0.6]
    dust = IFS(SHAPES["Cantor dust"].maps, weights)
    picture = mass(dust) / 2**62
    middle = int((0.5 - WINDOW[0]) * SCALE)
    quarters = [
        picture[rows, columns].sum()
        for rows in (slice(None, middle), slice(middle, None))
        for columns in (slice(None, middle), slice(middle, None))
    ]
    assert quarters == pytest.approx(weights, abs=0.005)


def test_a_map_without_weight_is_not_used():
    gasket = IFS(SHAPES["gasket"].maps, [1, 0, 1])
    assert set(np.unique(marked(gasket))) == {0, 1, 3}


def test_all_the_mass_is_there():
    assert int(mass(SHAPES["gasket"]).sum()) == 2**62


def test_threads_play_the_same_game():
    for play in (marked, mass):
        assert len({play(SHAPES["Barnsley fern"], threads).tobytes() for threads in (1, 2, 3, 5)}) == 1


def test_more_points_mark_more():
    few, many = marked(SHAPES["terdragon"], samples=16.0) > 0, marked(SHAPES["terdragon"], samples=64.0) > 0
    assert np.all(many[few])
    assert many.sum() > few.sum()
