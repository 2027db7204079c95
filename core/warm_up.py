"""Calls every kernel once with each kind of arguments that it gets, so that none is left to compile when it is needed.

A program that must not keep a person waiting has processes of their own run `main`, one for each of `PARTS`, looks now
and then how far they are, and in the end leaves a mark for the next time.
"""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Iterator
from hashlib import sha256
from importlib.metadata import distributions
from pathlib import Path

import numpy as np

from . import kernels
from .cloud import point_cloud
from .connectedness import connectedness
from .enclosure import norm
from .ifs import IFS
from .kernels import Kernel
from .locus import compute_locus
from .matching import match
from .morph import Morph
from .path import plan_path
from .raster import fit_window, render
from .recurrent_shapes import RECURRENT_SHAPES
from .report import check_frames
from .shading import attractorlet_colors, shade
from .shapes import SHAPES
from .space.morph import SpaceMorph
from .space.shapes import SPACE_SHAPES

SIZE = (64, 48)
"""Of pictures, in pixels: kernels do not care."""

RESOLUTION = 10
"""Of loci, in nodes a side."""

NICENESS = 5
"""How far the process stands back behind others, where the system knows of that."""

COVERED_TWICE = IFS(np.array([[[0.97, 0.0, x], [0.0, 0.97, y]] for x, y in ((0, 0), (0.03, 0), (0, 0.03))]))
"""Its attractor lies over itself so often that it is drawn by the chaos game."""


def load() -> Iterator[None]:
    """Have the compiler and the first kernels ready, in steps of a few tenths of a second if kernels were kept."""
    _ = norm.dispatcher
    yield
    SHAPES["gasket"].require_attractor()
    yield
    _shapes()


def _shapes() -> None:
    fit_window(SHAPES["gasket"], SIZE)


def _pictures() -> None:
    shape = SHAPES["gasket"]
    white, ramp, labels = np.ones(4, np.float32), np.ones((16, 4), np.float32), attractorlet_colors(shape.count)
    for mode, colors in (("set", white), ("density", ramp), ("attractorlet", labels)):
        render(COVERED_TWICE, SIZE, None, mode, threads=1)
        for norms in (None, shape.norms):
            picture = render(shape, SIZE, None, mode, norms=norms, threads=1)
        for antialiasing in (1, 2):
            shade(picture, mode, colors, antialiasing=antialiasing, threads=1)


def _points() -> None:
    point_cloud(SHAPES["gasket"], 1000, threads=1)


def _space() -> None:
    shape = SPACE_SHAPES["Sierpinski tetrahedron"]
    shape.require_attractor()
    point_cloud(shape, 1000, threads=1)
    check_frames(SpaceMorph(SPACE_SHAPES["turned tetrahedron"], shape), np.zeros((2, 3)), threads=1)
    compute_locus(SpaceMorph(SPACE_SHAPES["turned tetrahedron"], shape), RESOLUTION, threads=1)


def _paths() -> None:
    connectedness(SHAPES["gasket"])
    whole, broken = (Morph(SHAPES[name], SHAPES["gasket"]) for name in ("turned gasket", "terdragon"))
    compute_locus(whole, RESOLUTION, threads=1)
    check_frames(whole, np.zeros((2, 3)), threads=1)
    for morph in (whole, broken):
        plan_path(morph, compute_locus(morph, RESOLUTION, threads=1, gap=False), 8, threads=1)


def _matches() -> None:
    match(SHAPES["twindragon"], SHAPES["square"], 8, threads=1)


def _recurrent() -> None:
    shape = RECURRENT_SHAPES["hollow square"]
    check_frames(Morph(shape, shape), np.zeros((2, 3)), threads=1)
    point_cloud(shape, 1000, threads=1)
    for mode in ("set", "density", "attractorlet"):
        render(shape, SIZE, None, mode, norms=shape.norms, threads=1)


PARTS = {"pictures": (_pictures, _points, _space), "paths": (_shapes, _paths, _matches, _recurrent)}
"""What takes about as long as another, for as many processes."""


def run(*parts: str) -> None:
    """Compile all kernels of some parts, those aside that were kept."""
    for part in parts:
        for calls in PARTS[part]:
            calls()


def share_done(folder: Path, since: float) -> float:
    """Share of the kernels, from 0 to 1, that were put into a folder since a time in seconds since 1970."""
    modules = [module for name, module in list(sys.modules.items()) if name.startswith(f"{__package__}.")]
    known = {id(value) for module in modules for value in vars(module).values() if isinstance(value, Kernel)}
    kept = [path for path in folder.glob("*.nbi") if path.stat().st_mtime >= since]
    return min(len(kept) / len(known), 1.0)


def is_done(folder: Path) -> bool:
    """Whether all kernels of these sources were compiled into a folder, on this machine and with this numba."""
    try:
        return _mark(folder).read_text() == _state()
    except (OSError, ValueError):
        return False


def _mark(folder: Path) -> Path:
    """The file that says what the kernels in a folder were compiled from; a home may be shared by several machines."""
    machine = sha256(f"{platform.node()} {platform.machine()} {sys.version_info[:2]}".encode()).hexdigest()[:6]
    return folder / f"ready-{machine}"


def _state() -> str:
    numba = next((distribution.version for distribution in distributions(name="numba")), "")
    return f"{__package__} {kernels.fingerprint('warm_up')} numba {numba}"


def mark_done(folder: Path) -> None:
    """Say that all parts were compiled into a folder, which `is_done` then tells."""
    _mark(folder).write_text(_state())


def main(*parts: str) -> None:
    """Compile all kernels of some parts, behind all other work of the computer."""
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    run(*parts)
