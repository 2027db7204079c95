"""The path through the locus as F-curves of `Object.ifs_morph`: write, read back, remove.

Blender evaluates a Bezier segment by finding the curve's parameter at a time. Handles whose times are exactly a third
of the interval make time linear in the parameter, and so (u,v) runs along the very curve that was planned.
"""

import numpy as np

from . import compat

CHANNELS = (("ifs_morph.uv", 0), ("ifs_morph.uv", 1), ("ifs_morph.swell", 0))
"""Data path and array index of u, v and swell."""


def path_curves(owner):
    """F-curves of u, v and swell on an object; None for each that it has not."""
    curves = compat.fcurves(owner)
    if curves is None:
        return [None] * len(CHANNELS)
    return [curves.find(data_path, index=index) for data_path, index in CHANNELS]


def has_path(owner) -> bool:
    """Whether u or v is keyed."""
    return any(curve is not None and not curve.is_empty for curve in path_curves(owner)[:2])


def obstacle(owner) -> str | None:
    """Why the path of an object cannot be keyed, or None if it can."""
    data = owner.animation_data
    if data is not None and data.action is not None and data.action.library is not None:
        return f"The action “{data.action.name}” is linked from a library; make it local first"
    if data is not None and any(
        driver.data_path == data_path and driver.array_index == index
        for driver in data.drivers
        for data_path, index in CHANNELS
    ):
        return "UV or Swell has a driver; remove it first"
    if any(curve is not None and curve.lock for curve in path_curves(owner)):
        return "The F-curve of UV or Swell is locked; unlock it first"
    return None


def write_path(owner, path, frame_start: int, frame_end: int) -> None:
    """Key a `core.path.Path` over a frame range, in place of what u, v and swell had as keys."""
    keys, swell = path.keys, path.swell_keys
    span = frame_end - frame_start
    for axis, (data_path, index) in enumerate(CHANNELS[:2]):
        curve = compat.ensure_fcurve(owner, data_path, index)
        values = keys.value[:, axis], keys.handle_left[:, axis], keys.handle_right[:, axis]
        _write_keys(curve, frame_start + span * keys.time, *values)
    curve = compat.ensure_fcurve(owner, *CHANNELS[2])
    _write_keys(curve, frame_start + span * swell.time, swell.value, swell.handle_left, swell.handle_right)
    owner.update_tag()


def _write_keys(curve, frames, values, left, right):
    curve.keyframe_points.clear()
    curve.keyframe_points.add(len(frames))
    thirds = np.diff(frames) / 3
    before, after = np.append(thirds[:1], thirds), np.append(thirds, thirds[-1:])
    for k, point in enumerate(curve.keyframe_points):
        point.interpolation = "BEZIER"
        point.handle_left_type = point.handle_right_type = "FREE"
        point.co = frames[k], values[k]
        point.handle_left = frames[k] - before[k], left[k]
        point.handle_right = frames[k] + after[k], right[k]
    curve.update()


def sample_path(owner, frames) -> np.ndarray:
    """u, v and swell (F, 3) at frames, from the F-curves and otherwise from the properties, without moving in time."""
    settings = owner.ifs_morph
    still = (*settings.uv, settings.swell)
    columns = [
        [value] * len(frames) if curve is None or curve.is_empty else [curve.evaluate(frame) for frame in frames]
        for curve, value in zip(path_curves(owner), still, strict=True)
    ]
    return np.array(columns, dtype=float).T


def key_frames(owner) -> list[float]:
    """Frames at which u or v has a key, ascending."""
    curves = [curve for curve in path_curves(owner)[:2] if curve is not None]
    return sorted({point.co.x for curve in curves for point in curve.keyframe_points})


def remove_path(owner) -> None:
    """Remove the F-curves of u, v and swell; other animation stays."""
    curves = compat.fcurves(owner)
    for curve in path_curves(owner):
        if curve is not None:
            curves.remove(curve)
    owner.update_tag()
