"""Pictures to colours: tone mapping of density, colour ramps, attractorlet colours, antialiasing.

All colours are scene linear RGB, as in Blender's float images, and have straight alpha unless said. Antialiasing means
to render more pixels than are shown, and to take the mean of each square of them here.
"""

from __future__ import annotations

from collections.abc import Sequence

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

STRIP_PIXELS = 2**17
"""Pictures are shaded in strips of whole rows of about so many pixels, whatever the threads."""

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


def tone_map(
    density: np.ndarray, curve: str = "log", exposure: float = 0.0, gamma: float = 2.2, pixels: int | None = None
) -> np.ndarray:
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
    pixels : int, optional
        Of the whole picture, where the density is that of a part.

    Returns
    -------
    (H, W) float32
        In [0, 1].
    """
    if curve not in CURVES:
        raise ValueError(f"There is no curve “{curve}”; choose one of {', '.join(CURVES)}.")
    if not gamma > 0:
        raise ValueError(f"Gamma is {gamma:g}; it must be above zero.")
    even = TOTAL_MASS / (pixels or density.size)
    brightness = np.multiply(density, 2.0**exposure / even, dtype=np.float32, casting="unsafe")
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
    height, width = picture.shape[0] // factor, picture.shape[1] // factor
    colors = np.asarray(colors, dtype=np.float32)
    background = np.asarray(background, dtype=np.float32)

    def finished(shades: np.ndarray) -> np.ndarray:
        shades = _over(shades, background)
        return _multiplied(shades) if premultiplied else shades

    if mode == "attractorlet":
        table = np.zeros((256, 4), np.float32)
        table[1 : len(colors) + 1] = colors
        table = _multiplied(_over(table, background))

        def paint(part: np.ndarray, result: np.ndarray) -> None:
            mix_labels(part, table, factor, premultiplied, result)

    elif mode == "density":
        table = finished(ramp_lookup(list(zip(np.linspace(0, 1, len(colors)), colors, strict=True)), SHADES))

        def paint(part: np.ndarray, result: np.ndarray) -> None:
            part = part if factor == 1 else sum_squares(part, factor)
            look_up(tone_map(part, curve, exposure, gamma, height * width), table, result)

    else:
        # A pixel has one color for each number of its squares that are set.
        shades = np.tile(colors, (factor * factor + 1, 1))
        shades[:, 3] *= np.linspace(0, 1, factor * factor + 1)
        table = finished(shades)

        def paint(part: np.ndarray, result: np.ndarray) -> None:
            count_marks(part.astype(np.uint8, copy=False), table, factor, result)

    result = np.empty((height, width, 4), np.float32)
    rows = max(1, STRIP_PIXELS // width)
    strips = [slice(first, first + rows) for first in range(0, height, rows)]
    whole = picture.reshape(height, factor, factor * width)
    parallel.run(lambda strip: paint(whole[strip].reshape(-1, factor * width), result[strip]), strips, threads)
    return result


def _over(colors: np.ndarray, background: np.ndarray) -> np.ndarray:
    """Colours (K, 4) laid over a background (4,), all with straight alpha."""
    behind = background[3] * (1 - colors[:, 3:])
    alpha = colors[:, 3:] + behind
    mixed = colors[:, :3] * colors[:, 3:] + background[:3] * behind
    return np.concatenate([np.divide(mixed, alpha, out=colors[:, :3].copy(), where=alpha > 0), alpha], axis=1)


def _multiplied(colors: np.ndarray) -> np.ndarray:
    return np.concatenate([colors[:, :3] * colors[:, 3:], colors[:, 3:]], axis=1)


@njit(nogil=True, cache=True)
def sum_squares(density, factor):
    """Sums over squares of `factor` pixels a side."""
    total = np.zeros((density.shape[0] // factor, density.shape[1] // factor), np.int64)
    for i in range(density.shape[0]):
        samples, line = density[i], total[i // factor]
        for column in range(line.shape[0]):
            for j in range(column * factor, (column + 1) * factor):
                line[column] += samples[j]
    return total


@njit(nogil=True, cache=True)
def look_up(brightness, table, result):
    """Colours of values in [0, 1]: the nearest in a table (K, 4)."""
    scale = np.float32(table.shape[0] - 1)
    for row in range(result.shape[0]):
        values, line = brightness[row], result[row]
        for column in range(line.shape[0]):
            k = np.uint32(values[column] * scale + np.float32(0.5))
            line[column, 0], line[column, 1] = table[k, 0], table[k, 1]
            line[column, 2], line[column, 3] = table[k, 2], table[k, 3]


@njit(nogil=True, cache=True)
def count_marks(marks, table, factor, result):
    """Colours of squares by how many of their marks, 0 or 1, are set, from a table (factor ** 2 + 1, 4).

    Marks are first added up along the columns: those are neighbours in memory, and many are added at a time.
    """
    counts = np.empty(marks.shape[1], np.uint16)
    for row in range(result.shape[0]):
        counts[:] = 0
        for i in range(row * factor, (row + 1) * factor):
            samples = marks[i]
            for j in range(counts.shape[0]):
                counts[j] += samples[j]
        line = result[row]
        for column in range(line.shape[0]):
            k = np.uint32(0)
            for j in range(column * factor, (column + 1) * factor):
                k += counts[j]
            line[column, 0], line[column, 1] = table[k, 0], table[k, 1]
            line[column, 2], line[column, 3] = table[k, 2], table[k, 3]


@njit(nogil=True, cache=True)
def mix_labels(labels, table, factor, premultiplied, result):
    """Mean colours of squares of labels, from a table (256, 4) of colours that are multiplied by their alpha.

    Nearly all squares have one label only, and a colour that stands in the table.
    """
    share = np.float32(1 / (factor * factor))
    differs = np.empty(labels.shape[1], np.uint8)
    for row in range(result.shape[0]):
        line, top = result[row], labels[row * factor]
        differs[:] = 0
        for i in range(row * factor + 1, (row + 1) * factor):
            samples = labels[i]
            for j in range(differs.shape[0]):
                differs[j] |= samples[j] ^ top[j]
        for column in range(line.shape[0]):
            left, right = column * factor, (column + 1) * factor
            label = top[left]
            mixed = differs[left]
            for j in range(left + 1, right):
                mixed |= differs[j] | (top[j] ^ label)
            red, green, blue, alpha = table[label, 0], table[label, 1], table[label, 2], table[label, 3]
            if mixed != 0:
                red, green, blue, alpha = np.float32(0), np.float32(0), np.float32(0), np.float32(0)
                for i in range(row * factor, (row + 1) * factor):
                    samples = labels[i]
                    for j in range(left, right):
                        label = samples[j]
                        red += table[label, 0] * share
                        green += table[label, 1] * share
                        blue += table[label, 2] * share
                        alpha += table[label, 3] * share
            if not premultiplied:
                scale = 1 / alpha if alpha > 0 else np.float32(0)
                red, green, blue = red * scale, green * scale, blue * scale
            line[column, 0], line[column, 1], line[column, 2], line[column, 3] = red, green, blue, alpha
