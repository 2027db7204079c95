"""The outer polygon: what it bounds must hold for points of the attractor."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.polygon import directions_seen, outer_polygon, polygon_distance
from core.shapes import SHAPES
from tests.core import reference
from tests.core.random_maps import grown, random_ifs, unit_maps

seeds = st.integers(0, 2**32 - 1)


def rows(ifs):
    return np.ascontiguousarray(ifs.linear).reshape(-1, 4), np.ascontiguousarray(ifs.translation)


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("directions", [4, 16, 64])
def test_the_outer_polygon_holds_the_attractor_and_touches_it(name, directions):
    ifs = SHAPES[name]
    center, radius = ifs.enclosing_disc
    linear, _ = rows(ifs)
    translation = np.ascontiguousarray(ifs.translation + ifs.linear @ center - center)
    reach, corners = outer_polygon(linear, translation, radius, directions, 1e-9 * radius)
    angles = 2 * np.pi * np.arange(directions) / directions
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    points, _, spacing = reference.dense(ifs.maps)
    along = (points - center) @ normals.T
    assert (along <= reach + 1e-12 * radius).all()
    # Between neighbouring normals lie the corners.
    assert (corners * normals).sum(axis=1) == pytest.approx(reach, abs=1e-12 * radius)
    assert (corners * np.roll(normals, -1, axis=0)).sum(axis=1) == pytest.approx(np.roll(reach, -1), abs=1e-12 * radius)
    if directions == 64:
        assert (reach - along.max(axis=0)).max() <= spacing + 0.08 * radius


@given(seeds)
@settings(max_examples=40)
def test_the_outer_polygon_is_an_enclosure_at_every_step(seed):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(3, 2, 2))
    linear *= (random.uniform(0.2, 0.85, 3) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    maps = np.concatenate([linear, random.normal(size=(3, 2, 1))], axis=-1)
    points, _, _ = reference.dense(maps, 2000)
    radius = np.linalg.norm(points, axis=1).max() * 1.01
    # Such a disc holds the attractor although some maps lead out of it.
    for tolerance in (1.0, 0.1, 1e-4):
        reach, _ = outer_polygon(
            linear.reshape(-1, 4), np.ascontiguousarray(maps[:, :, 2]), radius, 16, tolerance * radius
        )
        angles = 2 * np.pi * np.arange(16) / 16
        assert (points @ np.stack([np.cos(angles), np.sin(angles)]) <= reach + 1e-12 * radius).all()


@given(seeds, st.integers(3, 40))
def test_shares_put_a_turned_direction_together_again(seed, directions):
    linear = np.random.default_rng(seed).normal(size=(2, 2, 2))
    normal, sector, share = directions_seen(linear.reshape(-1, 4), directions)
    assert (share >= 0).all()
    between = share[..., :1] * normal[sector] + share[..., 1:] * normal[(sector + 1) % directions]
    seen = np.einsum("kx,ixy->iky", normal, linear)
    assert between == pytest.approx(seen, abs=1e-13)


@given(seeds)
@settings(max_examples=60)
def test_polygons_are_never_further_apart_than_their_points(seed):
    random = np.random.default_rng(seed)
    linear, unit = unit_maps(random_ifs(seed))
    _, corners = outer_polygon(linear, unit, 1.0, 16, 1e-3)
    maps = np.concatenate([linear.reshape(-1, 2, 2), unit[..., None]], axis=-1)
    points, _, _ = reference.dense(maps, 400)
    words = [random.integers(3, size=random.integers(2, 5)).tolist() for _ in range(2)]
    tree, (one, other) = grown(linear, unit, words)
    pieces = [points @ row[:4].reshape(2, 2).T + row[4:6] for row in tree.word[[one, other]]]
    nearest = np.linalg.norm(pieces[0][:, None] - pieces[1][None], axis=-1).min()
    apart = tree.word[other, 4:6] - tree.word[one, 4:6]
    for steps in (1, 4, 12):
        found = polygon_distance(tree.word, one, other, *apart, corners, np.inf, steps)
        assert found <= nearest + 1e-12
        # Stopping early may only give a lower bound that is enough.
        early = polygon_distance(tree.word, one, other, *apart, corners, 0.0, steps)
        assert early <= nearest + 1e-12
        assert (early > 0) == (found > 0)


@pytest.mark.parametrize("shift", [0.5, 1.999, 2.001, 3.0])
def test_polygons_of_two_squares(shift):
    corners = np.array([[1.0, 1], [-1, 1], [-1, -1], [1, -1]])
    words = np.array([[1.0, 0, 0, 1, 0, 0, 0, 0, 1], [1.0, 0, 0, 1, shift, 0, 0, 0, 1]])
    found = polygon_distance(words, 0, 1, shift, 0.0, corners, np.inf, 4)
    assert found <= max(shift - 2, 0) + 1e-12
    assert (found > 0) == (shift > 2)
