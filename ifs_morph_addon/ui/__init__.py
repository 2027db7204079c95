"""The sidebar tab and the Add menu."""

from . import lists, menus, panels

MODULES = (lists, menus, panels)


def register():
    """Register lists, menus and panels."""
    for module in MODULES:
        module.register()


def unregister():
    """Unregister them in reverse order."""
    for module in reversed(MODULES):
        module.unregister()
