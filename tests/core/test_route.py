"""The cheapest route and the clearance, against scipy's shortest paths and distance transform."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import distance_transform_edt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from core.route import STEPS, cheapest_route, clearance

seeds = st.integers(0, 2**32 - 1)
sizes = st.tuples(st.integers(1, 16), st.integers(1, 16))


def edges(cost, closed):
    """Every step between two open nodes: from, to, and what it costs."""
    rows, columns = cost.shape
    found = []
    for row in range(rows):
        for column in range(columns):
            for k, (down, across) in enumerate(STEPS):
                r, c = row + down, column + across
                if 0 <= r < rows and 0 <= c < columns and not closed[row, column, k]:
                    length = np.hypot(down, across) * (cost[row, column] + cost[r, c]) / 2
                    if np.isfinite(length):
                        found.append((row * columns + column, r * columns + c, length))
    return found


def least_cost(cost, closed, start, goal):
    if start == goal:
        return 0.0
    nodes = cost.size
    found = edges(cost, closed)
    if not found:
        return np.inf
    one, other, length = zip(*found, strict=True)
    return dijkstra(coo_array((length, (one, other)), shape=(nodes, nodes)).tocsr(), indices=start)[goal]


def random_grid(seed, size, walls):
    random = np.random.default_rng(seed)
    cost = random.uniform(0.1, 10, size)
    cost[random.uniform(size=size) < walls] = np.inf
    closed = random.uniform(size=(*size, 8)) < walls / 2
    start, goal = random.integers(cost.size, size=2)
    return cost, closed, int(start), int(goal)


def test_a_step_leads_back_along_seven_minus_it():
    assert np.array_equal(STEPS[::-1], -STEPS)
    assert len({tuple(step) for step in STEPS}) == 8


@given(seeds, sizes, st.sampled_from([0.0, 0.2, 0.4]))
@settings(max_examples=80)
def test_the_route_costs_the_least(seed, size, walls):
    cost, closed, start, goal = random_grid(seed, size, walls)
    # The ends themselves may be walls too; then there is no route but from a node to itself.
    route = cheapest_route(cost, closed, start, goal)
    expected = least_cost(cost, closed, start, goal)
    if not np.isfinite(expected):
        assert len(route) == 0
        return
    assert route[0] == start
    assert route[-1] == goal
    lengths = {(one, other): length for one, other, length in edges(cost, closed)}
    # Every step is an open one: it would not be among the edges else.
    total = sum(lengths[int(one), int(other)] for one, other in pairwise(route))
    assert total == pytest.approx(expected, rel=1e-12)
    assert len(set(route.tolist())) == len(route)


def test_a_wall_with_one_door():
    cost = np.ones((41, 41))
    cost[20, :] = np.inf
    cost[20, 3] = 1.0
    route = cheapest_route(cost, np.zeros((41, 41, 8), dtype=bool), 20, 40 * 41 + 20)
    assert 20 * 41 + 3 in route
    cost[20, 3] = np.inf
    assert len(cheapest_route(cost, np.zeros((41, 41, 8), dtype=bool), 20, 40 * 41 + 20)) == 0


def test_a_closed_step_is_closed_one_way():
    cost = np.ones((1, 3))
    closed = np.zeros((1, 3, 8), dtype=bool)
    closed[0, 1, 4] = True
    assert len(cheapest_route(cost, closed, 0, 2)) == 0
    assert cheapest_route(cost, closed, 2, 0).tolist() == [2, 1, 0]


def test_large_grids_fit_their_heap():
    random = np.random.default_rng(0)
    # Costs that fall along the way make every node cheaper again and again.
    cost = np.linspace(1000, 1, 300)[:, None] * random.uniform(0.9, 1.1, (300, 300))
    route = cheapest_route(cost, np.zeros((300, 300, 8), dtype=bool), 0, 300 * 300 - 1)
    assert route[-1] == 300 * 300 - 1
    assert len(route) >= 300


@given(seeds, sizes, st.floats(0, 1))
@settings(max_examples=80)
def test_clearance_is_the_distance_to_the_nearest_outside(seed, size, share):
    inside = np.random.default_rng(seed).uniform(size=size) < share
    found = clearance(inside)
    if inside.all():
        assert np.isinf(found).all()
        return
    exact = distance_transform_edt(inside)
    assert (found >= exact * (1 - 1e-12)).all()
    assert (found <= exact * 1.083).all()
    assert np.array_equal(found == 0, ~inside)


def test_clearance_of_wide_rooms():
    inside = np.ones((60, 90), dtype=bool)
    inside[10, 20] = inside[50, 80] = False
    exact = distance_transform_edt(inside)
    found = clearance(inside)
    assert (found >= exact - 1e-9).all()
    assert (found <= exact * 1.0824 + 1e-9).all()
    # The bound is met: nowhere better would mean that the reference is not the same thing.
    assert (found / np.maximum(exact, 1e-9)).max() > 1.08
