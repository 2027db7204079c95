"""Renders the attractor of each morph object at its evaluated (u,v) into its image or points.

`refresh` is called whenever Blender has evaluated something. It renders nothing that is shown already: each output
remembers what it was rendered from.
"""

import threading

import bpy

from ...core.ifs import IFSError
from ..conversion import morph_of
from . import image, points

KINDS = {"IMAGE": image, "POINTS": points}

_lock = threading.RLock()
"""Blender renders in another thread than the one that draws its window, and both evaluate."""
_shown: dict[int, tuple] = {}
"""What each output datablock shows, by its session_uid."""
_messages: dict[int, str] = {}
"""Why an object shows nothing, by its session_uid."""


def refresh(depsgraph) -> None:
    """Bring the outputs of all morph objects that a dependency graph evaluated up to date."""
    may_create = not bpy.app.is_job_running("RENDER")
    claimed: set[int] = set()
    with _lock:
        for owner, evaluated in morph_objects(depsgraph):
            output = KINDS[owner.ifs_morph.kind]
            if may_create and is_editable(owner):
                _part_from_copies(owner, output, claimed)
                output.ensure(owner)
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
    """Pairs of original and evaluated morph objects, those that are only instanced included, by name."""
    pairs = [
        (datablock.original, datablock)
        for datablock in depsgraph.ids
        if isinstance(datablock, bpy.types.Object) and datablock.ifs_morph.kind != "NONE"
    ]
    return sorted(pairs, key=lambda pair: pair[0].name_full)


def is_editable(owner) -> bool:
    """Whether datablocks may be made for an object: not for one in a library."""
    return owner.library is None


def _part_from_copies(owner, output, claimed) -> None:
    """Give a copy outputs of its own, where it still has those of the object that it was copied from."""
    settings = owner.ifs_morph.output
    parted = False
    for name in output.OWN_DATA:
        datablock = getattr(settings, name)
        if datablock is not None and datablock.session_uid in claimed:
            parted = True
            output.part(owner, name, datablock)
    if owner.data.session_uid in claimed:
        parted = True
        owner.data = owner.data.copy()
    if parted:
        output.connect(owner)
    own = [getattr(settings, name) for name in output.OWN_DATA]
    claimed.update(datablock.session_uid for datablock in (owner.data, *own) if datablock is not None)


def _draw(owner, evaluated, output, for_render) -> None:
    settings = evaluated.ifs_morph
    morph, frame, reason = None, None, ""
    try:
        morph = morph_of(settings)
        frame = morph.at(*settings.uv, settings.swell)
        frame.require_attractor()
    except IFSError as error:
        morph, frame, reason = None, None, str(error)
    _tell(owner, reason)
    target = output.target(owner)
    if target is None:
        return
    signature = output.signature(owner, settings, morph, frame)
    if _shown.get(target.session_uid) == signature:
        return
    target = output.draw(owner, settings, morph, frame, for_render)
    _shown[target.session_uid] = signature


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
