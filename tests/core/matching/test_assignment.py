"""The assignment is that of an independent implementation."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linear_sum_assignment

from core.matching.assignment import assign


@given(st.integers(1, 12), st.integers(0, 10**6), st.booleans())
def test_no_assignment_costs_less(count, seed, whole):
    random = np.random.default_rng(seed)
    cost = random.integers(0, 5, (count, count)).astype(float) if whole else random.normal(size=(count, count))
    found = assign(cost)
    assert sorted(found) == list(range(count))
    assert np.isclose(cost[np.arange(count), found].sum(), cost[linear_sum_assignment(cost)].sum())
