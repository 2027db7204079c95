"""Plan a path through the locus, key it, check what is keyed, remove it."""

from dataclasses import replace

import bpy

from ...core.ifs import IFSError
from ...core.parallel import part
from ...core.path import METHODS, plan_path_steps
from ...core.report import FrameCheck, check_frames, check_frames_steps
from .. import fcurves
from ..conversion import core_name, fit_window, morph_of, path_fingerprint, pixel, tolerance
from ..locus_picture import locus_steps
from ..tasks import LongTask
from .poll import editable_morph, sound_morph

LOCUS_SHARE = 0.5
"""Share of the progress bar that the locus takes."""


def _path_can_be_keyed(cls, context) -> bool:
    if not sound_morph(cls, context):
        return False
    problem = keying_problem(context.object)
    if problem:
        cls.poll_message_set(problem)
    return problem is None


def keying_problem(owner) -> str | None:
    """Why no path can be keyed over the frame range of an object, or None if one can."""
    path = owner.ifs_morph.path
    if path.frame_end <= path.frame_start:
        return fcurves.obstacle(owner) or "The path must end after the frame at which it starts"
    return fcurves.obstacle(owner)


class _KeyPath(LongTask):
    """Plan by a method of core's, key over the frame range, report."""

    bl_options = {"REGISTER", "UNDO"}

    poll = classmethod(_path_can_be_keyed)

    def work(self, context):
        """Plan, then key."""
        owner = context.object
        settings = owner.ifs_morph
        frames = settings.path.frame_end - settings.path.frame_start + 1
        method = self.method(settings)
        locus = None
        low, high = settings.locus.domain
        if method == "planned" and low <= 0 and high >= 1:
            locus = yield from part(locus_steps(settings, gap=False), 0.0, LOCUS_SHARE)
        steps = plan_path_steps(morph_of(settings), locus, frames, tolerance(settings), method)
        path = yield from part(steps, LOCUS_SHARE if locus else 0.0, 1.0)
        keyed = key_path(owner, path)
        fit_window(owner)
        tell(settings, replace(path.report, path=keyed).text(pixel(settings)))
        self.report({"INFO"}, _headline(settings.path.report))


def key_path(owner, path) -> FrameCheck:
    """Key a path over the frame range of an object; what the shape is at each frame then."""
    settings = owner.ifs_morph
    frame_start, frame_end = settings.path.frame_start, settings.path.frame_end
    fcurves.write_path(owner, path, frame_start, frame_end)
    # What counts is what Blender evaluates, with the F-curves' own precision.
    places = fcurves.sample_path(owner, range(frame_start, frame_end + 1))
    return check_frames(morph_of(settings), places, tolerance(settings))


def tell(settings, report: str) -> None:
    """Keep the report on the path of an object with what it was made for."""
    settings.path.report = report
    settings.path.inputs = path_fingerprint(settings)


def _headline(report: str) -> str:
    return report.splitlines()[0]


class IFSMORPH_OT_plan_path(_KeyPath, bpy.types.Operator):
    """Find a path by the chosen method and key it on (u,v) and Swell, in place of their keys"""

    bl_idname = "ifs_morph.plan_path"
    bl_label = "Plan and Key Path"

    def method(self, settings):
        """Return the method chosen in the panel."""
        return core_name(settings.path.method, METHODS)


class IFSMORPH_OT_key_straight(_KeyPath, bpy.types.Operator):
    """Key (u,v) straight from the initial to the final shape, in place of their keys"""

    bl_idname = "ifs_morph.key_straight"
    bl_label = "Key Straight Path"

    swell: bpy.props.BoolProperty(name="Swell", description="Swell just enough to stay connected", default=False)

    def method(self, settings):
        """Return the method that goes straight."""
        return "straight" if self.swell else "straight unswollen"


class IFSMORPH_OT_check_path(LongTask, bpy.types.Operator):
    """Test the shape at every frame of the keyed path and report where it is in pieces"""

    bl_idname = "ifs_morph.check_path"
    bl_label = "Check Path"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        """Need a sound morph with a keyed path."""
        if not sound_morph(cls, context):
            return False
        if not fcurves.has_path(context.object):
            cls.poll_message_set("(u,v) has no keys; plan a path first, or key it by hand")
            return False
        return True

    def work(self, context):
        """Read the F-curves without moving in time, and test."""
        owner = context.object
        settings = owner.ifs_morph
        frames = range(settings.path.frame_start, settings.path.frame_end + 1)
        if not frames:
            raise IFSError("The path must end after the frame at which it starts.")
        places = fcurves.sample_path(owner, frames)
        check = yield from check_frames_steps(morph_of(settings), places, tolerance(settings))
        tell(settings, check.text(pixel(settings)))
        broken = [frame for frame, state in zip(frames, check.state, strict=True) if state != 0]
        self.report({"WARNING" if broken else "INFO"}, _headline(settings.path.report))


class IFSMORPH_OT_clear_path(bpy.types.Operator):
    """Remove the keys of (u,v) and Swell; other animation stays"""

    bl_idname = "ifs_morph.clear_path"
    bl_label = "Clear Path"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        """Need a keyed path that may be changed."""
        if not editable_morph(cls, context):
            return False
        problem = fcurves.obstacle(context.object)
        if problem is None and not fcurves.has_path(context.object):
            problem = "(u,v) has no keys"
        if problem:
            cls.poll_message_set(problem)
        return problem is None

    def execute(self, context):
        """Remove the F-curves, and show the initial shape again."""
        owner = context.object
        fcurves.remove_path(owner)
        settings = owner.ifs_morph
        settings.uv, settings.swell = (0.0, 0.0), 0.0
        settings.path.report = settings.path.inputs = ""
        fit_window(owner)
        return {"FINISHED"}


CLASSES = (IFSMORPH_OT_plan_path, IFSMORPH_OT_key_straight, IFSMORPH_OT_check_path, IFSMORPH_OT_clear_path)

register, unregister = bpy.utils.register_classes_factory(CLASSES)
