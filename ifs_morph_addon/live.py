"""Keeps the picture of a locus up to date while maps change: a coarse preview at once, the full one after a pause.

A timer works for some hundredths of a second at a time, and so does the window between them. A preview is finished even
if the maps have changed again meanwhile, or one who drags without a rest would never see any; the full locus is dropped
with the first change. Nothing is kept in the file but the full locus, and nothing makes an undo step.
"""

import time

import bpy
from bpy.app.handlers import persistent

from . import locus_picture, preparation, tasks
from .conversion import locus_fingerprint
from .operators.poll import is_changeable

PREVIEW_NODES = 130
"""Nodes along a side of the preview."""

PAUSE_SECONDS = 0.5
"""Time without a change after which the full locus is computed."""

MOST_NODES = 1021
"""Larger pictures take too long to be kept in the file without blocking the window: they are left to the operator."""

INTERVAL, WAIT = 0.001, 0.2
"""Seconds until the timer's next call, while there is work and while something else has to end first."""


class Follower:
    """Follows the maps of one object.

    Parameters
    ----------
    owner : bpy.types.Object
    clock : callable
        Seconds.
    """

    def __init__(self, owner, clock=time.monotonic):
        self._uid = owner.session_uid
        self._clock = clock
        self._steps = None
        self._inputs = ""
        self.shows_preview = False

    @property
    def owner(self):
        """The object; None if there is none any more. Undo puts another in place, with the same number."""
        return next((owner for owner in bpy.data.objects if owner.session_uid == self._uid), None)

    @property
    def is_busy(self) -> bool:
        """Whether there is something to do."""
        return self._steps is not None

    def notice(self, inputs: str) -> None:
        """Take note of what the locus depends on; work begins if it is something else than before."""
        if inputs != self._inputs:
            self._inputs = inputs
            self._changed = self._clock()
            self._steps = self._steps or self._follow()

    def step(self) -> float:
        """Work for a while; seconds until there is more to do."""
        owner = self.owner
        if owner is None or not wants_to_follow(owner):
            self.stop()
            self._inputs = ""
            return INTERVAL
        try:
            return next(self._steps)
        except StopIteration:
            self._steps = None
        except (ValueError, MemoryError, RuntimeError):
            # The panel says what is wrong with the shapes; the next change is another try.
            self.stop()
        return INTERVAL

    def stop(self) -> None:
        """Drop the work, and show what is in the file again."""
        if self._steps is not None:
            self._steps.close()
            self._steps = None
        owner = self.owner
        if self.shows_preview and owner is not None and owner.ifs_morph.locus.image is not None:
            locus_picture.put_back(owner.ifs_morph.locus.image)
        self.shows_preview = False

    def _follow(self):
        while True:
            inputs = self._inputs
            if locus_picture.is_current(self.owner.ifs_morph) and not self.shows_preview:
                return
            yield from self._preview()
            while self._inputs == inputs and (left := self._changed + PAUSE_SECONDS - self._clock()) > 0:
                yield min(left, WAIT)
            if self._inputs == inputs and (yield from self._full(inputs)):
                return

    def _preview(self):
        locus = yield from _timed(locus_picture.coarse_locus_steps(self.owner.ifs_morph, PREVIEW_NODES))
        # Another step, for both take their time where the picture is large.
        locus_picture.writable_picture(self.owner)
        yield INTERVAL
        image, u, v = locus_picture.writable_picture(self.owner)
        rows, columns = locus.nearest_nodes(u, v)
        locus_picture.show(image, locus.picture()[rows][:, columns])
        self.shows_preview = True
        _redraw(image)
        yield INTERVAL

    def _full(self, inputs):
        """Whether it was completed: it is dropped when the maps change."""
        if self.owner.ifs_morph.locus.resolution > MOST_NODES:
            return True
        steps = self._full_steps()
        while self._inputs == inputs:
            try:
                next(steps)
            except StopIteration as done:
                image, _, _ = locus_picture.writable_picture(self.owner)
                locus_picture.write(image, done.value, inputs)
                self.shows_preview = False
                _redraw(image)
                return True
            yield INTERVAL
        steps.close()
        return False

    def _full_steps(self):
        locus = yield from locus_picture.locus_steps(self.owner.ifs_morph)
        return (yield from locus_picture.colored_steps(locus))


def _timed(steps):
    """Pass on the value of steps that yield shares, as steps that yield seconds."""
    while True:
        try:
            next(steps)
        except StopIteration as done:
            return done.value
        yield INTERVAL


_followers: dict[int, Follower] = {}
"""By the session_uid of their objects."""


def wants_to_follow(owner) -> bool:
    """Whether the picture of an object's locus is to follow its maps."""
    locus = owner.ifs_morph.locus
    return owner.ifs_morph.kind != "NONE" and locus.live and locus.image is not None and is_changeable(owner)


def shows_preview(owner) -> bool:
    """Whether the picture of an object's locus is a preview now."""
    follower = _followers.get(owner.session_uid)
    return follower is not None and follower.shows_preview


def notice(owner) -> None:
    """Begin to work if the maps of an object have changed since its picture was made."""
    if not wants_to_follow(owner):
        return
    follower = _followers.get(owner.session_uid)
    if follower is None:
        if locus_picture.is_current(owner.ifs_morph):
            return
        follower = _followers[owner.session_uid] = Follower(owner)
    follower.notice(locus_fingerprint(owner.ifs_morph))
    if follower.is_busy and not bpy.app.background and not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick, first_interval=INTERVAL)


def _tick():
    """Do a little work; seconds until the next call, or None once all is done."""
    if bpy.app.is_job_running("RENDER") or tasks.is_running() or preparation.is_running():
        return WAIT
    busy = [follower for follower in _followers.values() if follower.is_busy]
    for follower in busy:
        # One piece of work in a tick; followers that only wait for a pause let the next one work.
        seconds = follower.step()
        if seconds <= INTERVAL:
            break
    return seconds if busy else None


def _redraw(image) -> None:
    """Have editors show an image that has changed, and panels what is known about it."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR" and area.spaces.active.image == image:
                area.tag_redraw()
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


def forget() -> None:
    """Drop all work."""
    for follower in _followers.values():
        follower.stop()
    _followers.clear()


@persistent
def on_edit(scene, depsgraph):
    """Notice edits of objects."""
    for update in depsgraph.updates:
        if isinstance(update.id, bpy.types.Object):
            notice(update.id.original)


@persistent
def on_undo(*_):
    """Undo exchanges the file's data but not the pixels that are shown: show those of the file, and begin again."""
    _followers.clear()
    for owner in bpy.data.objects:
        if owner.ifs_morph.kind != "NONE" and owner.ifs_morph.locus.image is not None:
            locus_picture.put_back(owner.ifs_morph.locus.image)
            notice(owner)


@persistent
def on_other_file(*_):
    """Drop work on a file that is about to be closed."""
    forget()


@persistent
def on_save(*_):
    """Show what the file holds, so that nobody takes a preview for unsaved work; the full locus follows."""
    for follower in _followers.values():
        owner = follower.owner
        if follower.shows_preview and owner is not None and owner.ifs_morph.locus.image is not None:
            locus_picture.put_back(owner.ifs_morph.locus.image)
            follower.shows_preview = False


HANDLERS = {
    "depsgraph_update_post": on_edit,
    "undo_post": on_undo,
    "redo_post": on_undo,
    "load_pre": on_other_file,
    "save_pre": on_save,
}


def register():
    """Attach the handlers, in a Blender with a window."""
    if not bpy.app.background:
        for event, handler in HANDLERS.items():
            getattr(bpy.app.handlers, event).append(handler)


def unregister():
    """Take them off and stop working."""
    if not bpy.app.background:
        for event, handler in HANDLERS.items():
            getattr(bpy.app.handlers, event).remove(handler)
        if bpy.app.timers.is_registered(_tick):
            bpy.app.timers.unregister(_tick)
    forget()
