"""The Blender side of IFS Morph: properties, operators and panels around the mathematics in `core`.

Nothing that needs numba is imported before it is known to be there, so that Blender can say what is missing.
"""

from importlib import import_module
from importlib.util import find_spec

MODULES = (
    "properties",
    "handlers",
    "operators",
    "live",
    "ui",
    "editors",
)
"""Modules with a `register` and an `unregister`, in the order in which they are called."""


def register():
    """Register all parts, or only a panel that says what is missing."""
    for module in _modules():
        module.register()


def unregister():
    """Unregister all parts in reverse order."""
    for module in reversed(_modules()):
        module.unregister()


def _modules():
    if find_spec("numba") is None:
        return [import_module(".without_numba", __package__)]
    return [import_module(f".{name}", __package__) for name in MODULES]
