"""Renders the attractor of each morph object at its evaluated (u,v) into its image or points.

`refresh` is called whenever Blender has evaluated something. It renders nothing that is shown already: each output
remembers what it was rendered from.
"""

import threading

import bpy

from ...core.ifs import IFSError
from .. import preparation
from ..conversion import frame_of, morph_of
from . import image, materials, points

KINDS = {"IMAGE": image, "POINTS": points}

_lock = threading.RLock()
"""Blender renders in another thread than the one that draws its window, and both evaluate."""
_shown: dict[int, tuple] = {}
"""What each output datablock shows, by its session_uid."""
_messages: dict[int, str] = {}
"""Why an object shows nothing, by its session_uid."""


def refresh(depsgraph) -> None:
    """Bring the outputs of all morph objects that a dependency graph evaluated up to date."""
    if preparation.is_running() and depsgraph.mode != "RENDER":
        return
    may_create = not bpy.app.is_job_running("RENDER")
    claimed: set[int] = set()
    with _lock:
        for owner, evaluated in morph_objects(depsgraph):
            output = KINDS[owner.ifs_morph.kind]
            if may_create and owner.data.library is not None:
                # Blender lets nothing be written into a linked mesh, and does not say so.
                owner.data = owner.data.copy()
            if may_create and is_editable(owner):
                _part_from_copies(owner, output, claimed)
                output.ensure(owner)
            claimed.update(datablock.session_uid for datablock in _own_data(owner, output))
            _draw(owner, evaluated, output, depsgraph.mode == "RENDER")


def forget() -> None:
    """Render everything again when next evaluated, for pixels and points may have changed behind our back."""
    with _lock:
        _shown.clear()
        _messages.clear()


def message(owner) -> str:
    """Why an object shows nothing at this frame; empty if it shows its attractor."""
    return _messages.get(owner.session_uid, "")


def morph_objects(depsgraph) -> list:
    """Pairs of original and evaluated morph objects, those that are only instanced included.

    By name, but those of libraries first: they cannot have other outputs than the ones that came with them.
    """
    pairs = [
        (datablock.original, datablock)
        for datablock in depsgraph.ids
        if isinstance(datablock, bpy.types.Object) and _is_morph(datablock)
    ]
    return sorted(pairs, key=lambda pair: (is_editable(pair[0]), pair[0].name_full))


def _is_morph(owner) -> bool:
    """Whether an object shows a morph: its kind says so, and it has the mesh for it."""
    return owner.ifs_morph.kind != "NONE" and owner.type == "MESH"


def is_editable(owner) -> bool:
    """Whether datablocks may be made for an object: not for one in a library."""
    return owner.library is None


def _own_data(owner, output) -> list:
    """Datablocks that no other object may share."""
    own = [owner.data, *(getattr(owner.ifs_morph.output, name) for name in output.OWN_DATA)]
    return [datablock for datablock in own if datablock is not None]


def _part_from_copies(owner, output, claimed) -> None:
    """Give a copy outputs of its own, where it still has those of the object that it was copied from."""
    shared = [datablock for datablock in _own_data(owner, output) if datablock.session_uid in claimed]
    settings = owner.ifs_morph.output
    for datablock in shared:
        copy = datablock.copy()
        if datablock == owner.data:
            owner.data = copy
        for name in output.OWN_DATA:
            if getattr(settings, name) == datablock:
                setattr(settings, name, copy)
        if settings.material == copy:
            materials.fill_slot(owner, copy, instead_of=datablock)
    if shared:
        output.connect(owner)


def _draw(owner, evaluated, output, for_render) -> None:
    settings = evaluated.ifs_morph
    target = output.target(owner)
    if target is None:
        # Somebody edits it, or took it away: what it shows when it is back is not known.
        _shown.pop(owner.data.session_uid, None)
        return

    def show(morph, frame) -> None:
        signature, before = output.signature(owner, settings, morph, frame), _shown.get(target.session_uid)
        if before != signature:
            shown = output.draw(owner, settings, morph, frame, for_render, before or ())
            _shown[shown.session_uid] = signature

    try:
        morph = morph_of(settings)
        frame = frame_of(settings, morph)
        frame.require_attractor()
        show(morph, frame)
        _tell(owner, "")
    except (IFSError, ValueError, MemoryError) as error:
        # No attractor at this frame, or settings that cannot be used: an empty picture, and the reason.
        _tell(owner, str(error) or "There is not enough memory for it; lower its resolution or its points.")
        show(None, None)


def _tell(owner, reason: str) -> None:
    """Keep the reason for the panel; print it once and not for every frame."""
    if not reason:
        # Kept as an empty entry, so that the same object does not warn again and again during an animation.
        if owner.session_uid in _messages:
            _messages[owner.session_uid] = ""
        return
    if owner.session_uid not in _messages:
        print(f"IFS Morph: “{owner.name}” shows nothing at some frames: {reason}")
    _messages[owner.session_uid] = reason
