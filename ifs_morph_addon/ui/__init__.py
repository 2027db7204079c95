"""The sidebar tab, the Add menu and the File menu."""

from . import files, lists, menus, panels

MODULES = (lists, menus, panels, files)


def register():
    """Register lists, menus and panels."""
    for module in MODULES:
        module.register()


def unregister():
    """Unregister them in reverse order."""
    for module in reversed(MODULES):
        module.unregister()
