"""What the properties have in common: their options, and what follows when one is edited."""

from . import conversion

LEAF = {"LIBRARY_OVERRIDABLE"}
LIST = {"LIBRARY_OVERRIDABLE", "USE_INSERTION"}
STILL: set[str] = set()
"""Options of a property that has no F-curve."""


def redraw(self, context):
    """Have Blender evaluate the object again, which renders its output again; Python alone would not."""
    self.id_data.update_tag()


def refit(self, context):
    """The family of attractors has changed: fit the window to it, where the window is to be fitted."""
    conversion.fit_window(self.id_data)
    redraw(self, context)
