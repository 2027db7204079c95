"""The cheapest route over a grid of nodes: Dijkstra's algorithm, and the clearance that keeps it off the edges."""

from __future__ import annotations

import numpy as np

from .heap import sift_down, sift_up
from .kernels import njit

STEPS = np.array([(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)])
"""The eight neighbours of a node, (row, column); step k leads back along step 7 - k."""


@njit(nogil=True, cache=True)
def clearance(inside):
    """Distance of each node to the nearest one outside, in nodes; the grid's border does not count.

    Two sweeps with the steps 1 and sqrt(2) (Borgefors 1986), at most 8% too long.

    Parameters
    ----------
    inside : (V, U) bool

    Returns
    -------
    (V, U) float64
        0 outside; infinite everywhere if no node is outside.
    """
    rows, columns = inside.shape
    far = np.empty((rows, columns))
    for row in range(rows):
        for column in range(columns):
            far[row, column] = np.inf if inside[row, column] else 0.0
    for sweep in range(2):
        for at in range(rows * columns):
            place = at if sweep == 0 else rows * columns - 1 - at
            row, column = place // columns, place % columns
            for k in range(4):
                step = k if sweep == 0 else 7 - k
                r, c = row + STEPS[step, 0], column + STEPS[step, 1]
                if 0 <= r < rows and 0 <= c < columns:
                    length = np.sqrt(float(STEPS[step, 0] ** 2 + STEPS[step, 1] ** 2))
                    far[row, column] = min(far[row, column], far[r, c] + length)
    return far


@njit(nogil=True, cache=True)
def cheapest_route(cost, closed, start, goal):
    """Nodes of the route of least cost between two nodes.

    Parameters
    ----------
    cost : (V, U) float64
        For a unit of length near each node, infinite where the route must not pass.
    closed : (V, U, 8) bool
        Steps (see `STEPS`) that must not be taken.
    start, goal : int
        Node numbers, row * U + column.

    Returns
    -------
    (K,) int64
        Node numbers from start to goal; empty if there is no route.
    """
    rows, columns = cost.shape
    nodes = rows * columns
    key = np.full(nodes, np.inf)
    back = np.full(nodes, -1, np.int64)
    done = np.zeros(nodes, np.bool_)
    # A node enters the heap anew whenever it gets cheaper; its entries hold the cost they were made with.
    entry_cost = np.empty(8 * nodes)
    entry_node = np.empty(8 * nodes, np.int64)
    order = np.empty(8 * nodes, np.int64)
    key[start] = 0.0
    entry_cost[0], entry_node[0], order[0] = 0.0, start, 0
    used = length = 1
    while length > 0:
        node = entry_node[order[0]]
        length -= 1
        order[0] = order[length]
        sift_down(order, entry_cost, length)
        if done[node]:
            continue
        done[node] = True
        if node == goal:
            break
        row, column = node // columns, node % columns
        for k in range(8):
            r, c = row + STEPS[k, 0], column + STEPS[k, 1]
            if not (0 <= r < rows and 0 <= c < columns) or closed[row, column, k]:
                continue
            there = r * columns + c
            span = np.sqrt(float(STEPS[k, 0] ** 2 + STEPS[k, 1] ** 2))
            total = key[node] + span * (cost[row, column] + cost[r, c]) / 2
            if total < key[there]:
                key[there], back[there] = total, node
                entry_cost[used], entry_node[used], order[length] = total, there, used
                used += 1
                length += 1
                sift_up(order, entry_cost, length - 1)
    if key[goal] == np.inf:
        return np.empty(0, np.int64)
    count = 1
    node = goal
    while node != start:
        node = back[node]
        count += 1
    route = np.empty(count, np.int64)
    node = goal
    for k in range(count - 1, -1, -1):
        route[k] = node
        node = back[node]
    return route
