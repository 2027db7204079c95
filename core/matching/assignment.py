"""The assignment of least total cost: the Hungarian method."""

from __future__ import annotations

import numpy as np


def assign(cost: np.ndarray) -> np.ndarray:
    """For each row the column (N,) that makes the total least, each column once (Kuhn 1955; Jonker & Volgenant 1987).

    Rows enter one by one, each by the cheapest chain of reassignments, found by Dijkstra's algorithm on costs that the
    potentials of rows and columns keep from being negative.

    Parameters
    ----------
    cost : (N, N)
        Finite.
    """
    count = len(cost)
    rows, columns = np.zeros(count + 1), np.zeros(count + 1)
    # Column `count` stands for none; it holds the row that is to enter.
    owner = np.full(count + 1, -1)
    for row in range(count):
        owner[count] = row
        column = count
        least, back = np.full(count, np.inf), np.full(count, count)
        seen = np.zeros(count + 1, dtype=bool)
        while owner[column] >= 0:
            seen[column] = True
            at = owner[column]
            reduced = cost[at] - rows[at] - columns[:count]
            shorter = ~seen[:count] & (reduced < least)
            least[shorter], back[shorter] = reduced[shorter], column
            open_least = np.where(seen[:count], np.inf, least)
            following = int(np.argmin(open_least))
            step = open_least[following]
            rows[owner[seen]] += step
            columns[seen] -= step
            least[~seen[:count]] -= step
            column = following
        while column != count:
            owner[column] = owner[back[column]]
            column = back[column]
    found = np.empty(count, dtype=int)
    found[owner[:count]] = np.arange(count)
    return found
