"""Draw Figures 3 to 7 of Burch & Hart 1997, make Table 1 anew, and show what matching adds, by own computations.

    python -m demo_scenes.figures

Figures 3 and 4 are two of one pair, and so are 5 and 6: the same columns stand for the same place on the way.
"""

import time
from functools import partial
from pathlib import Path

import numpy as np
from PIL import Image

from core.connectedness import Connectedness, connectedness, index_buffer, object_based
from core.ifs import IFS
from core.locus import Locus, compute_locus
from core.matching import Pair, match, morph_of_pairs
from core.morph import Morph
from core.path import Path as MorphPath
from core.path import plan_path
from core.raster import fit_window, render
from core.shading import attractorlet_colors
from core.shapes import SHAPES

from .pictures import plot_path, plt

OUTPUT = Path(__file__).parents[1] / "out" / "figures"
COLUMNS = np.linspace(0, 1, 9)
CELL = 360

WIDTH = 1.35
"""Of the part of the plane that a cell of the matching shows."""

GAMMA = 1 / 2.2

PAPER_TABLE = {75: 0.47850, 150: 0.48750, 300: 0.49000, 600: 0.49815}
"""Smallest scale that the paper's index buffer called connected, by resolution (Table 1)."""

PHASES = 12
OBJECT_ITERATIONS = 6
HALVINGS = 24


def main() -> None:
    """Draw all figures and the table."""
    OUTPUT.mkdir(parents=True, exist_ok=True)
    turned, gasket, dragon = SHAPES["turned gasket"], SHAPES["gasket"], SHAPES["terdragon"]
    diagonal = np.stack([COLUMNS, COLUMNS, 0 * COLUMNS], axis=1)
    _strip("figure_3", "Figure 3: naive, elementwise interpolation", Morph(turned, gasket, "elementwise"), diagonal)
    _strip("figure_4", "Figure 4: polar interpolation", Morph(turned, gasket), diagonal)
    # The pairing in which translations do more than turn and scale the whole shape, as in the paper's Figure 7.
    morph = Morph(dragon, IFS(gasket.maps[[0, 2, 1]], name="gasket"))
    locus = compute_locus(morph)
    path = plan_path(morph, locus)
    _strip("figure_5", "Figure 5: straight, connectedness ignored", morph, diagonal)
    _strip("figure_6", "Figure 6: guided through the locus", morph, path.sample(COLUMNS))
    _locus(locus, path)
    _matching()
    print(path.report.text())
    _table()
    print(f"See {OUTPUT.relative_to(Path.cwd())}/")


def _strip(name: str, title: str, morph: Morph, places: np.ndarray) -> None:
    """Draw the attractors at places (C, 3) in a row, in pieces where the title below says so."""
    shapes = [morph.at(*place) for place in places]
    window = fit_window(shapes, (CELL, CELL))
    figure, axes = plt.subplots(1, len(shapes), figsize=(2 * len(shapes), 2.6), layout="constrained")
    figure.suptitle(title, x=0.01, ha="left")
    for axis, shape, (u, v, swell) in zip(axes, shapes, places, strict=True):
        axis.imshow(1 - render(shape, (CELL, CELL), window), origin="lower", cmap="gray", vmin=0, vmax=1)
        axis.set(xticks=[], yticks=[])
        state = connectedness(shape).state
        label = f"({u:.2f}, {v:.2f})" + (f" +{swell:.2f}" if swell > 0 else "")
        axis.set_xlabel(f"{label}\n{state.name.lower()}", fontsize=8)
    figure.savefig(OUTPUT / f"{name}.png", dpi=110)
    plt.close(figure)
    print(f"- {title}")


def _locus(locus: Locus, path: MorphPath) -> None:
    figure, axes = plt.subplots(figsize=(7, 7), layout="constrained")
    half = (locus.u[1] - locus.u[0]) / 2
    extent = (locus.u[0] - half, locus.u[-1] + half, locus.v[0] - half, locus.v[-1] + half)
    plot_path(axes, locus.picture(), extent, path.sample(np.linspace(0, 1, 400)), path.keys.value)
    axes.set_title("Figure 7: the connectedness locus, dragon to gasket\nwhite: connected", loc="left")
    figure.savefig(OUTPUT / "figure_7.png", dpi=110)
    plt.close(figure)
    print("- Figure 7: the connectedness locus")


def _matching() -> None:
    """Three morphs of two shapes with different numbers of maps and orientations, one below the other."""
    initial, final = SHAPES["Hata tree"], SHAPES["Gosper flowsnake"]
    found = match(initial, final)
    given = [Pair((k % initial.count,), (k % final.count,)) for k in range(max(initial.count, final.count))]
    diagonal = np.stack([COLUMNS, COLUMNS, 0 * COLUMNS], axis=1)
    rows = {
        "map by map, element by element": (morph_of_pairs(initial, final, given, "elementwise"), diagonal),
        "map by map, by polar decomposition": (morph_of_pairs(initial, final, given), diagonal),
        "matched": (found.morph, found.path.sample(COLUMNS)),
    }
    figure, axes = plt.subplots(len(rows), len(COLUMNS), figsize=(12, 5.2), layout="constrained")
    for line, (title, (morph, places)) in zip(axes, rows.items(), strict=True):
        line[0].set_title(title, loc="left", fontsize=10)
        for axis, place in zip(line, places, strict=True):
            _draw_centered(axis, morph.at(*place))
    target = OUTPUT / "matching.png"
    figure.savefig(target, dpi=80)
    plt.close(figure)
    Image.open(target).convert("RGB").quantize(64).save(target, optimize=True)
    print("- Matching")


def _draw_centered(axis, shape: IFS) -> None:
    """Draw a shape's attractorlets on axes, and say below if it is in pieces."""
    x0, y0, x1, y1 = shape.bounds
    x, y = (x0 + x1) / 2 - WIDTH / 2, (y0 + y1) / 2 - WIDTH / 2
    labels = render(shape, (CELL, CELL), (x, y, x + WIDTH, y + WIDTH), "attractorlet")
    colors = np.concatenate([np.ones((1, 4)), attractorlet_colors(shape.count)])
    axis.imshow(colors[labels] ** [GAMMA, GAMMA, GAMMA, 1], origin="lower")
    axis.set(xticks=[], yticks=[], frame_on=False)
    state = connectedness(shape).state
    is_whole = state == Connectedness.CONNECTED
    axis.set_xlabel("" if is_whole else state.name.lower(), fontsize=9, color="#c03a10")


def _table() -> None:
    """Table 1: the smallest scale of a gasket's maps that is called connected; in theory one half."""
    phases = np.random.default_rng(1).random((PHASES, 2))
    names = ("certified", "index buffer", "object-based")
    lines = [
        "Table 1: smallest scale called connected, gasket family (in theory 0.5)",
        f"The index buffer is the mean of {PHASES} shifts of the window by parts of a pixel, 10 points a pixel; the",
        f"object-based algorithm has {OBJECT_ITERATIONS} iterations and no resolution. Times are of one test.",
        "",
        f"{'resolution':>10}  {'paper':>8}  " + "  ".join(f"{name:>12}  {'time':>9}" for name in names),
    ]
    for resolution, paper in PAPER_TABLE.items():
        shifted = [partial(index_buffer, resolution=resolution, phases=(tuple(phase),)) for phase in phases]
        found = (
            _threshold(partial(connectedness, tolerance=1 / resolution)),
            np.mean([_threshold(test) for test in shifted], axis=0),
            _threshold(partial(object_based, iterations=OBJECT_ITERATIONS)),
        )
        cells = [f"{scale:>12.6f}  {1e6 * seconds:>6.0f} µs" for scale, seconds in found]
        lines.append(f"{resolution:>10}  {paper:>8.5f}  " + "  ".join(cells))
    table = "\n".join(lines)
    (OUTPUT / "table_1.txt").write_text(table + "\n", encoding="utf-8")
    print(table)


def _threshold(test) -> tuple[float, float]:
    """Smallest scale that a test calls connected, by halving, and the seconds that one test took."""
    low, high = 0.4, 0.52
    test(_family(high))
    began = time.perf_counter()
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        if test(_family(middle)).state == Connectedness.CONNECTED:
            high = middle
        else:
            low = middle
    return high, (time.perf_counter() - began) / HALVINGS


def _family(scale: float) -> IFS:
    """The gasket with its maps at another scale, their fixed points kept."""
    corners = SHAPES["gasket"].fixed_points
    return IFS([[[scale, 0, (1 - scale) * x], [0, scale, (1 - scale) * y]] for x, y in corners])


if __name__ == "__main__":
    main()
