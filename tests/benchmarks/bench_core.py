"""What takes time when a morph is made and played. One thread, so that the figures say what the computation costs."""

import pytest

from core.cloud import point_cloud
from core.locus import compute_locus
from core.morph import Morph
from core.path import plan_path
from core.raster import MODES, fit_window, render
from core.shapes import SHAPES
from tests.benchmarks.measuring import fastest

PAIRS = [("turned gasket", "gasket"), ("terdragon", "gasket")]
HD = (1920, 1080)


def measure(figure, name, function, *arguments, **options):
    figure(name, 1e3 * fastest(lambda: function(*arguments, **options), 3), " ms")


@pytest.mark.parametrize("initial, final", PAIRS)
def test_path(figure, initial, final):
    morph = Morph(SHAPES[initial], SHAPES[final])
    for resolution in (130, 511):
        measure(figure, f"locus {resolution}", compute_locus, morph, resolution, threads=1)
    measure(figure, "path", plan_path, morph, compute_locus(morph), threads=1)


@pytest.mark.parametrize("shape", ["gasket", "terdragon", "Barnsley fern"])
def test_render(figure, shape):
    ifs = SHAPES[shape]
    for mode in MODES:
        measure(figure, mode, render, ifs, HD, fit_window(ifs, HD), mode, threads=1)


def test_point_cloud(figure):
    measure(figure, "one million points", point_cloud, SHAPES["gasket"], 1_000_000, threads=1)
