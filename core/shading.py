"""Rendered attractors to colors: palettes, tone mapping, color ramps, antialiasing.

Colors are scene linear. A raster becomes indices into a table of colors, and the table is averaged over the samples of
each pixel; so the three modes share one kernel, and no picture of samples in full color is ever held.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from . import parallel
from .raster import TOTAL_MASS

CURVES = ("log", "gamma", "linear")

WHITE = 48.0
"""Density that becomes white at exposure 0, as a multiple of that of a measure spread evenly over the picture."""

LEVELS = 1024
"""Steps of a color ramp."""

ROWS = 64
"""Rows of pixels shaded in one chunk of work."""

GOLDEN_RATIO = (1 + 5**0.5) / 2

Stops = tuple[tuple[float, tuple[float, float, float, float]], ...]

PALETTES: dict[str, Stops] = {
    "fire": (
        (0.0, (0.02, 0.0, 0.01, 1.0)),
        (0.3, (0.35, 0.02, 0.01, 1.0)),
        (0.65, (0.95, 0.28, 0.02, 1.0)),
        (1.0, (1.0, 0.95, 0.6, 1.0)),
    ),
    "ice": (
        (0.0, (0.0, 0.005, 0.03, 1.0)),
        (0.4, (0.01, 0.1, 0.4, 1.0)),
        (0.75, (0.12, 0.6, 0.9, 1.0)),
        (1.0, (0.9, 1.0, 1.0, 1.0)),
    ),
    "forest": (
        (0.0, (0.002, 0.012, 0.004, 1.0)),
        (0.45, (0.02, 0.2, 0.03, 1.0)),
        (0.8, (0.35, 0.65, 0.08, 1.0)),
        (1.0, (1.0, 1.0, 0.55, 1.0)),
    ),
    "gray": ((0.0, (0.0, 0.0, 0.0, 1.0)), (1.0, (1.0, 1.0, 1.0, 1.0))),
}
"""Color ramps from thin to dense: positions in [0, 1] and their colors."""


def attractorlet_colors(count: int) -> np.ndarray:
    """Colors (count, 4) that tell attractorlets apart: hues a golden angle from one another, of about one lightness."""
    hue = (0.02 + np.arange(count) / GOLDEN_RATIO) % 1.0
    # Each channel is a raised cosine about its own hue.
    channels = 0.5 + 0.5 * np.cos(2 * np.pi * (hue[:, None] - np.array([0.0, 1 / 3, 2 / 3])))
    encoded = 0.18 + 0.8 * channels
    return np.column_stack([encoded**2.2, np.ones(count)]).astype(np.float32)


def tone_map(density: np.ndarray, curve: str = "log", exposure: float = 0.0, gamma: float = 2.2) -> np.ndarray:
    """Density to brightness.

    The density is taken relative to that of the whole measure spread evenly over the picture, not to the densest pixel
    of the frame: so brightness does not flicker, and does not depend on the number of samples.

    Parameters
    ----------
    density : (H, W)
        From `raster.render`; `raster.TOTAL_MASS` is the whole attractor.
    curve : str
        "log" shows thin and dense parts alike, "gamma" is a power, "linear" is the density itself.
    exposure : float
        In stops.
    gamma : float
        Brightness is raised to 1 / gamma, but for "linear".

    Returns
    -------
    (H, W) float32
        In [0, 1].

    Raises
    ------
    ValueError
        If there is no such curve or gamma is not above 0.
    """
    if curve not in CURVES:
        raise ValueError(f"There is no curve “{curve}”; choose one of {', '.join(CURVES)}.")
    if not gamma > 0:
        raise ValueError(f"Gamma is {gamma:g}; it must be above 0.")
    relative = density.astype(np.float32) * np.float32(2.0**exposure * density.size / TOTAL_MASS)
    bright = np.log1p(relative) / np.float32(np.log1p(WHITE)) if curve == "log" else relative / np.float32(WHITE)
    if curve != "linear":
        bright **= np.float32(1 / gamma)
    return np.minimum(bright, np.float32(1.0))


def ramp_colors(stops: Stops, count: int = LEVELS) -> np.ndarray:
    """Colors (count, 4) of a ramp, evenly spaced and interpolated linearly between stops."""
    positions = np.array([position for position, _ in stops])
    colors = np.array([color for _, color in stops])
    places = np.linspace(0, 1, count)
    return np.stack([np.interp(places, positions, colors[:, k]) for k in range(4)], axis=1).astype(np.float32)


def shade(
    picture: np.ndarray,
    colors: np.ndarray,
    background: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0),
    factor: int = 1,
    threads: int | None = None,
) -> np.ndarray:
    """Color a picture of samples and average the samples of each pixel.

    Parameters
    ----------
    picture : (factor * H, factor * W)
        *Set* or *attractorlet* pictures of `raster.render`: 0 for the background, i for color i - 1. Or brightness in
        [0, 1] from `tone_map`, float32, with colors (K, 4), K > 1, as from `ramp_colors`; 0 is the background.
    colors : (K, 4)
        Straight alpha.
    background : (4,)
        Straight alpha.
    factor : int
        Samples along each side of a pixel: the antialiasing.

    Returns
    -------
    (H, W, 4) float32
        Color times alpha, and alpha, which is how Blender takes an image with premultiplied alpha. Row 0 is the lowest.

    Raises
    ------
    ValueError
        If the picture cannot be divided by the factor.
    """
    height, width = picture.shape
    if factor < 1 or height % factor or width % factor:
        raise ValueError(f"A picture of {width} x {height} samples does not divide into pixels of {factor} x {factor}.")
    table = np.empty((len(colors) + 1, 4), dtype=np.float32)
    table[0], table[1:] = background, colors
    table[:, :3] *= table[:, 3:]
    table[1:] += (1 - table[1:, 3:]) * table[0]
    if picture.dtype == np.float32 and len(colors) > 1:
        # Any density at all is above the background, however thin.
        indices = np.ceil(picture * np.float32(len(colors) - 1)).astype(np.uint16)
        indices += picture > 0
    else:
        indices = picture.astype(np.uint16)
    result = np.empty((height // factor, width // factor, 4), dtype=np.float32)
    starts = range(0, len(result), ROWS)
    parallel.run(lambda start: average(indices, table, factor, start, start + ROWS, result), starts, threads)
    return result


@njit(nogil=True, cache=True)
def average(indices, table, factor, first_row, last_row, result):
    """Mean color of factor x factor samples for each pixel of some rows."""
    share = np.float32(1.0 / (factor * factor))
    for row in range(first_row, min(last_row, result.shape[0])):
        for column in range(result.shape[1]):
            red = green = blue = alpha = np.float32(0.0)
            for y in range(row * factor, (row + 1) * factor):
                for x in range(column * factor, (column + 1) * factor):
                    color = table[indices[y, x]]
                    red += color[0]
                    green += color[1]
                    blue += color[2]
                    alpha += color[3]
            pixel = result[row, column]
            pixel[0], pixel[1], pixel[2], pixel[3] = red * share, green * share, blue * share, alpha * share
