"""The path through the locus as F-curves of `Object.ifs_morph`: write, read back, remove.

Blender evaluates a Bezier segment by finding the curve's parameter at a time. Handles whose times are exactly a third
of the interval make time linear in the parameter, and so (u,v) runs along the very curve that was planned.
"""

import numpy as np

from ..core.ifs import IFSError
from . import compat

CHANNELS = (("ifs_morph.uv", 0), ("ifs_morph.uv", 1), ("ifs_morph.swell", 0))
"""Data path and array index of u, v and swell."""

MOST_OFFSETS = 32
"""Maps that can have a path of their own: the longest row of numbers that a property of Blender holds."""

OFFSET_CHANNELS = tuple((f"ifs_morph.offset_{axis}", k) for axis in "uv" for k in range(MOST_OFFSETS))
"""Of how much further each map is in u, then in v."""


def path_curves(owner, channels=CHANNELS):
    """F-curves of u, v and swell on an object, or of other channels; None for each that it has not."""
    found = {(curve.data_path, curve.array_index): curve for curve in compat.fcurves(owner) or ()}
    return [found.get(channel) for channel in channels]


def place_of(settings) -> list[float]:
    """u, v and swell, and the offsets of all maps if there are any: a place as `core.morph.spread` takes it."""
    offsets = [*settings.offset_u, *settings.offset_v]
    return [*settings.uv, settings.swell, *(offsets if any(offsets) else ())]


def has_path(owner) -> bool:
    """Whether u or v is keyed."""
    return any(curve is not None and not curve.is_empty for curve in path_curves(owner)[:2])


def obstacle(owner) -> str | None:
    """Why the path of an object cannot be keyed, or None if it can."""
    data = owner.animation_data
    if data is not None and data.action is not None and data.action.library is not None:
        return f"The action “{data.action.name}” is linked from a library; make it local first"
    drivers = () if data is None else data.drivers
    if any((driver.data_path, driver.array_index) in CHANNELS + OFFSET_CHANNELS for driver in drivers):
        return "UV, Swell or an offset has a driver; remove it first"
    if any(curve is not None and curve.lock for curve in path_curves(owner, CHANNELS + OFFSET_CHANNELS)):
        return "The F-curve of UV, Swell or an offset is locked; unlock it first"
    return None


def write_path(owner, path, frame_start: int, frame_end: int) -> None:
    """Key a `core.path.Path` over a frame range, in place of what u, v, swell and offsets had as keys.

    Raises
    ------
    IFSError
        If more maps have paths of their own than offsets can be stored of.
    """
    offsets = path.offset_keys
    if offsets is not None and offsets.value.shape[2] > MOST_OFFSETS:
        raise IFSError(
            f"The morph has {offsets.value.shape[2]} maps, and {MOST_OFFSETS} at most can have paths of their own; "
            "choose another method."
        )
    frames = range(frame_start, frame_end)
    for axis, channel in enumerate(CHANNELS[:2]):
        _write_keys(compat.ensure_fcurve(owner, *channel), frames, path.keys, axis)
    _write_keys(compat.ensure_fcurve(owner, *CHANNELS[2]), frames, path.swell_keys)
    remove_offsets(owner)
    if offsets is not None:
        for axis, k in np.ndindex(offsets.value.shape[1:]):
            channel = OFFSET_CHANNELS[axis * MOST_OFFSETS + k]
            _write_keys(compat.ensure_fcurve(owner, *channel), frames, offsets, axis, k)
    owner.update_tag()


def _write_keys(curve, frame_range, keys, *index):
    """Write the keys of one of the values of a `core.curve.Keys` over a range of frames, its end included."""
    frames = frame_range.start + (frame_range.stop - frame_range.start) * keys.time
    values, left, right = (each[:, *index] for each in (keys.value, keys.handle_left, keys.handle_right))
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
    """Places at frames, from the F-curves and otherwise from the properties, without moving in time.

    They are (F, 3), u, v and swell, or with the offsets of all maps (F, 3 + 2 MOST_OFFSETS).
    """
    still, curves = place_of(owner.ifs_morph), path_curves(owner)
    offsets = path_curves(owner, OFFSET_CHANNELS)
    if len(still) > len(CHANNELS) or any(curve is not None for curve in offsets):
        curves += offsets
        still += [0.0] * (len(curves) - len(still))
    columns = [
        [value] * len(frames) if curve is None or curve.is_empty else [curve.evaluate(frame) for frame in frames]
        for curve, value in zip(curves, still, strict=True)
    ]
    return np.array(columns, dtype=float).T


def key_frames(owner) -> list[float]:
    """Frames at which u or v has a key, ascending."""
    curves = [curve for curve in path_curves(owner)[:2] if curve is not None]
    return sorted({point.co.x for curve in curves for point in curve.keyframe_points})


def remove_path(owner) -> None:
    """Remove the F-curves of u, v and swell, and the offsets; other animation stays."""
    _remove(owner, CHANNELS)
    remove_offsets(owner)
    owner.update_tag()


def remove_offsets(owner) -> None:
    """Let all maps go together again."""
    _remove(owner, OFFSET_CHANNELS)
    owner.ifs_morph.offset_u = owner.ifs_morph.offset_v = (0.0,) * MOST_OFFSETS


def rearrange_offsets(owner, origins) -> None:
    """Have row k of the morph go where row ``origins[k]`` went, or with all others where that is None.

    What cannot be written, as of a linked action, stays as it is.
    """
    curves = path_curves(owner, OFFSET_CHANNELS)
    rows = owner.ifs_morph.offset_u, owner.ifs_morph.offset_v
    if obstacle(owner) or not (any(curves) or any(rows[0]) or any(rows[1])):
        return
    origins = [None if origin is None or origin >= MOST_OFFSETS else origin for origin in origins][:MOST_OFFSETS]
    still = [[0.0 if origin is None else row[origin] for origin in origins] for row in rows]
    keys = [[] if curve is None else [_stored(point) for point in curve.keyframe_points] for curve in curves]
    remove_offsets(owner)
    for axis, values in enumerate(still):
        setattr(owner.ifs_morph, f"offset_{'uv'[axis]}", values + [0.0] * (MOST_OFFSETS - len(values)))
        for k, origin in enumerate(origins):
            if origin is not None and keys[axis * MOST_OFFSETS + origin]:
                curve = compat.ensure_fcurve(owner, *OFFSET_CHANNELS[axis * MOST_OFFSETS + k])
                _restore(curve, keys[axis * MOST_OFFSETS + origin])


KEY_PROPERTIES = (
    "interpolation",
    "easing",
    "handle_left_type",
    "handle_right_type",
    "co",
    "handle_left",
    "handle_right",
)
"""What a key stores, in the order in which it is to be set."""


def _stored(point) -> list:
    return [value if isinstance(value, str) else tuple(value) for value in map(point.__getattribute__, KEY_PROPERTIES)]


def _restore(curve, stored) -> None:
    curve.keyframe_points.clear()
    curve.keyframe_points.add(len(stored))
    for point, values in zip(curve.keyframe_points, stored, strict=True):
        for name, value in zip(KEY_PROPERTIES, values, strict=True):
            setattr(point, name, value)
    curve.update()


def _remove(owner, channels) -> None:
    curves = compat.fcurves(owner)
    for curve in path_curves(owner, channels):
        if curve is not None:
            curves.remove(curve)
