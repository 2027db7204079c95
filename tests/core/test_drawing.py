"""Points into pixels: clipped to the rows that are asked for, the same in any strips, and no mass lost."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.drawing import POINT_MASS, _strips, _whole_masses, add_masses, deposit, draw_marks, mark
from core.pieces import PointSets
from core.words import LETTER, MASS, SIZE

WIDTH, HEIGHT = 40, 30


def point_sets(seed=1, counts=(3, 50, 400)):
    random = np.random.default_rng(seed)
    start = np.concatenate([[0], np.cumsum(counts)])
    angle, radius = random.uniform(0, 2 * np.pi, start[-1]), np.sqrt(random.uniform(0, 1, start[-1]))
    x, y = (radius * np.cos(angle)).astype(np.float32), (radius * np.sin(angle)).astype(np.float32)
    return PointSets(1.0, 1, start, x, y, random.uniform(0, 1, start[-1]))


def words_of(seed, count=30):
    """Return words all over a canvas and beyond its border, of sizes that use all sets."""
    random = np.random.default_rng(seed)
    words = np.zeros((count, 10))
    words[:, [0, 1, 3, 4]] = random.uniform(-1, 1, (count, 4)) * random.choice([0.3, 1, 4], (count, 1))
    words[:, 2], words[:, 5] = random.uniform(-5, WIDTH + 5, count), random.uniform(-5, HEIGHT + 5, count)
    words[:, SIZE] = random.uniform(0.5, 3, count)
    words[:, MASS] = random.integers(0, 2**20, count)
    words[:, LETTER] = random.integers(0, 3, count)
    return words


def drawn_plainly(words, sets):
    """Return where the points of each word fall: word, point, row, column."""
    places = []
    for w, k in enumerate(sets.nearest(words)):
        for j in range(sets.start[k], sets.start[k + 1]):
            a, b, e, c, d, f = words[w, :6]
            column, row = np.floor(a * sets.x[j] + b * sets.y[j] + e), np.floor(c * sets.x[j] + d * sets.y[j] + f)
            if 0 <= column < WIDTH and 0 <= row < HEIGHT:
                places.append((w, j, int(row), int(column)))
    return places


@pytest.mark.parametrize("seed", range(3))
def test_marks_are_where_the_points_fall_and_later_words_cover_earlier_ones(seed):
    words, sets = words_of(seed), point_sets()
    labels = np.arange(1, len(words) + 1, dtype=np.uint8)
    expected, canvas = np.zeros((HEIGHT, WIDTH), np.uint8), np.zeros((HEIGHT, WIDTH), np.uint8)
    for w, _, row, column in drawn_plainly(words, sets):
        expected[row, column] = labels[w]
    mark(canvas, words, labels, sets, threads=1)
    assert np.array_equal(canvas, expected)


@pytest.mark.parametrize("seed", range(3))
def test_masses_are_added_where_the_points_fall(seed):
    words, sets = words_of(seed), point_sets()
    masses = _whole_masses(sets)
    expected, canvas = np.zeros((HEIGHT, WIDTH), np.int64), np.zeros((HEIGHT, WIDTH), np.int64)
    for w, j, row, column in drawn_plainly(words, sets):
        expected[row, column] += int(words[w, MASS]) * int(masses[j])
    deposit(canvas, words, sets, threads=1)
    assert np.array_equal(canvas, expected)


@given(st.integers(0, 1000), st.lists(st.integers(1, HEIGHT - 1), max_size=5))
def test_strips_make_the_same_picture_as_the_whole(seed, borders):
    words, sets = words_of(seed, 10), point_sets()
    nearest, masses = sets.nearest(words), _whole_masses(sets)
    labels = np.arange(1, len(words) + 1, dtype=np.uint8)
    marks, hits = np.zeros((2, HEIGHT * WIDTH), np.uint8), np.zeros((2, HEIGHT * WIDTH), np.int64)
    for k, rows in enumerate(([0, HEIGHT], [0, *sorted(set(borders)), HEIGHT])):
        for first, last in pairwise(rows):
            draw_marks(marks[k], WIDTH, words, labels, nearest, sets.start, 400, sets.x, sets.y, first, last)
            add_masses(hits[k], WIDTH, words, masses, nearest, sets.start, 400, sets.x, sets.y, first, last)
    assert np.array_equal(*marks)
    assert np.array_equal(*hits)


def test_strips_cover_all_rows_and_share_the_points_out():
    sets = point_sets(counts=(1, 1, 200_000))
    words = words_of(5, 100)
    words[:, SIZE] = 3
    words[:, 5] = np.random.default_rng(1).uniform(0, HEIGHT, 100) ** 2 / HEIGHT
    strips = _strips(np.zeros((HEIGHT, WIDTH), np.uint8), words, sets.nearest(words), sets, 4)
    assert len(strips) == 4
    assert strips[0][0] == 0
    assert strips[-1][1] == HEIGHT
    assert all(before[1] == after[0] for before, after in pairwise(strips))
    shares = [np.mean((words[:, 5] >= first) & (words[:, 5] < last)) for first, last in strips]
    assert max(shares) <= 0.35


def test_few_points_are_not_worth_a_second_thread():
    sets = point_sets()
    assert len(_strips(np.zeros((HEIGHT, WIDTH), np.uint8), words_of(1), sets.nearest(words_of(1)), sets, 8)) == 1


def test_points_of_a_set_have_whole_masses_that_add_up():
    sets = point_sets()
    masses = _whole_masses(sets)
    for begin, end in pairwise(sets.start):
        assert masses[begin:end].sum() == POINT_MASS
        exact = sets.masses[begin:end] / sets.masses[begin:end].sum() * POINT_MASS
        assert np.all(np.abs(masses[begin:end] - exact) <= 1)
