"""How rendering compares with a plain chaos game and with flam3, and how its cost grows. One thread throughout."""

import math
import shutil
import subprocess
import time
from itertools import pairwise

import numpy as np
import pytest
from numba import njit

from core.affine import compose
from core.drawing import deposit, mark
from core.grammar import free_grammar
from core.ifs import IFS
from core.morph import Morph
from core.pieces import measures, outlines
from core.raster import MODES, fit_window, render
from core.shapes import SHAPES
from core.words import EVERYWHERE, cut_words, unit_maps
from tests.benchmarks.measuring import MEMORY_IS_TOLD, fastest, peak_memory

HD = (1920, 1080)
COVERAGE = 0.995
FINENESS = 0.5
"""Pieces of the exact subdivision have this diameter, in pixels, at most."""

SIDES = (256, 512, 1024, 2048, 4096)

MOST_PIECES = 100_000_000
MOST_POINTS = 128_000_000
"""Of the chaos game: where it has not covered the set by then, it is said to take at least as long."""

FLAME = """<flame name="gasket" time="0" size="1024 1024" center="0.5 0.5" scale="800" quality="{quality}"
  temporal_samples="1" estimator_radius="0" oversample="1" filter="0.5" brightness="4" gamma="4" background="0 0 0">
  <xform weight="1" color="0" linear="1" coefs="0.5 0 0 0.5 0 0"/>
  <xform weight="1" color="0.5" linear="1" coefs="0.5 0 0 0.5 0.5 0"/>
  <xform weight="1" color="1" linear="1" coefs="0.5 0 0 0.5 0.25 0.4330127"/>
  <palette count="256" format="RGB">{palette}</palette>
</flame>
"""


@njit(nogil=True)
def chaos_game(maps, table, x, y, state, count, picture):
    """Mark the pixels of `count` points of the chaos game, each map drawn from a table; a good plain one."""
    height, width = picture.shape
    for _ in range(count):
        state ^= state << np.uint64(13)
        state ^= state >> np.uint64(7)
        state ^= state << np.uint64(17)
        i = table[(state >> np.uint64(20)) & np.uint64(4095)]
        x, y = maps[i, 0] * x + maps[i, 1] * y + maps[i, 2], maps[i, 3] * x + maps[i, 4] * y + maps[i, 5]
        if 0 <= x < width and 0 <= y < height:
            picture[int(y), int(x)] = 1
    return x, y, state


@njit(nogil=True)
def subdivide(word, maps, x, y, fineness, most, picture):
    """Mark the pixels of one point (x, y) of each piece smaller than `fineness`; return how many pieces there are."""
    height, width = picture.shape
    count, top = 0, 1
    stack = np.empty((10_000, 6))
    stack[0] = word
    while top > 0 and count <= most:
        top -= 1
        a, b, e, c, d, f = stack[top]
        size = math.hypot(a + d, c - b) + math.hypot(a - d, b + c)
        if size <= fineness:
            across, along = a * x + b * y + e, c * x + d * y + f
            if 0 <= across < width and 0 <= along < height:
                picture[int(along), int(across)] = 1
            count += 1
            continue
        for i in range(maps.shape[0]):
            p, q, r, s, t, u = maps[i]
            stack[top, 0], stack[top, 1], stack[top, 2] = a * p + b * s, a * q + b * t, a * r + b * u + e
            stack[top, 3], stack[top, 4], stack[top, 5] = c * p + d * s, c * q + d * t, c * r + d * u + f
            top += 1
    return count


class View:
    """A shape in pixels, as the references want it."""

    def __init__(self, ifs, size, window=None):
        self.ifs, self.size = ifs, size
        x0, y0, x1, _ = self.window = window or fit_window(ifs, size, margin=0.0537)
        self.scale = size[0] / (x1 - x0)
        shift = (ifs.translation + ifs.linear @ (x0, y0) - (x0, y0)) * self.scale
        self.in_pixels = np.concatenate([ifs.linear, shift[..., None]], axis=-1).reshape(-1, 6)
        self.maps, center, radius = unit_maps(ifs, 1e-9)
        self.root = np.array([radius, 0.0, center[0] - x0, 0.0, radius, center[1] - y0]) * self.scale
        self.table = np.searchsorted(np.cumsum(ifs.weights), (np.arange(4096) + 0.5) / 4096)

    def exact(self, fineness=FINENESS):
        """Return the pixels of the exact subdivision, or None if it has too many pieces."""
        picture = np.zeros(self.size[::-1], np.uint8)
        x, y = np.linalg.solve(np.eye(2) - self.maps[0].reshape(2, 3)[:, :2], self.maps[0, [2, 5]])
        pieces = subdivide(self.root, self.maps, x, y, fineness, MOST_PIECES, picture)
        return picture if pieces <= MOST_PIECES else None

    def play(self, count, picture, start=None):
        """Play on from where an earlier game ended; return where this one does."""
        x, y = np.linalg.solve(np.eye(2) - self.ifs.linear[0], self.in_pixels[0, [2, 5]])
        x, y, state = start or (x, y, 88172645463325252)
        return chaos_game(self.in_pixels, self.table, x, y, np.uint64(state), count, picture)

    def points_to_cover(self, reference):
        """Return how many points the chaos game takes to find `COVERAGE` of a reference, to a tenth."""
        picture, place, count = np.zeros(self.size[::-1], np.uint8), None, 0
        while count < MOST_POINTS and covered(picture, reference) < COVERAGE:
            step = max(count // 10, 50_000)
            place = self.play(step, picture, place)
            count += step
        return count


def covered(picture, reference):
    return np.count_nonzero((picture > 0) & (reference > 0)) / np.count_nonzero(reference)


LEAST_TIMES = {"gasket": 5.0, "terdragon": 5.0}
"""How many times as fast as the chaos game to be, where that is more than one."""


@pytest.mark.parametrize("name", SHAPES)
def test_against_chaos(figure, name):
    """The set at 1920 x 1080, as 32 bit floats, against the chaos game that covers as much of it."""
    view = View(SHAPES[name], HD)
    reference = view.exact()
    picture = render(view.ifs, HD, view.window, threads=1)
    if reference is None:
        reference = picture  # What we find ourselves: nothing else is exact where so many pieces overlap.
    count = view.points_to_cover(reference)

    def chaos():
        canvas = np.zeros(HD[::-1], np.uint8)
        view.play(count, canvas)
        return canvas.astype(np.float32)

    ours = fastest(lambda: render(view.ifs, HD, view.window, threads=1))
    figure("times as fast", fastest(chaos, 2) / ours, at_least=LEAST_TIMES.get(name, 1.0))
    figure("covered", 100 * covered(picture, reference), " %", at_least=100 * COVERAGE)


@pytest.mark.parametrize(
    "initial, final", [("turned gasket", "gasket"), ("terdragon", "gasket"), ("Lévy curve", "Heighway dragon")]
)
def test_flicker(figure, initial, final):
    """Pixels that change: of a still frame, between others, and in motion over those of an exact rendering."""
    morph, size = Morph(SHAPES[initial], SHAPES[final]), (800, 600)
    norms = np.max([morph.at(t, t).norms for t in np.linspace(0, 1, 129)], axis=0)
    window = fit_window([morph.at(t, t) for t in np.linspace(0, 1, 9)], size)
    fixed_points = [morph.at(t, t).fixed_points for t in (0.4, 0.4001)]
    # Pixels that the fixed points move by on average, from t = 0 to 1.
    speed = np.linalg.norm(fixed_points[1] - fixed_points[0], axis=1).mean() / 1e-4 * size[0] / (window[2] - window[0])

    def shown(t):
        return render(morph.at(t, t), size, window, norms=norms, dtype=np.uint8)

    before, _, after = shown(0.4), shown(0.5), shown(0.4)
    figure("still, pixels changed", np.count_nonzero(before != after), at_most=0)
    for step in (0.02, 0.2):
        times = 0.4 + np.arange(5) * step / speed
        ours = [shown(t) for t in times]
        exact = [View(morph.at(t, t), size, window).exact(0.35) for t in times]
        toggles = [sum(np.count_nonzero(a != b) for a, b in pairwise(pictures)) for pictures in (ours, exact)]
        figure(f"{step} pixels a frame, over exact", toggles[0] / toggles[1], at_most=1.1)


@pytest.mark.skipif(shutil.which("flam3-render") is None, reason="flam3-render is not installed")
def test_against_flam3(figure, tmp_path):
    """Points a second of a gasket at 1024 x 1024, one thread each: what a higher quality adds in points and time."""
    palette = "\n".join("".join(f"{k:02X}{255 - k:02X}80" for k in range(row, row + 8)) for row in range(0, 256, 8))

    def seconds(quality):
        flame = tmp_path / "gasket.flame"
        flame.write_text(FLAME.format(quality=quality, palette=palette))
        options = {"in": flame, "out": tmp_path / "gasket.png", "nthreads": 1, "seed": 1, "verbose": 0}
        command = ["env", *(f"{key}={value}" for key, value in options.items()), "flam3-render"]
        started = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        return time.perf_counter() - started

    low, high = 5, 105
    theirs = (high - low) * 1024**2 / (min(seconds(high) for _ in range(2)) - min(seconds(low) for _ in range(2)))
    view = View(SHAPES["gasket"], (1024, 1024))
    figure("flam3, millions a second", theirs / 1e6)
    for mode in ("set", "density"):
        figure(f"{mode}, times as many", points_a_second(view, mode) / theirs, at_least=15)


def points_a_second(view, mode):
    """Return how many points are drawn a second, once they are there."""
    grammar, measured = free_grammar(view.ifs.weights), np.zeros(0)
    words = cut_words(view.root, view.maps, measured, 0.0, 32.0, grammar, 0, EVERYWHERE, 10**6)
    if mode == "set":
        canvas, labels = np.zeros(view.size[::-1], np.uint8), np.ones(len(words), np.uint8)
        sets = outlines(view.maps, measured, grammar, 0.125, 0.125, 32.0, 8.0)
        seconds = fastest(lambda: mark(canvas, words, labels, sets, 1), 9)
    else:
        canvas = np.zeros(view.size[::-1], np.int64)
        sets = measures(view.maps, measured, grammar, 0.125, 0.125, 32.0, 8.0)
        seconds = fastest(lambda: deposit(canvas, words, sets, 1), 9)
    return np.diff(sets.start)[sets.nearest(words)].sum() / seconds


@pytest.mark.parametrize("mode", MODES)
def test_growth_with_pixels(figure, mode):
    """Time a pixel at 4096 x 4096 over that at 256 x 256: at most 1 where cost grows linearly or less."""
    ifs = SHAPES["terdragon"]
    times = {side: fastest(lambda side=side: render(ifs, (side, side), mode=mode, threads=1), 3) for side in SIDES}
    for side in SIDES[1:]:
        figure(f"a pixel, {side}² over 256²", times[side] / times[256] * (256 / side) ** 2, at_most=1)


@pytest.mark.parametrize("mode", MODES)
def test_growth_with_maps(figure, mode):
    """Time at 1024 x 1024 of one attractor as of N maps, the words of the twindragon, over N log N; to that of two."""
    maps = letters = SHAPES["twindragon"].maps
    times = {}
    for count in (2, 4, 8, 16, 32, 64):
        ifs = IFS(maps)
        times[count] = fastest(lambda ifs=ifs: render(ifs, (1024, 1024), mode=mode, threads=1), 3)
        if count > 2:
            growth = count * math.log(count) / (2 * math.log(2))
            figure(f"{count} maps over 2, over N log N", times[count] / times[2] / growth, at_most=1)
        maps = compose(maps[:, None], letters).reshape(-1, 2, 3)


@pytest.mark.skipif(not MEMORY_IS_TOLD, reason="the system does not tell")
def test_memory(figure):
    """What rendering a set at 4096 x 4096 takes at its peak, over the size of the picture that it returns."""
    setup = """
from core.raster import render
from core.shapes import SHAPES
render(SHAPES["terdragon"], (64, 64))
"""
    peak = peak_memory(setup, 'render(SHAPES["terdragon"], (4096, 4096))')
    figure("times the picture", peak / (4 * 4096**2), at_most=4)
