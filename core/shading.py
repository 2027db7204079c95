"""Pictures to colours: tone mapping of density, colour ramps, attractorlet colours, antialiasing.

All colours are scene linear RGB, as in Blender's float images, and have straight alpha unless said. Antialiasing means
to render more pixels than are shown, and to take the mean of each square of them here.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from . import parallel
from .kernels import njit
from .raster import TOTAL_MASS

CURVES = ("log", "gamma", "linear")

WHITE = 32.0
"""Density that is shown at full brightness, as a multiple of what it would be were the attractor spread evenly over the
picture. So brightness depends neither on the picture's size or samples nor on the frame's maximum, which flickers."""

RAMP_ENTRIES = 256

SHADES = 4096
"""Colours that a ramp is drawn with; neighbours are too much alike to tell."""

Stops = Sequence[tuple[float, Sequence[float]]]


def _linear(code: str, alpha: float = 1.0) -> tuple[float, float, float, float]:
    """A scene linear colour from the usual six hexadecimal digits, which mean sRGB (IEC 61966-2-1)."""
    values = np.array([int(code[k : k + 2], 16) for k in (0, 2, 4)]) / 255
    values = np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)
    return (*values.round(5).tolist(), alpha)


def _palette(*codes: str) -> Stops:
    """Evenly spaced colours that start from transparency."""
    last = len(codes) - 1
    return tuple((k / last, _linear(code, float(k > 0))) for k, code in enumerate(codes))


PALETTES: dict[str, Stops] = {
    "fire": _palette("1a0500", "5c0f0a", "c2360c", "f58a1f", "ffd36b", "fff8e1"),
    "ice": _palette("01060f", "0b2a5b", "1f63a8", "4ea9dd", "a9e1f5", "f6feff"),
    "leaf": _palette("020a03", "0d3b1c", "2f7a2d", "74b43c", "c6e070", "fbffe0"),
    "dusk": _palette("05010d", "2b1055", "7b2a80", "d1495b", "f2a65a", "fff1d0"),
    "gold": _palette("080602", "3d2a0a", "8a6414", "c9a02c", "efd98a", "fffbea"),
    "silver": _palette("000000", "2b2b2f", "66686e", "a2a5ab", "d9dbdf", "ffffff"),
}
"""Colour ramps by name: stops (position in [0, 1], (r, g, b, a)) from none, which is transparent, to dense."""


def attractorlet_colors(count: int) -> np.ndarray:
    """Colours (count, 4) that are easy to tell apart and equally light: hues a golden angle apart.

    Equal in lightness and chroma by Oklab (Ottosson 2020).
    """
    angle = np.arange(count) * np.pi * (3 - np.sqrt(5)) + 0.5
    lab = np.stack([np.full(count, 0.74), 0.13 * np.cos(angle), 0.13 * np.sin(angle)])
    cones = np.array(
        [[1, 0.3963377774, 0.2158037573], [1, -0.1055613458, -0.0638541728], [1, -0.0894841775, -1.2914855480]]
    )
    rgb = np.array(
        [
            [4.0767416621, -3.3077115913, 0.2309699292],
            [-1.2684380046, 2.6097574011, -0.3413193965],
            [-0.0041960863, -0.7034186147, 1.7076147010],
        ]
    )
    colors = np.ones((count, 4), np.float32)
    colors[:, :3] = np.clip(rgb @ (cones @ lab) ** 3, 0, 1).T
    return colors


def ramp_lookup(stops: Stops, entries: int = RAMP_ENTRIES) -> np.ndarray:
    """Colours (entries, 4) float32 at even steps along a ramp, interpolated linearly between its stops."""
    positions = np.array([position for position, _ in stops], dtype=float)
    colors = np.array([color for _, color in stops], dtype=float)
    order = np.argsort(positions, kind="stable")
    steps = np.linspace(0, 1, entries)
    return np.stack([np.interp(steps, positions[order], colors[order, k]) for k in range(4)], axis=1).astype(np.float32)


def tone_map(density: np.ndarray, curve: str = "log", exposure: float = 0.0, gamma: float = 2.2) -> np.ndarray:
    """Brightness from density.

    With x the density relative to an even spread over the picture, times 2 ** exposure, and W = `WHITE`:
    *linear* ``x / W``, *gamma* ``(x / W) ** (1 / gamma)``, *log* ``log(1 + x) / log(1 + W)``, each at most 1.

    Parameters
    ----------
    density : (H, W) int64
        From `raster.render`.
    curve : str
        One of `CURVES`.
    exposure : float
        In stops.
    gamma : float
        Positive; of the curve *gamma* only.

    Returns
    -------
    (H, W) float32
        In [0, 1].
    """
    if curve not in CURVES:
        raise ValueError(f"There is no curve “{curve}”; choose one of {', '.join(CURVES)}.")
    if not gamma > 0:
        raise ValueError(f"Gamma is {gamma:g}; it must be above zero.")
    brightness = np.multiply(density, density.size / TOTAL_MASS * 2.0**exposure, dtype=np.float32, casting="unsafe")
    if curve == "log":
        brightness += 1
        np.log2(brightness, out=brightness)
        brightness *= 1 / np.log2(1 + WHITE)
    else:
        brightness *= 1 / WHITE
        if curve == "gamma":
            brightness **= 1 / gamma
    return np.minimum(brightness, 1, out=brightness)


def shade(
    picture: np.ndarray,
    mode: str,
    colors: np.ndarray,
    background: Sequence[float] = (0.0, 0.0, 0.0, 0.0),
    antialiasing: int = 1,
    curve: str = "log",
    exposure: float = 0.0,
    gamma: float = 2.2,
    premultiplied: bool = False,
    threads: int | None = None,
) -> np.ndarray:
    """Colour a rendered picture.

    Parameters
    ----------
    picture : (antialiasing * H, antialiasing * W)
        From `raster.render`, in `mode`.
    mode : str
        "set", "density" or "attractorlet".
    colors
        Scene linear, straight alpha. *Set*: (4,), of the attractor. *Density*: (K, 4), a ramp from none to dense, see
        `ramp_lookup`. *Attractorlet*: (N, 4), see `attractorlet_colors`.
    background : (4,)
        What lies behind.
    antialiasing : int
        Pixels along each side of a square that becomes one pixel.
    curve, exposure, gamma
        As `tone_map` takes them; for density.
    premultiplied : bool
        Return colours that are multiplied by their alpha.
    threads : int, optional
        By default one for each processor.

    Returns
    -------
    (H, W, 4) float32
        C-contiguous, for Blender's ``Image.pixels.foreach_set``.
    """
    factor = int(antialiasing)
    if factor < 1 or picture.shape[0] % factor or picture.shape[1] % factor:
        raise ValueError(f"A picture of shape {picture.shape} has no whole squares of {antialiasing} pixels a side.")
    colors = np.asarray(colors, dtype=np.float32)
    background = np.asarray(background, dtype=np.float32)
    result = np.empty((picture.shape[0] // factor, picture.shape[1] // factor, 4), np.float32)
    if mode == "attractorlet":
        table = np.zeros((256, 4), np.float32)
        table[1 : len(colors) + 1] = colors
        table = _multiplied(_over(table, background))
        _in_strips(lambda *rows: mix_labels(picture, table, factor, premultiplied, *rows, result), len(result), threads)
        return result
    if mode == "density":
        if factor > 1:
            total = np.empty(result.shape[:2], np.int64)
            _in_strips(lambda *rows: sum_squares(picture, factor, *rows, total), len(result), threads)
            picture, factor = total, 1
        picture = tone_map(picture, curve, exposure, gamma)
        shades = ramp_lookup(list(zip(np.linspace(0, 1, len(colors)), colors, strict=True)), SHADES)
    else:
        # A pixel has one color for each number of its squares that are set.
        shades = np.tile(colors, (factor * factor + 1, 1))
        shades[:, 3] *= np.linspace(0, 1, factor * factor + 1)
    table = _over(shades, background)
    table = _multiplied(table) if premultiplied else table
    _in_strips(lambda *rows: look_up(picture, factor, table, *rows, result), len(result), threads)
    return result


def _in_strips(function, height: int, threads: int | None) -> None:
    """Call a function with the first and last row (exclusive) of a strip for each thread."""
    borders = np.linspace(0, height, parallel.thread_count(threads) + 1).astype(int)
    parallel.run(lambda rows: function(*rows), list(pairwise(borders)), threads)


def _over(colors: np.ndarray, background: np.ndarray) -> np.ndarray:
    """Colours (K, 4) laid over a background (4,), all with straight alpha."""
    behind = background[3] * (1 - colors[:, 3:])
    alpha = colors[:, 3:] + behind
    mixed = colors[:, :3] * colors[:, 3:] + background[:3] * behind
    return np.concatenate([np.divide(mixed, alpha, out=colors[:, :3].copy(), where=alpha > 0), alpha], axis=1)


def _multiplied(colors: np.ndarray) -> np.ndarray:
    return np.concatenate([colors[:, :3] * colors[:, 3:], colors[:, 3:]], axis=1)


@njit(nogil=True, cache=True)
def sum_squares(picture, factor, first_row, last_row, result):
    """Sums (H, W) over squares of `factor` pixels a side."""
    for row in range(first_row, last_row):
        for column in range(result.shape[1]):
            total = 0
            for i in range(row * factor, (row + 1) * factor):
                for j in range(column * factor, (column + 1) * factor):
                    total += picture[i, j]
            result[row, column] = total


@njit(nogil=True, cache=True)
def look_up(picture, factor, table, first_row, last_row, result):
    """Colours of means over squares of values in [0, 1]: the nearest in a table (K, 4)."""
    width = result.shape[1]
    scale = np.float32((table.shape[0] - 1) / (factor * factor))
    totals = np.empty(width, np.float32)
    for row in range(first_row, last_row):
        for column in range(width):
            totals[column] = 0
        for i in range(row * factor, (row + 1) * factor):
            for j in range(factor):
                for column in range(width):
                    totals[column] += picture[i, column * factor + j]
        for column in range(width):
            k = np.uint32(totals[column] * scale + np.float32(0.5))
            for channel in range(4):
                result[row, column, channel] = table[k, channel]


@njit(nogil=True, cache=True)
def mix_labels(labels, table, factor, premultiplied, first_row, last_row, result):
    """Mean colours of squares of labels, from a table (256, 4) of colours that are multiplied by their alpha."""
    share = np.float32(1 / (factor * factor))
    for row in range(first_row, last_row):
        for column in range(result.shape[1]):
            red, green, blue, alpha = np.float32(0), np.float32(0), np.float32(0), np.float32(0)
            for i in range(row * factor, (row + 1) * factor):
                for j in range(column * factor, (column + 1) * factor):
                    label = labels[i, j]
                    red += table[label, 0]
                    green += table[label, 1]
                    blue += table[label, 2]
                    alpha += table[label, 3]
            scale = share if premultiplied else (1 / alpha if alpha > 0 else np.float32(0))
            result[row, column, 0] = red * scale
            result[row, column, 1] = green * scale
            result[row, column, 2] = blue * scale
            result[row, column, 3] = alpha * share
