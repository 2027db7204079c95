"""Every shape of the library into every other: how well the matching does, pair by pair.

Run by ``make bench-pairs``; writes tables of all pairs, in the plane and in space, into out/pairs.md, and the same
figures into out/pairs.json.
The frames of the keyed paths are checked by the plain reference of the tests, which shares no code with the source.
"""

import argparse
import json
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))

from core.connectedness import Connectedness, connectedness  # noqa: E402
from core.matching import match  # noqa: E402
from core.shapes import SHAPES  # noqa: E402
from core.space.shapes import SPACE_SHAPES  # noqa: E402
from tests.core.reference import in_pieces  # noqa: E402
from tests.core.space.reference import in_pieces as in_pieces_in_space  # noqa: E402

FRAMES = 240
TOLERANCE = 1 / 300
POINTS = 4000
"""Of the reference, for one shape."""


def measure(initial, final, checked, shapes, in_pieces):
    """Return the figures of one pair, and how many of `checked` frames the reference finds in pieces."""
    start, processor = time.perf_counter(), time.process_time()
    first = []
    found = match(
        shapes[initial],
        shapes[final],
        FRAMES,
        TOLERANCE,
        found=lambda _: first.append(time.perf_counter() - start),
    )
    seconds, processor = time.perf_counter() - start, time.process_time() - processor
    report = found.report
    frames = np.unique(np.round(np.linspace(0, FRAMES - 1, checked)).astype(int))
    shown = [found.morph.at(*found.path.at(frame / (FRAMES - 1))).maps for frame in frames]
    return {
        "initial": initial,
        "final": final,
        "maps": [shapes[initial].count, shapes[final].count],
        "pairs": len(found.pairs),
        "frames not in one piece": report.disconnected,
        "found in pieces by the reference": int(sum(in_pieces(maps, TOLERANCE, POINTS) for maps in shown)),
        "worst gap": report.worst_gap,
        "most swell": report.most_swell,
        "mean swell": report.mean_swell,
        "flips": len(report.flips),
        "keys": len(found.path.keys.time),
        "seconds": seconds,
        "processor seconds": processor,
        "seconds to the first": first[0],
        "element by element": broken(report.element_wise),
        "straight polar": broken(report.straight_polar),
        "straight most swell": report.straight_swell[0],
        "straight mean swell": report.straight_swell[1],
    }


def broken(check):
    """Return how many frames are not known to be in one piece."""
    return len(check.state) - check.count(Connectedness.CONNECTED)


def summary(rows):
    """Return lines that sum the table up."""
    column = {name: np.array([row[name] for row in rows], dtype=float) for name in rows[0] if name not in TEXT}
    whole = {
        name: f"{100 * np.mean(column[name] == 0):.1f}%"
        for name in ("frames not in one piece", "straight polar", "element by element")
    }
    worse = [
        row
        for row in rows
        if row["most swell"] > row["straight most swell"] or row["mean swell"] > row["straight mean swell"]
    ]
    return [
        f"{len(rows)} ordered pairs of connected shapes, {FRAMES} frames, tolerance 1/{round(1 / TOLERANCE)}.",
        f"Pairs with every frame in one piece: {whole['frames not in one piece']} matched, "
        f"{whole['straight polar']} straight polar, {whole['element by element']} element by element.",
        f"Frames that the reference finds in pieces: {column['found in pieces by the reference'].sum():.0f}.",
        f"Greatest swell: median {np.median(column['most swell']):.3f}, worst {column['most swell'].max():.3f}; "
        f"straight {np.median(column['straight most swell']):.3f} and {column['straight most swell'].max():.3f}.",
        f"Mean swell: median {np.median(column['mean swell']):.4f}, worst {column['mean swell'].max():.4f}; "
        f"straight {np.median(column['straight mean swell']):.4f} and {column['straight mean swell'].max():.4f}.",
        f"Pairs that swell: {np.count_nonzero(column['most swell'])}; more than the straight line: {len(worse)}; "
        f"pairs that flip maps: {np.count_nonzero(column['flips'])}.",
        f"Seconds: median {np.median(column['seconds']):.2f}, worst {column['seconds'].max():.2f}; to a first answer: "
        f"median {np.median(column['seconds to the first']):.2f}, worst {column['seconds to the first'].max():.2f}.",
        f"Seconds of processors, which other work does not lengthen: median "
        f"{np.median(column['processor seconds']):.2f}, worst {column['processor seconds'].max():.2f}.",
    ]


KINDS = {"plane": (SHAPES, in_pieces), "space": (SPACE_SHAPES, in_pieces_in_space)}
"""Shapes and the reference for them."""

TEXT = ("initial", "final", "maps")
SHOWN = {
    "initial": "initial",
    "final": "final",
    "pairs": "pairs",
    "broken": "frames not in one piece",
    "reference": "found in pieces by the reference",
    "most": "most swell",
    "mean": "mean swell",
    "flips": "flips",
    "keys": "keys",
    "seconds": "seconds",
    "processor": "processor seconds",
    "element-wise": "element by element",
    "polar": "straight polar",
    "its most": "straight most swell",
    "its mean": "straight mean swell",
}


def table(rows):
    """Return the rows as lines of markdown."""
    lines = ["| " + " | ".join(SHOWN) + " |", "|" + " --- |" * len(SHOWN)]
    for row in rows:
        cells = [row[name] for name in SHOWN.values()]
        lines.append(
            "| " + " | ".join(f"{cell:.3g}" if isinstance(cell, float) else str(cell) for cell in cells) + " |"
        )
    return lines


def main():
    """Measure, and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--every", type=int, default=1, help="take every so many-th pair only")
    parser.add_argument("--checked", type=int, default=24, help="frames a pair that the reference checks")
    parser.add_argument("--only", choices=KINDS, help="shapes of this kind only")
    options = parser.parse_args()
    found, text = {}, []
    for kind in [options.only] if options.only else KINDS:
        rows = measured(*KINDS[kind], options.every, options.checked)
        lines = summary(rows)
        print("\n".join(["", *lines]))
        found[kind] = {"summary": lines, "pairs": rows}
        text += [f"# Every shape of the {kind} into every other", "", *lines, "", *table(rows), ""]
    out = ROOT / "out"
    out.mkdir(exist_ok=True)
    (out / "pairs.json").write_text(json.dumps(found, indent=1), encoding="utf-8")
    (out / "pairs.md").write_text("\n".join(text), encoding="utf-8")


def measured(shapes, in_pieces, every, checked):
    """Return the figures of the pairs of connected shapes, of each `every`-th."""
    connected = [name for name, ifs in shapes.items() if connectedness(ifs).state == Connectedness.CONNECTED]
    pairs = [(one, other) for one in connected for other in connected if one != other][::every]
    # The first match compiles the kernels.
    match(shapes[connected[1]], shapes[connected[0]])
    rows = []
    for count, pair in enumerate(pairs, 1):
        rows.append(measure(*pair, checked, shapes, in_pieces))
        sys.stderr.write(f"\r{count} of {len(pairs)}")
    return rows


if __name__ == "__main__":
    main()
