"""Compute the connectedness locus of a morph, and show it in an Image Editor."""

import bpy
import numpy as np

from ...core.connectedness import Connectedness
from ...core.ifs import IFSError
from ...core.locus import Locus, compute_locus_steps
from ..conversion import locus_fingerprint, morph_of, tolerance
from ..tasks import LongTask
from .poll import editable_morph, sound_morph

_last: dict[tuple[str, bool], Locus] = {}
"""The locus computed last, by its fingerprint and whether with gaps: planning needs more of it than its picture."""


def locus_steps(settings, gap: bool = True):
    """Yield the share done and return the locus of an object's morph; at once if it was the last one computed.

    The picture shows how wide the gaps are; planning a path needs the states alone, which take less time.
    """
    key = locus_fingerprint(settings)
    for with_gap in (True, gap):
        if (key, with_gap) in _last:
            return _last[key, with_gap]
    low, high = settings.locus.domain
    if not low < high:
        raise IFSError(f"The domain of the locus runs from {low:g} to {high:g}; its end must be above its start.")
    resolution = settings.locus.resolution
    locus = yield from compute_locus_steps(morph_of(settings), resolution, tolerance(settings), (low, high), gap=gap)
    _last.clear()
    _last[key, gap] = locus
    return locus


def store_locus(owner, locus: Locus) -> None:
    """Keep the picture of a locus in the file.

    Each locus gets an image of its own, so that undo brings the one before back.
    """
    settings = owner.ifs_morph.locus
    height, width = locus.state.shape
    before = settings.image
    image = bpy.data.images.new(f"{owner.name} Locus", width, height, alpha=False)
    image.pixels.foreach_set(np.ascontiguousarray(locus.picture(), dtype=np.float32).ravel())
    image.pack()
    image.ifs_morph_locus.lowest = locus.u[0], locus.v[0]
    image.ifs_morph_locus.spacing = locus.u[1] - locus.u[0]
    settings.image = image
    settings.inputs = locus_fingerprint(owner.ifs_morph)
    shared = any(other.ifs_morph.locus.image == before for other in bpy.data.objects)
    if before is not None and before.library is None and not shared:
        name = before.name
        before.user_remap(image)
        bpy.data.images.remove(before)
        image.name = name


class IFSMORPH_OT_compute_locus(LongTask, bpy.types.Operator):
    """Find for which (u,v) the shape is in one piece, and keep a picture of it"""

    bl_idname = "ifs_morph.compute_locus"
    bl_label = "Compute Locus"
    bl_options = {"REGISTER", "UNDO"}

    poll = classmethod(sound_morph)

    def work(self, context):
        """Compute, then store."""
        owner = context.object
        locus = yield from locus_steps(owner.ifs_morph)
        store_locus(owner, locus)
        self.report(
            {"INFO"}, f"The shape is connected at {100 * locus.share(Connectedness.CONNECTED):.1f} % of the locus"
        )


class IFSMORPH_OT_show_locus(bpy.types.Operator):
    """Show the locus in an Image Editor, in a window of its own if there is no Image Editor"""

    bl_idname = "ifs_morph.show_locus"
    bl_label = "Show Locus"

    @classmethod
    def poll(cls, context):
        """Need a locus."""
        if not editable_morph(cls, context):
            return False
        if context.object.ifs_morph.locus.image is None:
            cls.poll_message_set("Compute the locus first")
            return False
        return not bpy.app.background

    def execute(self, context):
        """Use an Image Editor that is open, or open one."""
        area = next((area for area in context.screen.areas if area.type == "IMAGE_EDITOR"), None)
        if area is None:
            bpy.ops.wm.window_new()
            area = context.window_manager.windows[-1].screen.areas[0]
            area.type = "IMAGE_EDITOR"
        area.spaces.active.image = context.object.ifs_morph.locus.image
        return {"FINISHED"}


CLASSES = (IFSMORPH_OT_compute_locus, IFSMORPH_OT_show_locus)


def register():
    """Register the operators."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    """Unregister the operators and let go of the last locus."""
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
    _last.clear()
