"""Pictures and points of recurrent IFSs, against all allowed words and against the chaos game as one writes it down."""

import random
from functools import cache

import numpy as np
import pytest
from scipy.spatial import cKDTree

from core import chaos, spreading
from core.cloud import point_cloud
from core.ifs import IFS
from core.morph import Morph
from core.raster import TOTAL_MASS, render
from core.shapes import SHAPES
from core.words import unit_maps
from tests.core.picture_reference import coverage, farthest, pixels, shifted, to_pixels
from tests.core.reference import at, children, norms

SIZE = (160, 120)


def recurrent(name, transitions, weights=None):
    return IFS(SHAPES[name].maps, weights, name, np.array(transitions, dtype=float))


NEVER_TWICE = np.ones((4, 4)) - np.eye(4)
SHAPES_HERE = {
    "square": recurrent("square", NEVER_TWICE * [[1, 1, 0.2, 3]], [0.4, 0.3, 0.2, 0.1]),
    "gasket": recurrent("gasket", [[1, 0.5, 1], [0, 1, 2], [1, 0, 1]]),
    "fern": recurrent("Barnsley fern", [[0, 1, 0, 0], [1, 1, 1, 1], [1, 1, 0, 1], [0, 1, 1, 0]]),
    "terdragon": recurrent("terdragon", [[0, 1, 1], [1, 0, 1], [1, 1, 0]], [0.2, 0.3, 0.5]),
    # The first map leads to the second and never back.
    "one way": recurrent("gasket", [[1, 1, 0], [0, 1, 1], [0, 1, 1]]),
}
HEAVY = IFS(
    [[[0.97, 0, x], [0, 0.97, y]] for x, y in ((0, 0), (0.03, 0), (0, 0.03))],
    transitions=[[1, 1, 0], [0, 1, 1], [1, 0, 1]],
)


def view(ifs):
    """Return a window that no border of the shape falls together with, and the scale in pixels."""
    x0, y0, x1, y1 = ifs.bounds
    pixel = max((x1 - x0) / (SIZE[0] - 8), (y1 - y0) / (SIZE[1] - 8))
    return shifted((x0 - 4 * pixel, y0 - 4 * pixel, x0 + (SIZE[0] - 4) * pixel, y0 + (SIZE[1] - 4) * pixel), SIZE)


def allowed_points(ifs, window, fineness, first=None):
    """Return points (P, 2) in pixels, one in each piece of an allowed word of less than `fineness` pixels."""
    center, radius = ifs.enclosing_disc
    limit = fineness * (window[2] - window[0]) / SIZE[0] / (2 * radius)
    last = np.arange(ifs.count) if first is None else np.array([first])
    words, found = ifs.maps[last], []
    while len(words):
        short = norms(words) <= limit
        found.append(at(words[short], center))
        follows = ifs.transitions.T[last[~short]].ravel() > 0
        words = children(words[~short], ifs.maps)[follows]
        last = np.tile(np.arange(ifs.count), np.count_nonzero(~short))[follows]
    return to_pixels(np.concatenate(found), SIZE, window)


@cache
def game(ifs, count, seed=1):
    """Return points (count, 2) of the chaos game, and the map that led to each."""
    chance, letter = random.Random(seed), int(np.argmax(ifs.weights))
    point, points, letters = np.zeros(2), [], []
    for step in range(count + 100):
        letter = chance.choices(range(ifs.count), ifs.weights * ifs.transitions[letter])[0]
        point = ifs.maps[letter][:, :2] @ point + ifs.maps[letter][:, 2]
        if step >= 100:
            points.append(point)
            letters.append(letter)
    return np.array(points), np.array(letters)


@pytest.mark.parametrize("fixed", [False, True])
@pytest.mark.parametrize("name", SHAPES_HERE)
def test_a_set_is_that_of_the_allowed_words(name, fixed):
    ifs = SHAPES_HERE[name]
    window = view(ifs)
    norms = np.minimum(1.1 * ifs.norms, 0.97) if fixed else None
    picture = render(ifs, SIZE, window, norms=norms, samples=16.0) > 0
    points = allowed_points(ifs, window, 0.5)
    assert coverage(picture, pixels(points, SIZE)) > 0.97
    assert farthest(picture, points) < 0.6
    free = render(IFS(ifs.maps), SIZE, window) > 0
    assert np.count_nonzero(picture) < 0.95 * np.count_nonzero(free)


@pytest.mark.parametrize("name", SHAPES_HERE)
def test_bounds_hold_the_allowed_words_and_little_more(name):
    ifs = SHAPES_HERE[name]
    low, high = np.split(np.array(ifs.bounds), 2)
    # In units of the box; few points come to the far end of a letter that is seldom used.
    points = (point_cloud(ifs, 20_000).position - low) / (high - low)
    assert points.min() > -1e-6
    assert points.max() < 1 + 1e-6
    assert np.all(points.max(axis=0) > 0.95)


@pytest.mark.parametrize("name", SHAPES_HERE)
def test_attractorlets_are_those_of_the_allowed_words(name):
    ifs = SHAPES_HERE[name]
    window = view(ifs)
    labels = render(ifs, SIZE, window, "attractorlet")
    for i in range(ifs.count):
        points = allowed_points(ifs, window, 0.5, first=i)
        assert farthest(labels == i + 1, points) < 0.6
    assert coverage(labels == ifs.count, pixels(points, SIZE)) > 0.95


@pytest.mark.parametrize("fixed", [False, True])
@pytest.mark.parametrize("name", SHAPES_HERE)
def test_masses_are_those_of_a_long_game(name, fixed):
    ifs = SHAPES_HERE[name]
    window = view(ifs)
    norms = np.minimum(1.1 * ifs.norms, 0.97) if fixed else None
    density = render(ifs, SIZE, window, "density", norms=norms)
    assert int(density.sum()) == TOTAL_MASS
    blocks = (density / TOTAL_MASS).reshape(12, 10, 16, 10).sum(axis=(1, 3))
    points, _ = game(ifs, 150_000)
    places = to_pixels(points, SIZE, window) / 10
    counts, *_ = np.histogram2d(places[:, 1], places[:, 0], bins=(12, 16), range=((0, 12), (0, 16)))
    expected = counts / len(points)
    # Points of the game that follow each other are near each other, which widens the spread of counts.
    assert np.all(np.abs(blocks - expected) < 6 * np.sqrt(3 * expected / len(points)) + 6 / len(points) + 2e-3)


def test_all_transitions_alike_make_no_difference():
    ifs = SHAPES["Barnsley fern"]
    alike = recurrent("Barnsley fern", np.full((4, 4), 0.5), ifs.weights)
    window = view(ifs)
    for mode in ("set", "attractorlet"):
        assert np.array_equal(render(ifs, SIZE, window, mode), render(alike, SIZE, window, mode))
    difference = np.abs(render(ifs, SIZE, window, "density") - render(alike, SIZE, window, "density"))
    assert difference.sum() < 1e-6 * TOTAL_MASS


@pytest.mark.parametrize("mode", ["set", "density", "attractorlet"])
def test_any_number_of_threads_draws_the_same(mode):
    for ifs in (SHAPES_HERE["terdragon"], HEAVY):
        pictures = {render(ifs, (640, 480), view(ifs), mode, threads=threads).tobytes() for threads in (1, 2, 3)}
        assert len(pictures) == 1


def canvas_of(ifs, dtype):
    window = view(ifs)
    scale = SIZE[0] / (window[2] - window[0])
    maps, center, radius = unit_maps(ifs, 1e-9)
    shift = (center - window[:2]) * scale
    root = np.array([radius * scale, 0, shift[0], 0, radius * scale, shift[1]])
    return np.zeros(SIZE[::-1], dtype), root, maps, window


@pytest.mark.parametrize("name", ["square", "gasket", "terdragon", "one way"])
def test_spreading_finds_what_is_allowed_and_nothing_else(name):
    ifs = SHAPES_HERE[name]
    canvas, root, maps, window = canvas_of(ifs, np.uint8)
    assert spreading.mark(canvas, root, maps, np.arange(1, ifs.count + 1, dtype=np.uint8), ifs.transitions)
    points = allowed_points(ifs, window, 0.3)
    assert farthest(canvas > 0, points) < 0.5
    assert coverage(canvas > 0, pixels(points, SIZE)) > 0.97
    for i in range(ifs.count):
        assert farthest(canvas == i + 1, allowed_points(ifs, window, 0.3, first=i)) < 0.5


@pytest.mark.parametrize("name", ["square", "gasket", "terdragon"])
def test_the_chaos_game_keeps_to_the_transitions(name):
    ifs = SHAPES_HERE[name]
    canvas, root, maps, window = canvas_of(ifs, np.uint8)
    chaos.mark(canvas, root, maps, ifs.weights, np.ones(ifs.count, np.uint8), 64.0, 1, ifs.transitions)
    assert farthest(canvas > 0, allowed_points(ifs, window, 0.3)) < 0.5
    canvas, root, maps, window = canvas_of(ifs, np.int64)
    chaos.deposit(canvas, root, maps, ifs.weights, 64.0, 2**62, 1, ifs.transitions)
    ours = render(ifs, SIZE, window, "density") / TOTAL_MASS
    blocks = [(each / 2.0**62).reshape(12, 10, 16, 10).sum(axis=(1, 3)) for each in (canvas, ours * 2.0**62)]
    assert np.abs(blocks[0] - blocks[1]).max() < 2e-3


def test_what_overlaps_itself_again_and_again_is_drawn_too():
    window = view(HEAVY)
    points, _ = game(HEAVY, 50_000)
    places = to_pixels(points, SIZE, window)
    picture = render(HEAVY, SIZE, window) > 0
    assert coverage(picture, pixels(places, SIZE)) > 0.99
    density = render(HEAVY, SIZE, window, "density") / TOTAL_MASS
    assert density.sum() == pytest.approx(1, abs=1e-6)
    rows, columns = np.indices(density.shape)
    found = np.array([(density * columns).sum(), (density * rows).sum()]) + 0.5
    assert found == pytest.approx(places.mean(axis=0), abs=2)


@pytest.mark.parametrize("name", SHAPES_HERE)
def test_points_lie_on_the_attractor_as_often_as_the_game_comes_by(name):
    ifs = SHAPES_HERE[name]
    window = view(ifs)
    cloud = point_cloud(ifs, 40_000)
    places = to_pixels(cloud.position.astype(float), SIZE, window)
    distances, _ = cKDTree(allowed_points(ifs, window, 0.3)).query(places)
    assert distances.max() < 0.4
    points, letters = game(ifs, 150_000)
    shares = np.bincount(letters, minlength=ifs.count) / len(letters)
    assert np.bincount(cloud.attractorlet, minlength=ifs.count) / 40_000 == pytest.approx(shares, abs=0.012)
    assert places.mean(axis=0) == pytest.approx(to_pixels(points, SIZE, window).mean(axis=0), abs=0.7)


def test_points_keep_their_addresses_while_maps_move():
    ifs = SHAPES_HERE["square"]
    moved = IFS(ifs.maps + 1e-4, ifs.weights, transitions=ifs.transitions * 0.9 + 0.1 * (ifs.transitions > 0))
    before = point_cloud(ifs, 5000)
    after = point_cloud(moved, 5000, ifs.weights, address_transitions=ifs.transitions)
    assert np.array_equal(before.attractorlet, after.attractorlet)
    assert np.abs(before.position - after.position).max() < 1e-3
    for threads in (1, 2, 3):
        assert point_cloud(ifs, 5000, threads=threads).position.tobytes() == before.position.tobytes()


def test_a_moving_picture_changes_no_more_than_its_maps():
    """Transitions that change along the way only change masses."""
    rarely = recurrent("square", NEVER_TWICE * [[1, 0.1, 0.1, 1]])
    often = recurrent("square", NEVER_TWICE * [[0.1, 1, 1, 1]])
    morph = Morph(rarely, often)
    window = view(rarely)
    frames = [morph.at(u, 0.0) for u in (0.3, 0.6)]
    pictures = [render(frame, SIZE, window, norms=morph.initial.norms) for frame in frames]
    assert np.array_equal(*pictures)
    densities = [render(frame, SIZE, window, "density", norms=morph.initial.norms) for frame in frames]
    assert not np.array_equal(*densities)
    assert coverage(densities[0] > 0, densities[1] > 0) > 0.97
    assert coverage(densities[1] > 0, densities[0] > 0) > 0.97
