"""What the properties have in common: their options, and what follows when one is edited."""

from contextlib import contextmanager

from . import conversion, fcurves

LEAF = {"LIBRARY_OVERRIDABLE"}
LIST = {"LIBRARY_OVERRIDABLE", "USE_INSERTION"}
STILL: set[str] = set()
"""Options of a property that has no F-curve."""


def redraw(self, context):
    """Have Blender evaluate the object again, which renders its output again; Python alone would not."""
    self.id_data.update_tag()


_held: set[int] = set()
"""Objects, by session_uid, whose window waits for the end of a drag."""


def refit(self, context):
    """The family of attractors has changed: fit the window to it, where the window is to be fitted."""
    if self.id_data.session_uid not in _held:
        conversion.fit_window(self.id_data)
    redraw(self, context)


def hold_window(owner) -> None:
    """Leave the window of an object as it is while one of its maps is dragged, or the map would run from the mouse."""
    _held.add(owner.session_uid)


def release_window(owner) -> None:
    """Fit the window again, after `hold_window`."""
    _held.discard(owner.session_uid)
    conversion.fit_window(owner)


@contextmanager
def window_held(owner):
    """Fit the window of an object once, after all that is done to it meanwhile, and have it rendered again."""
    hold_window(owner)
    try:
        yield
    finally:
        release_window(owner)
        owner.update_tag()


def show_edited_shape(self, context):
    """Go to the shape whose maps are edited, unless keys say where (u,v) is."""
    if self.edit_maps and not fcurves.has_path(self.id_data):
        self.uv = (0.0, 0.0) if self.edited_end == "INITIAL" else (1.0, 1.0)
        self.swell = 0.0
