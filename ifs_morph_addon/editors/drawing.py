"""Lines, dots and areas in pixels of a region."""

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader


def lines(points, color, width: float, kind: str = "LINES") -> None:
    """Draw points (P, 2) joined by lines: in pairs, as a LINE_STRIP or as a LINE_LOOP."""
    points = np.asarray(points, dtype=np.float32)
    if kind == "LINE_LOOP":
        points, kind = np.append(points, points[:1], axis=0), "LINE_STRIP"
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    shader.uniform_float("color", color)
    batch_for_shader(shader, kind, {"pos": np.insert(points, 2, 0, axis=1)}).draw(shader)


def dots(points, color, size: float) -> None:
    """Draw points (P, 2) as squares."""
    gpu.state.point_size_set(size)
    _flat(points, color, "POINTS")


def area(points, color) -> None:
    """Fill triangles, three points each."""
    _flat(points, color, "TRIS")


def _flat(points, color, kind):
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("color", color)
    points = np.insert(np.asarray(points, dtype=np.float32), 2, 0, axis=1)
    batch_for_shader(shader, kind, {"pos": points}).draw(shader)
