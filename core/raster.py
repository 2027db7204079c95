"""Attractors to pixels: the set, its density, its attractorlets.

The attractor is cut into words of a few dozen pixels, and under each a ready set of points is drawn (`pieces`,
`drawing`). The cut and the points have fixed addresses, so a picture that is rendered again is the same to the bit, and
one that moves does not flicker.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from . import chaos, drawing, spreading
from .grammar import set_grammar, word_grammar
from .ifs import IFS, Contractivity, IFSError
from .pieces import LARGEST_GRID, measures, outlines
from .words import LETTER, MASS, WORD_MASS, cut_dimensions, cut_words, unit_maps

MODES = ("set", "density", "attractorlet")

SAMPLES = {"set": 4.0, "density": 16.0, "attractorlet": 4.0}
"""Points for each pixel of a filled shape, by default."""

SAMPLES_RANGE = (1 / 16, 64.0)

LEAST_CELL = 2**-2.5
"""Side in pixels of the cells whose outlines are drawn, at least: a smaller one would hardly find a pixel more."""

PIECE_CELLS = 64
PIECE_RANGE = (16.0, 32.0)
"""Size of the words that sets of points are drawn under: so many cells, within a range in pixels."""

SET_RATIO = 8.0
SET_WORDS = 8.0
"""A set of points is made of sets that are smaller by this ratio, or by less where more than so many words overlap."""

OVERLAP = 16.0
"""Words that may lie over one place of the picture. If an attractor overlaps itself more, its words are made larger."""

MOST_POINTS = 256.0
LEAST_BUDGET = 4096
"""Points to draw for each pixel of the picture at most, and words in any case; beyond, words are made larger."""

FIXED_GROWTH = 3.0
"""Norms by which words multiply by a higher exponent (`words.cut_dimensions`) are not cut by: the pieces of most frames
would be far smaller than need be. Each frame is cut by itself then."""

GROWTH_LIMIT = 12.0
"""Attractors whose words multiply by a higher exponent are not cut into words, for those overlap so often that sets of
points are no gain. Their density is left to the chaos game, of which a point costs as much as six of a set, and their
set to `spreading`; where a window shows so small a part that spreading is too coarse, the chaos game adds to it."""

MOST_ZOOM = 2.0**40
"""Radius of an attractor in pixels, at most: beyond, 64 bit floats would no longer tell its pieces apart."""

CHAOS_POINTS = 16.0
"""Points of the chaos game for each pixel of the picture, at least."""

TOTAL_MASS = int(WORD_MASS) * drawing.POINT_MASS
"""What the density of a whole attractor adds up to, however large the picture and however many the points: 2 ** 62."""

Window = tuple[float, float, float, float]


def render(
    ifs: IFS,
    size: tuple[int, int],
    window: Window | None = None,
    mode: str = "set",
    samples: float | None = None,
    threads: int | None = None,
    norms: np.ndarray | None = None,
    dtype: type = np.float32,
) -> np.ndarray:
    """Render an attractor.

    Parameters
    ----------
    ifs : IFS
    size : (width, height)
        In pixels.
    window : (x0, y0, x1, y1), optional
        The part of the plane that the picture shows; by default all of the attractor, see `fit_window`.
    mode : str
        "set", "density" or "attractorlet".
    samples : float, optional
        Points for each pixel of a filled shape, held within `SAMPLES_RANGE`; by default `SAMPLES`. More points find
        more of the pixels that the attractor only just touches, and place its density more finely.
    threads : int, optional
        By default one for each processor. The result is the same to the byte.
    norms : (N,), optional
        Upper bounds of the norms of the maps over a whole animation. Where the attractor is cut then depends on them
        instead of on this very IFS, so that no pixel is found in one frame and lost in the next because of the cut.
        Of no effect where they are so large that it would take too long, see `FIXED_GROWTH`.
    dtype : type
        Of a set; ``numpy.uint8`` takes a quarter of the memory and is what `shading.shade` likes best.

    Returns
    -------
    (height, width)
        Row 0 is the lowest. *Set*: `dtype`, 1 where the attractor meets a pixel and 0 elsewhere. *Density*: int64, the
        measure that weights and transitions give, `TOTAL_MASS` of it for the whole attractor, that of each attractorlet
        times its opacity. *Attractorlet*: uint8, 0 where there is none and 1 + i for attractorlet i, the last of those
        that meet the pixel. Hidden attractorlets (`IFS.opacity`) leave no trace.

    Raises
    ------
    IFSError
        If there is no attractor, too many attractorlets to tell apart, or so small a part to show that numbers are
        not precise enough.
    ValueError
        If the size, the window, the mode or the norms make no sense.
    """
    width, height = _checked_size(size)
    if mode not in MODES:
        raise ValueError(f"There is no mode “{mode}”; choose one of {', '.join(MODES)}.")
    if mode == "attractorlet" and ifs.count > 255:
        raise IFSError(f"The IFS has {ifs.count} maps; at most 255 attractorlets can be told apart in a picture.")
    x0, y0, x1, y1 = fit_window(ifs, size) if window is None else _checked_window(window)
    samples = float(np.clip(SAMPLES[mode] if samples is None else samples, *SAMPLES_RANGE))
    norms = _checked_norms(norms, ifs.count)

    across, along = width / (x1 - x0), height / (y1 - y0)
    maps, center, radius = unit_maps(ifs, least_radius=1e-9 / max(across, along))
    if not radius * max(across, along) <= MOST_ZOOM:
        raise IFSError(
            f"The window is {x1 - x0:.3g} wide and the attractor {2 * radius:.3g}: numbers are not precise enough to "
            "show so small a part; make the window larger or bring the maps nearer to each other."
        )
    root = np.array([radius * across, 0.0, (center[0] - x0) * across, 0.0, radius * along, (center[1] - y0) * along])
    labels = np.arange(1, ifs.count + 1, dtype=np.uint8) if mode == "attractorlet" else np.ones(ifs.count, np.uint8)
    labels *= ifs.drawn
    weights, opacity, transitions = ifs.weights, ifs.opacity, ifs.transitions
    grammar_of = word_grammar if mode == "density" else set_grammar
    grammar = grammar_of(weights, transitions)
    growth, dimension = cut_dimensions(maps, norms, grammar) if len(norms) else (np.inf, np.inf)
    if growth > FIXED_GROWTH:
        norms = np.zeros(0)
        if transitions is None:
            maps, weights, opacity, labels = _distinct(maps, weights, opacity, labels)
            grammar = grammar_of(weights, None)
        growth, dimension = cut_dimensions(maps, norms, grammar)
    canvas = np.zeros((height, width), np.int64 if mode == "density" else np.uint8)
    if growth <= GROWTH_LIMIT:
        _draw(canvas, root, maps, norms, grammar, opacity, labels, growth, dimension, samples, threads)
    elif mode == "density":
        samples = max(samples, CHAOS_POINTS)
        chaos.deposit(canvas, root, maps, weights, samples, TOTAL_MASS, threads, transitions, opacity)
    elif not spreading.mark(canvas, root, maps, labels, transitions):
        chaos.mark(canvas, root, maps, weights, labels, max(samples, CHAOS_POINTS), threads, transitions)
    return canvas.astype(dtype, copy=False) if mode == "set" else canvas


def _draw(canvas, root, maps, norms, grammar, opacity, labels, growth, dimension, samples, threads) -> None:
    """Draw words into the canvas, their mass if it holds 64 bit integers and their labels otherwise."""
    density = canvas.dtype == np.int64
    height, width = canvas.shape
    side = math.sqrt(width * height)
    extent = _extent(2 * max(root[0], root[4]), side, norms)
    cell, piece, ratio = _resolution(density, samples, growth, dimension, extent, side)
    shown, first = np.array([0.0, 0.0, width, height]), len(grammar.allowed) - 1
    while True:
        budget = int(MOST_POINTS * canvas.size / min(piece / cell, LARGEST_GRID) ** 2) + LEAST_BUDGET
        words = cut_words(root, maps, norms, extent, piece, grammar, first, shown, budget)
        if len(words) <= budget or piece > extent:
            break
        piece *= 4
    # Sets are half octaves below the extent, so that maps that scale by one or more of these lead from set to set.
    smallest = extent * 2 ** (round(2 * math.log2(cell / extent)) / 2)
    if not (opacity == 1).all():
        # What is hidden was cut, too, so that nothing is cut otherwise once it shows.
        letters = words[:, LETTER].astype(np.int64)
        words[:, MASS] = np.floor(words[:, MASS] * opacity[letters])
        words = words[labels[letters] > 0]
    if density:
        drawing.deposit(canvas, words, measures(maps, norms, grammar, cell, smallest, piece, ratio), threads)
    else:
        letters = words[:, LETTER].astype(np.int64)
        sets = outlines(maps, norms, grammar, cell, smallest, piece, ratio)
        drawing.mark(canvas, words, labels[letters], sets, threads)


def fit_window(shapes: IFS | Iterable[IFS], size: tuple[int, int], margin: float = 0.05) -> Window:
    """The smallest window of a picture's proportions that shows all of some attractors.

    Parameters
    ----------
    shapes : IFS or iterable of IFS
        Such as the frames of a morph, so that the picture does not breathe. Those without an attractor are passed over.
    size : (width, height)
        Of the picture, in pixels.
    margin : float
        Least distance of the attractors from the border, as a share of the window.

    Returns
    -------
    (x0, y0, x1, y1)

    Raises
    ------
    IFSError
        If none has an attractor.
    """
    width, height = _checked_size(size)
    shapes = [shapes] if isinstance(shapes, IFS) else list(shapes)
    bounds = np.array([ifs.bounds for ifs in shapes if ifs.contractivity == Contractivity.CONTRACTIVE])
    if len(bounds) == 0:
        for ifs in shapes:
            ifs.require_attractor()
        raise IFSError("There is no shape to fit the window to.")
    low, high = bounds[:, :2].min(axis=0), bounds[:, 2:].max(axis=0)
    center = (low + high) / 2
    pixel = max((high - low) / (width, height)) / (1 - 2 * margin)
    # An attractor that is a single point still wants a window about it.
    pixel = pixel if pixel > 1e-12 * np.abs(center).max() else 1 / max(width, height)
    half = np.array([width, height]) * pixel / 2
    return (*(center - half).tolist(), *(center + half).tolist())


def _resolution(
    density: bool, samples: float, growth: float, dimension: float, extent: float, side: float
) -> tuple[float, float, float]:
    """Side of the cells, size of the words, and ratio of sizes of the sets of points, from `words.cut_dimensions`.

    A filled shape, of dimension 2, gets cells of one `samples`-th of a pixel. A thinner one is all border, where points
    tell more, and its cells are smaller: as many as a filled one would have in a picture of so many pixels.
    """
    cell = samples**-0.5
    piece = PIECE_RANGE[1]
    if not density:
        thin = min(max(dimension, 0.5), 2.0)
        cell = max(min(side * (samples * side * side) ** (-1 / thin), cell), min(LEAST_CELL, cell))
        cell = 2 ** (round(2 * math.log2(cell)) / 2)
        piece = min(max(PIECE_CELLS * cell, PIECE_RANGE[0]), PIECE_RANGE[1])
    ratio = SET_RATIO
    if growth > 2:
        # Words of size s lie (extent / s) ** (growth - 2) times over each other.
        enough = extent * math.exp(-math.log(OVERLAP) / (growth - 2))
        # A set has LARGEST_GRID cells a side: beyond, let more words overlap, so that a pixel gets as many points.
        finest = (extent ** (growth - 2) * LARGEST_GRID**2 / (OVERLAP * samples)) ** (1 / growth)
        piece = max(piece, min(enough, finest))
        ratio = max(min(ratio, math.exp(min(math.log(SET_WORDS) / (growth - 2), 3))), math.sqrt(2))
        if density and piece < extent:
            # Points of several words share a pixel, so each word can do with fewer.
            cell *= min(max((extent / piece) ** (growth / 2 - 1), 1.0), 2.0)
    return cell, piece, ratio


def _extent(diameter: float, side: float, norms: np.ndarray) -> float:
    """Size of the attractor in pixels, to cut it by; where the cut is fixed, rounded up to half octaves of the side.

    So it stays the same as long as the attractor about fills the picture, as it does all through a morph.
    """
    if len(norms) == 0:
        return diameter
    return side * 2 ** (math.ceil(2 * math.log2(diameter / side)) / 2)


def _distinct(maps: np.ndarray, weights: np.ndarray, opacity: np.ndarray, labels: np.ndarray) -> tuple[np.ndarray, ...]:
    """Equal maps as one, with all their weight, their mean opacity and the highest of their labels."""
    last = {row.tobytes(): k for k, row in enumerate(maps)}
    if len(last) == len(maps):
        return maps, weights, opacity, labels
    kept = np.array(sorted(last.values()))
    place = {row.tobytes(): k for k, row in enumerate(maps[kept])}
    member = [place[row.tobytes()] for row in maps]
    total, seen = np.bincount(member, weights=weights), np.bincount(member, weights=weights * opacity)
    mean = np.divide(seen, total, out=np.zeros(len(kept)), where=total > 0)
    highest = np.zeros(len(kept), np.uint8)
    np.maximum.at(highest, member, labels)
    return np.ascontiguousarray(maps[kept]), total, mean, highest


def _checked_size(size: tuple[int, int]) -> tuple[int, int]:
    width, height = (int(side) for side in size)
    if width < 1 or height < 1 or width * height >= 2**31:
        raise ValueError(
            f"A picture of {width} x {height} pixels cannot be made; use at least 1 x 1, and less than 2^31."
        )
    return width, height


def _checked_window(window: Window) -> Window:
    x0, y0, x1, y1 = (float(side) for side in window)
    if not (np.isfinite([x0, y0, x1, y1]).all() and x0 < x1 and y0 < y1):
        raise ValueError(f"The window {tuple(window)} is empty; give x0, y0, x1, y1 with x0 < x1 and y0 < y1.")
    return x0, y0, x1, y1


def _checked_norms(norms: np.ndarray | None, count: int) -> np.ndarray:
    """Norms to cut by: those given, or none where words have to be measured."""
    if norms is None:
        return np.zeros(0)
    norms = np.ascontiguousarray(norms, dtype=float)
    if norms.shape != (count,) or not (norms >= 0).all():
        raise ValueError(f"Norms must be {count} numbers, none negative, one for each map.")
    return norms if norms.max() < 1 else np.zeros(0)
