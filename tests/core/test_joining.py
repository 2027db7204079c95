"""Morphs between recurrent shapes of different graphs: the ends are what they were, and nothing jumps."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.cloud import point_cloud
from core.connectedness import Connectedness, connectedness
from core.ifs import IFS
from core.joining import over_one_graph
from core.morph import Morph
from core.path import plan_path
from core.shapes import SHAPES
from tests.core.reference import allowed_points, hausdorff, recurrent_in_pieces

SQUARE = SHAPES["square"]
NEVER_TWICE = np.ones((4, 4)) - np.eye(4)


def recurrent(name, transitions, weights=None):
    return IFS(SHAPES[name].maps, weights, name, np.array(transitions, dtype=float))


def by_chance(random, count, density):
    """Return an IFS whose transitions are drawn, some of them such that not every map leads to every other."""
    linear = random.normal(size=(count, 2, 2))
    linear *= (random.uniform(0.2, 0.7, count) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    allowed = random.random((count, count)) < density
    allowed |= np.eye(count, dtype=bool)[random.permutation(count)]
    maps = np.concatenate([linear, random.uniform(-1, 1, (count, 2, 1))], axis=-1)
    return IFS(maps, random.uniform(0.1, 1, count), "", allowed * random.uniform(0.1, 1, (count, count)))


two_by_chance = given(st.integers(1, 5), st.sampled_from([0.0, 0.3, 0.6, 1.0]), st.integers(0, 10**6))


def ends_by_chance(count, density, seed):
    random = np.random.default_rng(seed)
    return by_chance(random, count, density), by_chance(random, count, 0.6)


@settings(max_examples=60)
@two_by_chance
def test_ends_keep_their_attractors_and_have_one_graph(count, density, seed):
    ends = ends_by_chance(count, density, seed)
    *joined, part_of = over_one_graph(*ends)
    assert np.array_equal(joined[0].follows, joined[1].follows)
    assert np.array_equal(part_of[:count], np.arange(count))
    for given_end, end in zip(ends, joined, strict=True):
        points, spacing = allowed_points(given_end, 3000)
        others, other_spacing = allowed_points(end, 3000)
        assert hausdorff(points, others) <= spacing + other_spacing


@settings(max_examples=20)
@two_by_chance
def test_ends_keep_their_measures(count, density, seed):
    """The means of coordinates, their squares and products, over points of fixed addresses."""
    ends = ends_by_chance(count, density, seed)
    for given_end, end in zip(ends, over_one_graph(*ends)[:2], strict=True):
        first, second = (point_cloud(ifs, 20_000).position.astype(float)[:, :2] for ifs in (given_end, end))
        size = given_end.enclosing_disc[1]
        assert np.allclose(first.mean(axis=0), second.mean(axis=0), atol=0.03 * size)
        assert np.allclose(np.cov(first.T), np.cov(second.T), atol=0.03 * size**2)


@settings(max_examples=20)
@two_by_chance
def test_nothing_jumps_at_the_ends_or_between(count, density, seed):
    morph = Morph(*ends_by_chance(count, density, seed))
    for u in (0.0, 0.5, 1.0 - 1e-6):
        here, there = morph.at(u, u), morph.at(u + 1e-6, u + 1e-6)
        assume(here.contractivity == there.contractivity == 0)
        # Points of the same words, so that the two sets are compared piece by piece.
        points, spacing = allowed_points(here, 3000)
        others, other_spacing = allowed_points(there, 3000)
        assert hausdorff(points, others) <= spacing + other_spacing + 1e-3
    assert np.array_equal(morph.allowed_at(0.0), morph.allowed_at(0.5))


def test_what_few_maps_differ_in_takes_few_parts():
    less = recurrent("square", np.ones((4, 4)) - np.diag([1, 0, 0, 0]))
    assert Morph(SQUARE, less).count == 5
    assert Morph(less, less).count == 4
    assert Morph(SQUARE, recurrent("square", NEVER_TWICE)).count == 8


def test_an_end_keeps_its_verdict():
    points = recurrent("spiral", [[1, 0], [1, 1]])
    for ends in ((SQUARE, recurrent("square", NEVER_TWICE)), (SHAPES["spiral"], points)):
        morph = Morph(*ends)
        for ifs, u in zip(ends, (0.0, 1.0), strict=True):
            assert connectedness(morph.at(u, u)).state == connectedness(ifs).state


def test_where_no_path_leads_a_part_grows_from_a_point():
    one_way = recurrent("gasket", [[1, 0, 0], [1, 1, 1], [1, 1, 1]])
    morph = Morph(SHAPES["gasket"], one_way)
    assert morph.part_of.tolist() == [0, 1, 2, 1, 2]
    assert not morph.final.linear[3:].any()
    assert morph.at(0.9, 0.9).linear[3:].any()


def test_parts_turn_as_their_map_is_wound():
    less = recurrent("square", np.ones((4, 4)) - np.diag([1, 0, 0, 0]))
    morph = Morph(SQUARE, less, winding=[1, 0, 0, 0])
    assert morph.winding.tolist() == [1, 0, 0, 0, 1]
    assert morph.part_of.tolist() == [0, 1, 2, 3, 0]


def test_parts_are_as_visible_as_their_map():
    less = recurrent("square", np.ones((4, 4)) - np.diag([1, 0, 0, 0]))
    initial, final, part_of = over_one_graph(
        replace(SQUARE, opacity=[0.5, 1, 0, 1]), replace(less, opacity=[0, 1, 1, 0.25])
    )
    assert part_of.tolist() == [0, 1, 2, 3, 0]
    assert initial.opacity.tolist() == [0.5, 1, 0, 1, 0.5]
    assert final.opacity.tolist() == [0, 1, 1, 0.25, 0]


@pytest.mark.parametrize("method", ["straight", "planned"])
def test_a_path_leads_from_one_graph_to_the_other(method):
    morph = Morph(SHAPES["gasket"], recurrent("terdragon", [[1, 1, 0], [1, 1, 1], [1, 1, 1]]))
    path = plan_path(morph, frames=40, method=method)
    for t in np.linspace(0, 1, 40):
        ifs = morph.at(*path.at(t))
        if connectedness(ifs).state == Connectedness.CONNECTED:
            assert not recurrent_in_pieces(ifs, 1 / 300, 4000)
