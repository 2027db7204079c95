"""Spreading finds all of an attractor, and nothing else, however seldom chance would lead there."""

import numpy as np
import pytest

from core.ifs import IFS
from core.shapes import SHAPES
from core.spreading import MOST_CELLS, mark
from core.words import unit_maps
from tests.core.picture_reference import chaos_game, farthest, pixels, subdivision, to_pixels

SIZE, WINDOW = (64, 64), (-0.113, -0.117, 1.107, 1.103)
SCALE = 64 / 1.22

HEAVY = IFS([[[0.97, 0, x], [0, 0.97, y]] for x, y in ((0, 0), (0.03, 0), (0, 0.03))])
"""Its attractor is a filled triangle, that lies over itself again and again."""


def view(ifs, scale=SCALE):
    maps, center, radius = unit_maps(ifs, 1e-9)
    shift = (center - WINDOW[:2]) * scale
    return np.array([radius * scale, 0, shift[0], 0, radius * scale, shift[1]]), maps


def marked(ifs):
    canvas = np.zeros(SIZE, np.uint8)
    assert mark(canvas, *view(ifs), np.arange(1, ifs.count + 1, dtype=np.uint8))
    return canvas


def test_a_filled_triangle_is_filled_to_its_corners():
    picture = marked(HEAVY) > 0
    rows, columns = np.indices(SIZE)
    x, y = (columns + 0.5) / SCALE + WINDOW[0], (rows + 0.5) / SCALE + WINDOW[1]
    inside = np.minimum(np.minimum(x, y), (1 - x - y) / 2**0.5) * SCALE
    assert np.mean(picture[inside > 1]) > 0.99
    assert not picture[inside < -1].any()


@pytest.mark.parametrize("name", ["square", "Barnsley tree", "Pythagoras tree", "maple leaf"])
def test_it_finds_what_the_chaos_game_finds(name):
    ifs = SHAPES[name]
    x0, y0, x1, y1 = ifs.bounds
    scale = 60 / max(x1 - x0, y1 - y0)
    window = (x0 - 2 / scale, y0 - 2 / scale, x0 + 62 / scale, y0 + 62 / scale)
    maps, center, radius = unit_maps(ifs, 1e-9)
    shift = (center - window[:2]) * scale
    canvas = np.zeros(SIZE, np.uint8)
    mark(
        canvas, np.array([radius * scale, 0, shift[0], 0, radius * scale, shift[1]]), maps, np.ones(ifs.count, np.uint8)
    )
    found = pixels(to_pixels(chaos_game(ifs, 20_000), SIZE, window), SIZE)
    assert np.mean(canvas[found] > 0) > 0.98


@pytest.mark.parametrize("name", ["terdragon", "gasket"])
def test_it_marks_nothing_else(name):
    assert farthest(marked(SHAPES[name]) > 0, subdivision(SHAPES[name], SIZE, WINDOW, 0.5)) <= 0.5


def test_a_label_is_the_last_map_that_led_to_a_pixel():
    labels = marked(SHAPES["terdragon"])
    for i in range(3):
        assert farthest(labels == i + 1, subdivision(SHAPES["terdragon"], SIZE, WINDOW, 0.5, first=i)) <= 0.5


def test_a_window_that_shows_a_small_part_asks_for_more():
    scale = 2 * MOST_CELLS
    canvas = np.zeros(SIZE, np.uint8)
    assert not mark(canvas, *view(HEAVY, scale), np.ones(3, np.uint8))


def test_one_point_is_one_pixel():
    assert np.count_nonzero(marked(IFS([[[0.5, 0, 0.25], [0, 0.5, 0.25]]]))) == 1
