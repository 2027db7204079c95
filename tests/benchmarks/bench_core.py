"""What takes time when a morph is made and played. One thread, so that the figures say what the computation costs."""

import pytest

from core.cloud import point_cloud
from core.locus import compute_locus
from core.morph import Morph
from core.path import plan_path
from core.raster import fit_window, render
from core.shapes import SHAPES

PAIRS = [("turned gasket", "gasket"), ("terdragon", "gasket")]
HD = (1920, 1080)


def measure(benchmark, function, *arguments, **options):
    """Time a function three times, once its kernels are compiled."""
    benchmark.pedantic(function, arguments, options, rounds=3, warmup_rounds=1)


@pytest.mark.parametrize("resolution", [130, 511])
@pytest.mark.parametrize("initial, final", PAIRS)
def test_locus(benchmark, initial, final, resolution):
    measure(benchmark, compute_locus, Morph(SHAPES[initial], SHAPES[final]), resolution, threads=1)


@pytest.mark.parametrize("initial, final", PAIRS)
def test_path(benchmark, initial, final):
    morph = Morph(SHAPES[initial], SHAPES[final])
    measure(benchmark, plan_path, morph, compute_locus(morph), threads=1)


@pytest.mark.parametrize("mode", ["set", "density", "attractorlet"])
@pytest.mark.parametrize("shape", ["gasket", "terdragon", "Barnsley fern"])
def test_render(benchmark, shape, mode):
    ifs = SHAPES[shape]
    measure(benchmark, render, ifs, HD, fit_window(ifs, HD), mode, threads=1)


def test_point_cloud(benchmark):
    measure(benchmark, point_cloud, SHAPES["gasket"], 1_000_000, threads=1)
