"""flam3 itself as the reference: the shape that is read covers the pixels of the picture that flam3 draws.

Needs flam3-render (on Debian: ``apt install flam3-utils``); skipped, with that advice, where there is none.
"""

import os
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import maximum_filter

from core.formats import read_text, write_text
from core.formats.entry import Entry
from core.raster import render
from core.shapes import SHAPES

WIDTH, HEIGHT, SCALE = 200, 150, 40.0
CENTER = (0.25, -0.5)

PALETTE = "".join(f'<color index="{k}" rgb="255 255 255"/>' for k in range(256))

FLAG = (
    '<xform weight="0.4" linear="1" coefs="0.5 0.1 -0.2 0.4 0.7 -0.3"/>'
    '<xform weight="0.3" linear="1" coefs="0.3 0 0 -0.6 -0.9 0.2"/>'
    '<xform weight="0.3" linear="1" coefs="0.2 0.4 -0.5 0.2 0.1 0.8"/>'
)

FLAMES = {
    "coefs": FLAG,
    "post": FLAG.replace("/>", ' post="0.9 0.1 -0.3 0.8 0.2 -0.4"/>', 1),
    "weight of linear": FLAG.replace('linear="1"', 'linear="-0.8"', 2),
    "old lists": FLAG.replace('linear="1"', 'var1="0"', 1).replace('linear="1"', f'var="0.9{" 0" * 98}"', 1),
    "final": FLAG + '<finalxform linear="0.7" coefs="0.8 0.5 -0.2 1.1 0.3 -0.6" post="1 0 0.4 1 0 0.1"/>',
    "turns": FLAG + '<symmetry kind="3"/>',
    "mirror": FLAG + '<symmetry kind="-1"/>',
    "turns and mirror": FLAG + '<symmetry kind="-4"/>',
    "turns as maps": FLAG + '<xform weight="0.5" symmetry="1" linear="1" coefs="0.5 0.866025 -0.866025 0.5 0 0"/>',
    "chaos": FLAG.replace("/>", ' chaos="0 1 2"/>', 1).replace('0.2"/>', '0.2" chaos="2 0.5 1"/>', 1),
    "hidden": FLAG.replace("/>", ' opacity="0"/>', 1),
    "hidden by plotmode": FLAG.replace("/>", ' plotmode="off"/>', 2),
    "hidden and turns": FLAG.replace("/>", ' opacity="0"/>', 1) + '<symmetry kind="3"/>',
    "hidden turns": FLAG + '<xform weight="0.5" symmetry="1" opacity="0" linear="1" coefs="-1 0 0 -1 0 0"/>',
    "hidden and chaos": FLAG.replace("/>", ' chaos="0 1 2"/>', 1).replace('0.2"/>', '0.2" opacity="0"/>', 1),
    "no weight": FLAG + '<xform weight="0" linear="1" coefs="0.5 0 0 0.5 2 2"/>',
}

HIDDEN = [kind for kind in FLAMES if "hidden" in kind]


@pytest.fixture(scope="module")
def draw(tmp_path_factory):
    """Return a function from a flame to the brightness of flam3's pixels, row 0 at the bottom."""
    if shutil.which("flam3-render") is None:
        pytest.skip("THE FLAME READER IS NOT COMPARED WITH FLAM3: there is no flam3-render; apt install flam3-utils")
    from PIL import Image

    folder = tmp_path_factory.mktemp("flam3")

    def drawn(flame):
        picture = folder / "picture.png"
        settings = {"out": str(picture), "format": "png", "isaac_seed": "reproducible", "nthreads": "1", "verbose": "0"}
        subprocess.run(
            ["flam3-render"], input=flame, text=True, env={**os.environ, **settings}, check=True, capture_output=True
        )
        with Image.open(picture) as image:
            return np.asarray(image.convert("L"))[::-1].astype(int)

    return drawn


def flame_of(transforms):
    """Return a flame that flam3 draws without softening anything."""
    return (
        f'<flame name="a" size="{WIDTH} {HEIGHT}" center="{CENTER[0]} {CENTER[1]}" scale="{SCALE}" oversample="1" '
        'filter="0.01" filter_shape="box" quality="300" passes="1" estimator_radius="0" background="0 0 0" '
        f'brightness="100" gamma="1" gamma_threshold="0">{transforms}{PALETTE}</flame>'
    )


def window():
    """Return the part of the plane, y up, that the flame's camera shows."""
    reach = np.array([WIDTH, HEIGHT]) / SCALE / 2
    x, y = CENTER[0], -CENTER[1]
    return (x - reach[0], y - reach[1], x + reach[0], y + reach[1])


def assert_same_pixels(flam3, ifs):
    """All that flam3 draws lies within a pixel of the shape, and the shape near what flam3 draws.

    flam3 draws at random, so it leaves out a few pixels that are seldom met.
    """
    ours = render(ifs, (WIDTH, HEIGHT), window()) > 0
    theirs = flam3 > 0
    assert theirs.sum() > 500
    assert not (theirs & ~maximum_filter(ours, 3)).any()
    assert (ours & ~maximum_filter(theirs, 3)).sum() <= 0.02 * ours.sum()


@pytest.mark.parametrize("kind", FLAMES)
def test_shape_covers_the_picture_of_flam3(draw, kind):
    flame = flame_of(FLAMES[kind])
    (ifs,) = read_text(flame).shapes.values()
    assert_same_pixels(draw(flame), ifs)


@pytest.mark.parametrize("kind", HIDDEN)
def test_what_is_hidden_would_be_missed(draw, kind):
    flame = flame_of(FLAMES[kind])
    (ifs,) = read_text(flame).shapes.values()
    assert not (ifs.opacity == 1).all()
    if kind != "hidden and turns":  # There the turned copies are drawn, and with them all.
        with pytest.raises(AssertionError):
            assert_same_pixels(draw(flame), replace(ifs, opacity=None))


@pytest.mark.parametrize("mistake", ["mirrored", "transposed"])
def test_a_mistaken_reading_would_be_noticed(draw, mistake):
    flame = flame_of(FLAMES["coefs"])
    (ifs,) = read_text(flame).shapes.values()
    maps = ifs.maps.copy()
    if mistake == "mirrored":
        maps *= [[1, -1, 1], [-1, 1, -1]]
    else:
        maps[:, [0, 1], [1, 0]] = maps[:, [1, 0], [0, 1]]
    with pytest.raises(AssertionError):
        assert_same_pixels(draw(flame), type(ifs)(maps))


@pytest.mark.parametrize("kind", ["coefs", "turns", "turns and mirror", "turns as maps", "chaos", *HIDDEN])
def test_measure_is_that_of_flam3(draw, kind):
    """The brightness that flam3 gives to each part of the picture, against the measure of the maps that were read."""
    flame = flame_of(FLAMES[kind]).replace('brightness="100"', 'brightness="4"')
    (ifs,) = read_text(flame).shapes.values()
    density = render(ifs, (WIDTH, HEIGHT), window(), mode="density", samples=1_000_000).astype(float)
    # With its gamma at 1 flam3's brightness is the logarithm of the density.
    ours = np.log1p(density / density.mean())
    assert np.corrcoef(ours.ravel(), draw(flame).ravel())[0, 1] > 0.9


def test_what_is_written_is_drawn_as_it_was(draw):
    """flam3 draws a shape that was written, within the camera that was written with it."""
    fern = SHAPES["Barnsley fern"]
    text = write_text([Entry("fern", fern.maps, fern.weights)], ".flame")
    brightness = draw(text)
    assert brightness.shape == (480, 640)
    columns, rows = np.flatnonzero(brightness.any(axis=0)), np.flatnonzero(brightness.any(axis=1))
    assert 400 < rows[-1] - rows[0] < 470
    assert columns[0] > 5
    assert columns[-1] < 635
    lower, upper = np.array_split((brightness > 0).sum(axis=1)[rows[0] : rows[-1]], 2)
    assert lower.sum() > 1.2 * upper.sum(), "the tip points up"
