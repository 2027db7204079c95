"""How fast and how sure the connectedness locus is, beside the paper's algorithm and brute force."""

import time

import numpy as np
import pytest

from core import parallel
from core.connectedness import Connectedness, connectedness, index_buffer
from core.ifs import IFS
from core.locus import compute_locus, nodes
from core.morph import Morph
from core.shapes import SHAPES
from tests.benchmarks.measuring import MEMORY_IS_TOLD, fastest, peak_memory
from tests.core.reference import dense, linkage

TOLERANCE = 1 / 300
RESOLUTION = 511
ROWS_APART = 16
"""The index buffer is timed on one row in so many, and its time is scaled."""


def pair(initial, final, pairing=None):
    """Return the morph of two shapes of the library; map i becomes map pairing[i]."""
    ends = SHAPES[final]
    if pairing is not None:
        ends = IFS(ends.maps[pairing], ends.weights[pairing], ends.name)
    return Morph(SHAPES[initial], ends)


SIMILARITIES = {
    "turned gasket to gasket": pair("turned gasket", "gasket"),
    "terdragon to gasket": pair("terdragon", "gasket"),
    "terdragon to gasket (0,2,1)": pair("terdragon", "gasket", [0, 2, 1]),
}
PAIRS = {
    **SIMILARITIES,
    "Barnsley fern to maple leaf": pair("Barnsley fern", "maple leaf"),
    "Heighway dragon to Lévy curve": pair("Heighway dragon", "Lévy curve"),
}


def seconds_of_index_buffers(morph):
    """Return what the paper's algorithm takes for all nodes, with a window of 300 x 300 and 3e5 points each at most.

    Only its own work counts, not what making an IFS in Python costs.
    """
    u, v = nodes(RESOLUTION)
    total = 0.0
    for iterations, sign in ((300_000, 1), (1, -1)):
        index_buffer(morph.initial, 300, iterations)
        # What does not depend on the shape is known well enough from a few.
        rows = v[:: ROWS_APART if sign > 0 else 4 * ROWS_APART]
        started = time.process_time()
        for along in rows:
            for across in u:
                index_buffer(morph.at(across, along), 300, iterations)
        total += sign * (time.process_time() - started) * len(v) / len(rows)
    return total


@pytest.mark.parametrize("name", SIMILARITIES)
def test_against_the_index_buffer(figure, name):
    """One thread each, 511 x 511 nodes."""
    morph = PAIRS[name]
    states, both = (
        fastest(lambda gap=gap: compute_locus(morph, RESOLUTION, TOLERANCE, threads=1, gap=gap), 2, time.process_time)
        for gap in (False, True)
    )
    theirs = seconds_of_index_buffers(morph)
    figure("the index buffer takes", theirs, " s")
    figure("states", states, " s")
    figure("states and gaps", both, " s")
    figure("times as fast, states", theirs / states, at_least=150)
    figure("times as fast, with gaps", theirs / both)


@pytest.mark.parametrize("name", SIMILARITIES)
def test_growth(figure, name):
    """Time of 130 x 130 nodes over that of 511 x 511, and of one thread over that of two."""
    morph = PAIRS[name]
    for what, gap in (("states", False), ("with gaps", True)):
        large = fastest(lambda gap=gap: compute_locus(morph, RESOLUTION, threads=1, gap=gap), 3)
        small = fastest(lambda gap=gap: compute_locus(morph, 130, threads=1, gap=gap), 5)
        figure(f"130 over 511, {what}", small / large, at_most=1 / 8)
        if parallel.thread_count() > 1:
            two = fastest(lambda gap=gap: compute_locus(morph, RESOLUTION, threads=2, gap=gap), 3)
            figure(f"one thread over two, {what}", large / two, at_least=1.5)


@pytest.mark.parametrize("name", PAIRS)
def test_certainty(figure, name):
    """Verdicts at 500 random (u,v) against the distances of points, and what is left open in the whole locus."""
    morph = PAIRS[name]
    refuted = 0
    for u, v in np.random.default_rng(7).uniform(-1, 2, (500, 2)):
        ifs = morph.at(u, v)
        verdict = connectedness(ifs, TOLERANCE)
        if verdict.state not in (Connectedness.CONNECTED, Connectedness.DISCONNECTED):
            continue
        points, letters, spacing = dense(ifs.maps, 4000)
        gap, diameter = linkage(points, letters, ifs.count), 2 * ifs.enclosing_disc[1]
        refuted += verdict.gap[0] * diameter > gap * (1 + 1e-9) + 1e-12 * diameter
        refuted += gap - 2 * spacing > verdict.gap[1] * diameter * (1 + 1e-9)
    locus = compute_locus(morph, RESOLUTION if name in SIMILARITIES else 256, TOLERANCE, gap=False)
    figure("verdicts refuted", refuted, at_most=0)
    open_share = 100 * locus.share(Connectedness.UNDECIDED)
    figure("undecided", open_share, " %", at_most=0.01 if name in SIMILARITIES else 3)


def test_smallest_connected_gasket(figure):
    """The paper's Table 1: by theory the Sierpinski family is connected from the scale 1/2 on."""

    def family(scale):
        corners = np.array([(0, 0), (1, 0), (0.5, 3**0.5 / 2)])
        return IFS([[[scale, 0, (1 - scale) * x], [0, scale, (1 - scale) * y]] for x, y in corners])

    for tolerance, most in ((1 / 75, None), (1 / 600, None), (1e-9, 1e-9)):
        low, high = 0.4, 0.6
        while high - low > 1e-13:
            middle = (low + high) / 2
            connected = connectedness(family(middle), tolerance).state == Connectedness.CONNECTED
            low, high = (low, middle) if connected else (middle, high)
        figure(f"off at tolerance {tolerance:.2g}, 1e-9", abs(high - 0.5) * 1e9, at_most=most and most * 1e9)


@pytest.mark.skipif(not MEMORY_IS_TOLD, reason="only Linux tells")
def test_memory(figure):
    """Peak of a locus with gaps at 1022 nodes a side."""
    setup = """
from core.locus import compute_locus
from core.morph import Morph
from core.shapes import SHAPES
morph = Morph(SHAPES["turned gasket"], SHAPES["gasket"])
compute_locus(morph, 13)
"""
    figure("1022 nodes a side", peak_memory(setup, "locus = compute_locus(morph, 1022)") / 1e6, " MB", at_most=300)
