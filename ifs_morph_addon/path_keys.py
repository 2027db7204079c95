"""Keys of the path moved, added and removed one by one: those of u and v at the same frame are one key of the path."""

import numpy as np

from ..core.curve import Keys
from ..core.handles import move_key, remove_key
from . import compat, fcurves

SAME_FRAME = 1e-3

NAMES = ("co", "handle_left", "handle_right")
"""What a key stores: frame and value of itself and of its handles."""


def prepare(owner) -> None:
    """Have u and v keyed at the same frames; the path stays as it is."""
    still = tuple(owner.ifs_morph.uv)
    for (data_path, index), value in zip(fcurves.CHANNELS[:2], still, strict=True):
        curve = compat.ensure_fcurve(owner, data_path, index)
        if curve.is_empty:
            for frame in fcurves.key_frames(owner):
                curve.keyframe_points.insert(frame, value)
    frames = fcurves.key_frames(owner)
    for curve in fcurves.path_curves(owner)[:2]:
        for frame in frames:
            if _at(curve, frame) is None:
                _split(curve, frame)


def _split(curve, frame: float) -> None:
    """Key an F-curve where it is at a frame; Blender chooses handles that keep its course."""
    following = next((k for k, point in enumerate(curve.keyframe_points) if point.co.x > frame), 0)
    interpolation = curve.keyframe_points[max(following - 1, 0)].interpolation
    point = curve.keyframe_points.insert(frame, curve.evaluate(frame))
    point.interpolation = interpolation
    # The handles are to stay as they are when a neighbor moves.
    point.handle_left_type = point.handle_right_type = "FREE"
    curve.update()


def move(owner, before: Keys, frame: float, uv) -> None:
    """Move the key at a frame to another (u,v), given the keys `before` from `read`."""
    index = int(np.argmin(np.abs(before.time - frame)))
    _write(owner, move_key(before, index, np.array(uv, dtype=float)))


def add(owner, frame: float) -> None:
    """Add a key at a frame where the path is at that time; the only one selected."""
    prepare(owner)
    for curve in fcurves.path_curves(owner)[:2]:
        if _at(curve, frame) is None:
            _split(curve, frame)
    select(owner, frame)
    refresh(owner)


def remove(owner, frames) -> None:
    """Remove the keys at frames; the path goes on where they were."""
    prepare(owner)
    for frame in frames:
        keys = read(owner)
        index = int(np.argmin(np.abs(keys.time - frame)))
        for curve in fcurves.path_curves(owner)[:2]:
            curve.keyframe_points.remove(curve.keyframe_points[index])
            if 0 < index < len(keys.time) - 1:
                _space_handles(*curve.keyframe_points[index - 1 : index + 1])
        _write(owner, remove_key(keys, index))
    curves = compat.fcurves(owner)
    for curve in fcurves.path_curves(owner)[:2]:
        if curve.is_empty:
            curves.remove(curve)
    refresh(owner)


def _space_handles(start, end) -> None:
    """Put the handles between two keys at the thirds of the time between them."""
    third = (end.co.x - start.co.x) / 3
    start.handle_right.x, end.handle_left.x = start.co.x + third, end.co.x - third


def key(owner, frame: float, uv) -> None:
    """Key (u,v) at a frame, as automatic keying does."""
    for (data_path, index), value in zip(fcurves.CHANNELS[:2], uv, strict=True):
        curve = compat.ensure_fcurve(owner, data_path, index)
        curve.keyframe_points.insert(frame, value)
        curve.update()
    refresh(owner)


def read(owner) -> Keys:
    """Keys of the path, by frame; u and v must be keyed at the same frames, see `prepare`."""
    columns = [_numbers(curve) for curve in fcurves.path_curves(owner)[:2]]
    frames = columns[0]["co"][:, 0]
    places = [np.stack([column[name][:, 1] for column in columns], axis=1) for name in NAMES]
    return Keys(frames, *places)


def restore(owner, keys: Keys) -> None:
    """Put keys back that `read` has read."""
    _write(owner, keys)


def selected_frames(owner) -> list[float]:
    """Frames of the selected keys of u or v, ascending."""
    curves = [curve for curve in fcurves.path_curves(owner)[:2] if curve is not None]
    return sorted({point.co.x for curve in curves for point in curve.keyframe_points if point.select_control_point})


def select(owner, frame: float) -> None:
    """Select the key at a frame and no other of the path, here and in the Graph Editor."""
    for curve in fcurves.path_curves(owner)[:2]:
        for point in curve.keyframe_points if curve is not None else ():
            chosen = abs(point.co.x - frame) < SAME_FRAME
            point.select_control_point = point.select_left_handle = point.select_right_handle = chosen


def refresh(owner) -> None:
    """Have Blender evaluate the F-curves again."""
    owner.animation_data.action.update_tag()
    owner.update_tag(refresh={"TIME"})


def _at(curve, frame):
    return next((point for point in curve.keyframe_points if abs(point.co.x - frame) < SAME_FRAME), None)


def _numbers(curve) -> dict[str, np.ndarray]:
    """Frame and value (K, 2) of each key and of its handles."""
    numbers = {}
    for name in NAMES:
        flat = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
        curve.keyframe_points.foreach_get(name, flat)
        numbers[name] = flat.reshape(-1, 2).astype(float)
    return numbers


def _write(owner, keys: Keys) -> None:
    """Write the values of keys and handles to F-curves with keys at the same frames."""
    for axis, curve in enumerate(fcurves.path_curves(owner)[:2]):
        numbers = _numbers(curve)
        for name, values in zip(NAMES, (keys.value, keys.handle_left, keys.handle_right), strict=True):
            numbers[name][:, 1] = values[:, axis]
            curve.keyframe_points.foreach_set(name, numbers[name].astype(np.float32).ravel())
        curve.update()
    refresh(owner)
